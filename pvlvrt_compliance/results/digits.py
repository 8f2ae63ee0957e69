"""How many digits a number is shown with: those that fit its unit, and enough that a margin recomputes."""

import math
from decimal import Decimal
from typing import NamedTuple

from pvlvrt_compliance.results.verdict import Bound, Verdict

MAX_DECIMALS = 9

_DECIMALS_BY_UNIT = {
    "kW": 1,
    "kvar": 1,
    "pu": 3,
    "V": 1,
    "A": 1,
    "%": 3,
    "s": 3,
    "ms": 1,
    "Hz": 3,
    "kHz": 2,
    "Hz/s": 2,
    "deg": 1,
    "°": 1,
}
_SIGNIFICANT_DIGITS = 4
_RELATIVE_NOISE = 1e-6  # checks round the margin that they tell


class Digits(NamedTuple):
    """Decimals of the numbers of a verdict, and the margin as it follows from the others as they are shown."""

    places: int
    margin: float | None


def decimals(value: float, unit: str) -> int:
    """Decimals that a value is shown with; an unknown unit gets four significant digits."""
    if unit in _DECIMALS_BY_UNIT:
        return _DECIMALS_BY_UNIT[unit]
    if value == int(value):
        return 0
    return min(max(_SIGNIFICANT_DIGITS - 1 - math.floor(math.log10(abs(value))), 0), MAX_DECIMALS)


def margin_by(bound: Bound, measured: Decimal, limit: Decimal, tolerance: Decimal) -> Decimal:
    """What the kind of a limit makes of the numbers beside it."""
    if bound == "at_least":
        return measured - (limit - tolerance)
    return limit + tolerance - (measured if bound == "at_most" else abs(measured))


def digits_of(check: Verdict) -> Digits:
    """Decimals for all numbers of a verdict.

    A margin other than zero never reads as zero, nor with the wrong sign, nor as large as an uncertainty that it is
    below; where the kind of the limit explains it, it is what the numbers beside it give as they are shown, so that a
    reader who computes it finds the same last digit.
    """
    values = [v for v in (check.measured, check.limit, check.margin, check.tolerance or None) if v is not None]
    start = max((decimals(v, check.unit) for v in values), default=0)
    if check.margin is None:
        return Digits(start, None)
    for places in range(start, MAX_DECIMALS + 1):
        shown = _shown_margin(check, places)
        if _sign(shown) == _sign(check.margin) and _tells_marginal(check, shown, places):
            return Digits(places, shown)
    # One that is zero but for its rounding noise.
    return Digits(start, check.margin)


def _shown_margin(check: Verdict, places: int) -> float:
    if check.bound is None or check.measured is None or check.limit is None or not _is_explained(check):
        return round(check.margin or 0.0, places)
    numbers = (_rounded(value, places) for value in (check.measured, check.limit, check.tolerance))
    return float(margin_by(check.bound, *numbers))


def _tells_marginal(check: Verdict, shown: float, places: int) -> bool:
    """Whether it reads which of margin and uncertainty is larger; true where they are equal but for noise."""
    if check.uncertainty is None or check.margin is None:
        return True
    beyond = abs(check.margin) - check.uncertainty
    if abs(beyond) <= _RELATIVE_NOISE * max(1.0, check.uncertainty):
        return True
    beside = float(_rounded(check.uncertainty, max(places, decimals(check.uncertainty, check.unit))))
    return (abs(shown) < beside) == (beyond < 0)


def _is_explained(check: Verdict) -> bool:
    """Whether the margin that a check tells is that of its own numbers."""
    exact = [Decimal(value or 0.0) for value in (check.measured, check.limit, check.tolerance)]
    told = float(margin_by(check.bound or "at_most", exact[0], exact[1], exact[2]))
    scale = max(1.0, *(abs(float(value)) for value in exact))
    return abs(told - (check.margin or 0.0)) <= _RELATIVE_NOISE * scale


def _rounded(value: float, places: int) -> Decimal:
    """The number that is read where this one is shown."""
    return Decimal(f"{value:.{places}f}")


def _sign(value: float) -> int:
    return (value > 0) - (value < 0)
