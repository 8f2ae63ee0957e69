"""How numbers and verdicts are spelled for people, the same in the terminal and in HTML."""

import math
from typing import NamedTuple

from pvlvrt_compliance.results import Status, Verdict

_DECIMALS_BY_UNIT = {"kW": 1, "kvar": 1, "pu": 3, "V": 1, "A": 1, "%": 3, "s": 3, "ms": 1, "Hz": 2, "kHz": 2}
_MAX_DECIMALS = 9
_SIGNIFICANT_DIGITS = 4

STATUS_WORD = {
    Status.ERROR: "error",
    Status.NOT_EVALUATED: "not evaluated",
    Status.FAIL: "fail",
    Status.PASS: "pass",
    Status.NOT_APPLICABLE: "not applicable",
}

STATUS_SYMBOL = {
    Status.ERROR: "!",
    Status.NOT_EVALUATED: "?",
    Status.FAIL: "✗",
    Status.PASS: "✓",
    Status.NOT_APPLICABLE: "–",
}
"""A verdict without colour; the words stand beside it everywhere."""

CONFIDENCE_MEANING = {
    "confirmed": "read in the official text",
    "code": "read in source code that implements the standard",
    "secondary": "read in a text about the standard",
    "memory": "well known, not checked against the document",
    "memory-low": "a hint only, not checked against the document",
    "derived": "computed from other numbers",
    "inferred": "a reading of a figure",
    "chosen": "a number of this project",
}


class Row(NamedTuple):
    """The numbers of a verdict as text, empty where there is none."""

    measured: str
    limit: str
    margin: str


def number(value: float | None, unit: str = "", decimals: int | None = None, sign: bool = False) -> str:
    """Write a value with its unit, ``50.0 kvar``; an empty string for None.

    Parameters
    ----------
    value : float or None
        Value in ``unit``.
    unit : str
        Decides the number of decimals; an unknown unit gets four significant digits.
    decimals : int, optional
        Instead of the unit's own.
    sign : bool
        Write ``+`` too.
    """
    if value is None:
        return ""
    places = _decimals(value, unit) if decimals is None else decimals
    text = f"{value:{'+' if sign else ''}.{places}f}"
    if float(text) == 0:
        text = text.replace("-", "")
    return f"{text} {unit}".rstrip()


def row(check: Verdict) -> Row:
    """Measured value, limit and margin, with decimals enough that a margin other than zero never reads as zero."""
    values = [v for v in (check.measured, check.limit, check.margin) if v is not None]
    places = max((_decimals(v, check.unit) for v in values), default=0)
    while check.margin and places < _MAX_DECIMALS and float(f"{check.margin:.{places}f}") == 0:
        places += 1
    return Row(
        measured=number(check.measured, check.unit, places),
        limit=number(check.limit, check.unit, places),
        margin=number(check.margin, check.unit, places, sign=True),
    )


def label(name: str) -> str:
    """Make a name of the data model readable: ``reactive_support`` becomes ``reactive support``."""
    return name.replace("_", " ")


def _decimals(value: float, unit: str) -> int:
    if unit in _DECIMALS_BY_UNIT:
        return _DECIMALS_BY_UNIT[unit]
    if value == int(value):
        return 0
    return min(max(_SIGNIFICANT_DIGITS - 1 - math.floor(math.log10(abs(value))), 0), _MAX_DECIMALS)
