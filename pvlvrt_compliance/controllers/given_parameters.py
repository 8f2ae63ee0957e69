"""Parameters that a user gives to a controller, against those that it says it has: one rule for every kind of door."""

import json
import math
import reprlib
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import replace
from typing import TypeGuard

import numpy as np

from pvlvrt_compliance.controllers.description import ParameterInfo, Value
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.errors import did_you_mean
from pvlvrt_compliance.simulation.parameters import OF_THE_HOST
from pvlvrt_compliance.texts import shortened

Range = tuple[float, float]
"""Smallest and largest number."""

UNLIMITED: Range = (-math.inf, math.inf)

_LONGEST = 40  # characters of a value that is shown


def checked_parameters(
    given: Mapping[str, Value],
    known: Iterable[ParameterInfo],
    holds: Mapping[str, Range] | None = None,
    besides: Collection[str] = (),
    allow_out_of_range: bool = False,
) -> dict[str, Value]:
    """Values of the parameters that are given, each of the type of its default and within its range.

    A whole number is a number, and a number without a fraction a whole one; a switch is neither, and no number is a
    switch. A text takes a number or a switch as it is written.

    Parameters
    ----------
    given : mapping
        What the user has set, by name.
    known : iterable of ParameterInfo
        What the controller has.
    holds : mapping, optional
        Smallest and largest number that the type of a parameter holds, by its name; any number where there is none.
    besides : collection of str
        Names that the host takes for every controller of the kind; they are left out.
    allow_out_of_range : bool
        Whether a number may be out of the range that the controller states for it; never out of that of its type.

    Raises
    ------
    DoorError
        With everything that is not known or cannot be used, a line each.
    """
    by_name = {info.name: _unbounded(info) if allow_out_of_range else info for info in known}
    found, problems = {}, []
    for name, value in given.items():
        try:
            if name not in besides:
                found[name] = _checked(name, value, by_name, (holds or {}).get(name, UNLIMITED), besides)
        except DoorError as error:
            problems.append(str(error))
    if problems:
        raise DoorError("\n".join(problems))
    return found


def beyond_their_ranges(given: Mapping[str, Value], known: Iterable[ParameterInfo]) -> dict[str, str]:
    """What is given out of the range that the controller states for it, in words by its name: ``0 H (0.1 to 2)``."""
    numbers = ((info, code_of(given[info.name])) for info in known if info.name in given and _is_number(info.value))
    return {
        info.name: f"{_with_unit(number, info)} ({_range(*_stated(info))})"
        for info, number in numbers
        if _is_number(number) and not _is_within(number, _stated(info))
    }


def beyond_words(found: Mapping[str, str]) -> str:
    """What is told of these where they were allowed."""
    if not found:
        return "every parameter is in the range that it states: none had to be allowed out of it"
    words = ", ".join(f"{name} = {told}" for name, told in found.items())
    return f"out of the range that it states, as was allowed: {words}"


def code_of(value: Value) -> Value:
    """The whole number that a single character of type char is; any other value as it is."""
    return ord(value) if isinstance(value, str) and len(value) == 1 and value.isascii() else value


def seconds(given: Mapping[str, Value], name: str) -> float | None:
    """Time (s) that is given under a name which every controller of a kind takes; None when it is not.

    Raises
    ------
    DoorError
        When it is not a number above zero.
    """
    if name not in given:
        return None
    try:
        found = _number(given[name])
    except _MisfitError:
        found = 0.0
    if not found > 0:
        raise DoorError(_told(name, f"{_shown(given[name])} is not a number of seconds above zero"))
    return found


def range_of_type(number: type[np.number]) -> Range:
    """Smallest and largest number of a type of numpy; of float64 any."""
    if issubclass(number, np.integer):
        return int(np.iinfo(number).min), int(np.iinfo(number).max)
    largest = float(np.finfo(np.float32).max)
    return (-largest, largest) if number is np.float32 else UNLIMITED


class _MisfitError(Exception):
    """A value is not what it must be; says what that is."""


def _checked(
    name: str, value: Value, known: Mapping[str, ParameterInfo], holds: Range, besides: Collection[str]
) -> Value:
    if name not in known:
        raise DoorError(_told(name, _unknown(name, [*known, *besides])))
    info = known[name]
    kind = next(kind for kind in _CONVERSIONS if isinstance(info.value, kind))
    try:
        found = _CONVERSIONS[kind](value)
    except _MisfitError as error:
        raise DoorError(_told(name, f"{_shown(value)} is not {error}")) from None
    if _is_number(found):
        _check_range(info, found, holds)
    return found


def _unknown(name: str, names: Collection[str]) -> str:
    has = f"it has {', '.join(names)}" if names else "it has none"
    return f"the controller has no such parameter{did_you_mean(name, [*names, *OF_THE_HOST])}; {has}"


def _check_range(info: ParameterInfo, found: float, holds: Range) -> None:
    stated = _stated(info)
    low, high = max(holds[0], stated[0]), min(holds[1], stated[1])
    if not _is_within(found, (low, high)):
        raise DoorError(_told(info.name, f"{_with_unit(found, info)} is out of range; {_range(low, high)} is allowed"))


def _stated(info: ParameterInfo) -> Range:
    """The range that the controller states for a parameter, without end where it states none."""
    return (
        -math.inf if info.minimum is None else info.minimum,
        math.inf if info.maximum is None else info.maximum,
    )


def _unbounded(info: ParameterInfo) -> ParameterInfo:
    return replace(info, minimum=None, maximum=None)


def _is_within(number: float, allowed: Range) -> bool:
    return allowed[0] <= number <= allowed[1]


def _is_number(value: Value) -> TypeGuard[float | int]:
    """Whether a value has a range: no text, and no switch, which is a whole number in Python."""
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _with_unit(number: float, info: ParameterInfo) -> str:
    return f"{_shown(number)} {info.unit}".rstrip()


def _number(value: Value) -> float:
    if isinstance(value, (bool, str)):
        raise _MisfitError("a number")
    try:
        found = float(value)
    except OverflowError:
        found = math.inf
    if not math.isfinite(found):
        raise _MisfitError("a finite number")
    return found


def _whole(value: Value) -> int:
    if isinstance(value, (bool, str)) or (isinstance(value, float) and not value.is_integer()):
        raise _MisfitError("a whole number")
    return int(value)


def _switch(value: Value) -> bool:
    if not isinstance(value, bool):
        raise _MisfitError("true or false")
    return value


def _text(value: Value) -> str:
    text = value if isinstance(value, str) else _written(value)
    if "\0" in text or any("\ud800" <= character <= "\udfff" for character in text):
        raise _MisfitError("a text of whole characters without NUL")  # a string of C, in UTF-8
    return text


_CONVERSIONS: Mapping[type, Callable[[Value], Value]] = {bool: _switch, int: _whole, float: _number, str: _text}
"""By the type of the default; a switch of Python is a whole number, too, and comes first."""


def _told(name: str, what: str) -> str:
    return f"--set controller.{name}: {what}"


def _written(value: Value) -> str:
    """A value as it is written after ``--set``."""
    return json.dumps(value) if isinstance(value, bool) else str(value)


def _shown(value: Value) -> str:
    """A value in a message; a text is in quotes, a long one shortened."""
    text = reprlib.repr(value) if isinstance(value, str) else _written(value).removesuffix(".0")
    return shortened(text, _LONGEST)


def _range(low: float, high: float) -> str:
    if high == math.inf:
        return f"{_shown(low)} and more"
    if low == -math.inf:
        return f"{_shown(high)} and less"
    return f"{_shown(low)} to {_shown(high)}"
