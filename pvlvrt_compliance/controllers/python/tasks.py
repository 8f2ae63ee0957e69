"""What a class may have besides its step: switches that this returns, too, and a slow task."""

import inspect
import reprlib
from collections.abc import Callable, Mapping
from typing import Any

from pvlvrt_compliance.controllers import Measurements
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.simulation.door.exchange import RAREST, SWITCHES

NUMBERS: Mapping[int, str] = {3: "three", 4: "four", 5: "five", 6: "six"}
"""Of what `step` may have to return."""


def put(outputs: Any, commands: Any, due: int) -> None:
    """Write commands, a switch as 0 or 1.

    Raises
    ------
    TypeError, ValueError
        When they are not so many numbers.
    """
    values = [float(command) for command in commands]
    if len(values) != due:
        raise ValueError(f"{len(values)} are given")
    for k, value in enumerate(values):
        outputs[k] = value


def every(controller: Any) -> int:
    """Samples from one run of the slow task to the next, by the attribute ``every``; 1 without a slow task.

    Raises
    ------
    DoorError
        When there is one, and its period is no whole number.
    """
    name, given = type(controller).__name__, getattr(controller, "every", None)
    if not callable(getattr(controller, "step_slow", None)):
        return 1  # whatever ``every`` means there
    if not isinstance(given, int) or isinstance(given, bool) or not 1 < given <= RAREST:
        raise DoorError(
            f"{name}.every is {reprlib.repr(given)}; for step_slow() it must be a whole number of samples,"
            f" 2 to {RAREST}"
        )
    return given


def notes_of(controller: Any) -> tuple[str, ...]:
    """What it has that does nothing: a period without a slow task, signals that are no method."""
    given, signals, found = getattr(controller, "every", None), getattr(controller, "signals", None), []
    if not callable(getattr(controller, "step_slow", None)) and type(given) is int and given > 1:
        found.append(f"every is {given}, but there is no method step_slow(): slow_task_due is 1 in every sample")
    if signals is not None and not callable(signals):
        found.append("signals is no method: nothing of it is recorded; write def signals(self), which returns a dict")
    return tuple(found)


def lack_of(controller: Any, method: str) -> str:
    """Why a method cannot be called as it will be, with one argument; empty where it can."""
    name, function = type(controller).__name__, getattr(controller, method, None)
    if not callable(function):
        return f"{controller.__name__ if isinstance(controller, type) else name} has no method {method}()"
    if isinstance(controller, type):
        return ""  # there is no object yet, whose method would be called
    try:
        inspect.signature(function).bind(None)
    except TypeError as error:
        told = "nominal" if method == "reset" else "measurements"
        return f"{name}.{method}() must take one argument, {method}(self, {told}): {error}"
    except ValueError:  # of what is compiled nothing is known
        pass
    return ""


def with_slow_task(controller: Any) -> Callable[[Measurements], Any]:
    """Its step, with the slow task before it where that is due."""
    step, step_slow = controller.step, controller.step_slow

    def run(measurements: Measurements) -> Any:
        if measurements.slow_task_due:
            step_slow(measurements)
        return step(measurements)

    return run


def switches(controller: Any) -> tuple[str, ...]:
    """Switches that `step` returns besides voltages, by the attribute ``switches``.

    Raises
    ------
    DoorError
        When it is not a tuple of those that there are, each once.
    """
    given = getattr(controller, "switches", ())
    names = [name for name in given if name in SWITCHES] if isinstance(given, (tuple, list)) else []
    if not isinstance(given, (tuple, list)) or len(set(names)) != len(given):
        raise DoorError(
            f"{type(controller).__name__}.switches is {reprlib.repr(given)}; allowed are {', '.join(SWITCHES)},"
            ' each once, as a tuple: switches = ("trip",)'
        )
    return tuple(given)
