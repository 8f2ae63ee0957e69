"""How numbers and verdicts are spelled for people, the same in the terminal and in HTML."""

import math
from typing import NamedTuple

from pvlvrt_compliance.results import JUDGED, Status, Verdict

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


THROUGHOUT = "throughout"
"""In place of a least time that nothing bounds."""

_BOUND_WORDS = {None: "", "at_least": "at least ", "at_most": "at most ", "band": "within ±"}
_BOUND_SIGNS = {None: ("", "+-"), "at_least": (">=", "-"), "at_most": ("<=", "+"), "band": ("+-", "+")}


class Row(NamedTuple):
    """The numbers of a verdict as text, empty where there is none; a tolerance of zero is none."""

    measured: str
    limit: str
    margin: str
    tolerance: str = ""
    uncertainty: str = ""


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
    """The numbers of a verdict, with decimals enough that a margin other than zero never reads as zero."""
    values = [v for v in (check.measured, check.limit, check.margin, check.tolerance or None) if v is not None]
    places = max((_decimals(v, check.unit) for v in values), default=0)
    while check.margin and places < _MAX_DECIMALS and float(f"{check.margin:.{places}f}") == 0:
        places += 1
    finest = places if check.uncertainty is None else max(places, _decimals(check.uncertainty, check.unit))
    return Row(
        measured=number(check.measured, check.unit, places),
        limit=number(check.limit, check.unit, places),
        margin=number(check.margin, check.unit, places, sign=True),
        tolerance=number(check.tolerance or None, check.unit, places),
        uncertainty=number(check.uncertainty, check.unit, finest),
    )


def limit_in_words(check: Verdict) -> str:
    """The limit with its kind and its tolerance: ``at least 160.7 kvar, tolerance 8.8``."""
    numbers = row(check)
    if not numbers.limit:
        return _without_limit(check)
    tolerance = f", tolerance {bare(numbers.tolerance, check)}" if numbers.tolerance else ""
    return f"{_BOUND_WORDS[check.bound]}{numbers.limit}{tolerance}"


def limit_in_signs(check: Verdict) -> str:
    """The same where there is no room: ``>=160.7-8.8`` is what the measured value must reach. No unit, plain ASCII."""
    numbers = row(check)
    if not numbers.limit:
        return _without_limit(check)
    sign, widened = _BOUND_SIGNS[check.bound]
    tolerance = f"{widened}{bare(numbers.tolerance, check)}" if numbers.tolerance else ""
    if check.bound == "band" and tolerance and not check.limit:
        return f"{sign}{bare(numbers.tolerance, check)}"
    return f"{sign}{bare(numbers.limit, check)}{tolerance}"


def bare(text: str, check: Verdict) -> str:
    """A number of a verdict without its unit."""
    return text.removesuffix(f" {check.unit}")


def verdict_in_words(check: Verdict) -> str:
    """The status, and whether it is marginal."""
    return f"{STATUS_WORD[check.status]}{' (marginal)' if check.is_marginal else ''}"


def marginal_in_words(check: Verdict) -> str:
    """Why a verdict is marginal: ``margin -0.003 pu, uncertainty 0.005 pu``."""
    numbers = row(check)
    return f"margin {numbers.margin}, uncertainty {numbers.uncertainty}"


def stretch_unless_told(check: Verdict) -> str:
    """The stretch that a verdict speaks of; nothing where its message names it."""
    return "" if check.stretch in check.message else check.stretch


def _without_limit(check: Verdict) -> str:
    """A least time without a limit is demanded for as long as the record lasts."""
    return THROUGHOUT if check.status in JUDGED and check.bound == "at_least" else ""


def label(name: str) -> str:
    """Make a name of the data model readable: ``reactive_support`` becomes ``reactive support``."""
    return name.replace("_", " ")


def _decimals(value: float, unit: str) -> int:
    if unit in _DECIMALS_BY_UNIT:
        return _DECIMALS_BY_UNIT[unit]
    if value == int(value):
        return 0
    return min(max(_SIGNIFICANT_DIGITS - 1 - math.floor(math.log10(abs(value))), 0), _MAX_DECIMALS)
