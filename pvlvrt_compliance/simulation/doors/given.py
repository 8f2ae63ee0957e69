"""Parameters that a user gives to a controller, against those that it says it has."""

import math
from collections.abc import Iterable, Mapping

from pvlvrt_compliance.errors import did_you_mean
from pvlvrt_compliance.simulation.doors.base import DoorError, ParameterInfo, Value


def checked_parameters(given: Mapping[str, Value], known: Iterable[ParameterInfo]) -> dict[str, Value]:
    """Values of the parameters that are given, each of the type of its default and within its range.

    Raises
    ------
    DoorError
        When a name is not known, or a value cannot be used.
    """
    by_name = {info.name: info for info in known}
    return {name: _checked(name, value, by_name) for name, value in given.items()}


def _checked(name: str, value: Value, known: Mapping[str, ParameterInfo]) -> Value:
    if name not in known:
        has = f"; it has {', '.join(known)}" if known else "; it has none"
        raise DoorError(
            f"--set controller.{name}: the controller has no such parameter{did_you_mean(name, known)}{has}"
        )
    info = known[name]
    found = _of_type(name, value, type(info.value))
    if isinstance(found, (int, float)) and not isinstance(found, bool):
        low = -math.inf if info.minimum is None else info.minimum
        high = math.inf if info.maximum is None else info.maximum
        if not low <= found <= high:
            raise DoorError(f"--set controller.{name}: {found:g} is not in its range, {_range(low, high)}")
    return found


def _of_type(name: str, value: Value, kind: type) -> Value:
    if kind is float and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if kind is str and not isinstance(value, str):
        return str(value)
    if type(value) is not kind:
        words = {bool: "true or false", int: "a whole number", float: "a number", str: "a word"}
        raise DoorError(f"--set controller.{name}: {value!r} is not {words[kind]}")
    return value


def _range(low: float, high: float) -> str:
    if high == math.inf:
        return f"{low:g} and more"
    if low == -math.inf:
        return f"{high:g} and less"
    return f"{low:g} to {high:g}"


def seconds(given: Mapping[str, Value], name: str) -> float | None:
    """Time (s) that is given under a name which every controller of a kind takes; None when it is not.

    Raises
    ------
    DoorError
        When it is not a number above zero.
    """
    value = given.get(name)
    if value is None:
        return None
    if isinstance(value, (bool, str)) or not (math.isfinite(value) and value > 0):
        raise DoorError(f"--set controller.{name}: {value!r} is not a number of seconds above zero")
    return float(value)
