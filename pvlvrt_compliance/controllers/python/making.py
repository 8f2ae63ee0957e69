"""How a controller is made of a class, and what the class says of that."""

import inspect
import math
import reprlib
from collections.abc import Mapping
from typing import Any

from pvlvrt_compliance.controllers.description import ParameterInfo, Value
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.python.importing import let_pass, tail


def defaults_of(made: Any) -> dict[str, Value]:
    """Arguments of the constructor that have a default which can be set."""
    try:
        arguments = inspect.signature(made).parameters.values()
    except (TypeError, ValueError):
        return {}
    return {a.name: a.default for a in arguments if isinstance(a.default, (bool, int, float, str))}


def parameters_of(made: Any) -> tuple[ParameterInfo, ...]:
    """Parameters of a class, with their defaults."""
    return tuple(ParameterInfo(name, value) for name, value in (defaults_of(made) or attributes_of(made)).items())


def attributes_of(made: Any) -> dict[str, Value]:
    """Public attributes of a class that can be set."""
    names = [name for name in dir(made) if not name.startswith("_") and name != "commands_voltages"]
    found = {name: getattr(made, name) for name in names}
    return {name: value for name, value in found.items() if isinstance(value, (bool, int, float, str))}


def make(made: Any, given: Mapping[str, Value], keywords: bool) -> Any:
    """Make a controller, its parameters as arguments or set afterwards.

    Raises
    ------
    DoorError
        When that fails, with the exception and where it came from.
    """
    try:
        if keywords:
            return made(**given)
        controller = made()
        for name, value in given.items():
            setattr(controller, name, value)
        return controller
    except BaseException as error:
        let_pass(error)
        raise DoorError(f"{getattr(made, '__name__', made)} cannot be made: {tail(error)}") from None


def sample_time_s_of(controller: Any) -> float:
    """Sample time of a controller (s).

    Raises
    ------
    DoorError
        When it has none, or what it has is no length of time.
    """
    name = type(controller).__name__
    given = getattr(controller, "sample_time_s", None)
    if given is None:
        raise DoorError(f"{name} has no attribute sample_time_s")
    if isinstance(given, (int, float)) and math.isfinite(given) and given > 0:
        return float(given)
    raise DoorError(f"{name}.sample_time_s is {reprlib.repr(given)}; it must be a number of seconds above zero")
