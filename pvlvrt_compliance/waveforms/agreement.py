"""How far columns are from those that were expected, sample by sample."""

import math
import re
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.waveforms.container import Samples

MOST_SHIFTED = 2
"""Samples by which a column is shifted to see whether that alone is the difference (chosen)."""

_NUMBER = r"(?:\d++(?:\.\d*+)?|\.\d++)(?:[eE][+-]?\d++)?"
_TOLERANCE = re.compile(rf"({_NUMBER})\s*(%?)(?:\s*\+\s*({_NUMBER}))?")


class Tolerance(NamedTuple):
    """What a value may differ by: a share of the largest expected value of its column, and a number in its unit."""

    share: float = 1e-6
    absolute: float = 1e-9

    def __str__(self) -> str:
        return f"{self.share:g}+{self.absolute:g}"


def parse_tolerance(text: str, what: str) -> Tolerance:
    """Read ``0.1%``, ``1e-6`` or ``1e-6+1e-9``: a share, and what may come besides in the unit of the column.

    Raises
    ------
    UsageError
        When the text is none of these; ``what`` is how it was asked for.
    """
    found = _TOLERANCE.fullmatch(text.strip())
    if found is None:
        raise UsageError(
            f"{what}: {text!r} is no tolerance; write a share of the largest expected value, 0.1% or 1e-6, and what"
            " may come besides in the unit of the output: 1e-6+1e-9, or 0+1e-3 for that alone"
        )
    values = (float(found[1]) / (100 if found[2] else 1), float(found[3] or 0.0))
    if not all(map(math.isfinite, values)):
        raise UsageError(f"{what}: {text!r} is not finite")
    return Tolerance(*values)


class Difference(NamedTuple):
    """A sample that is not as expected."""

    sample: int  # number of it in the column, from 0
    at_s: float
    found: float
    expected: float


class Agreement(NamedTuple):
    """A column beside the expected one.

    Parameters
    ----------
    name, unit : str
    t_s, found, expected : array, shape (n,)
        What was compared.
    tolerance : Tolerance
    peak : float
        Largest expected value, its sign left out; of those that are finite.
    allowed : float
        What a sample may differ by.
    largest, rms : float
        Largest difference and root of the mean of its square; infinite where one value is finite and the other not, or
        where both are not and differ.
    at_s : float
        Time of the largest difference (s).
    outside : int
        Samples that differ by more than is allowed.
    first : Difference or None
        The first of them.
    shifted : int
        By how many samples the column is late (negative: early), where with that undone it is as expected; else 0.
    """

    name: str
    unit: str
    t_s: Samples
    found: Samples
    expected: Samples
    tolerance: Tolerance
    peak: float
    allowed: float
    largest: float
    rms: float
    at_s: float
    outside: int
    first: Difference | None
    shifted: int

    @property
    def is_inside(self) -> bool:
        """Whether no sample differs by more than is allowed."""
        return self.first is None

    @property
    def share(self) -> float:
        """Largest difference as a share of the largest expected value; of nothing but zeros not a number."""
        return self.largest / self.peak if self.peak > 0 else math.nan


def agreement(
    name: str,
    unit: str,
    t_s: Samples,
    column: Samples,
    places: NDArray[np.int64],
    expected: Samples,
    tolerance: Tolerance,
) -> Agreement:
    """Compare a column with what was expected of some of its samples.

    Parameters
    ----------
    t_s, column : array, shape (n,)
        All samples.
    places : array, shape (m,)
        Which of them were expected, at least one.
    expected : array, shape (m,)
    """
    found = column[places]
    finite = expected[np.isfinite(expected)]
    peak = float(np.abs(finite).max()) if len(finite) else 0.0
    allowed = tolerance.share * peak + tolerance.absolute
    off = differences(found, expected)
    worst = int(off.argmax())
    outside = np.flatnonzero(off > allowed)
    first = None
    if len(outside):
        k = int(outside[0])
        first = Difference(int(places[k]), float(t_s[places[k]]), float(found[k]), float(expected[k]))
    return Agreement(
        name=name,
        unit=unit,
        t_s=t_s[places],
        found=found,
        expected=expected,
        tolerance=tolerance,
        peak=peak,
        allowed=allowed,
        largest=float(off[worst]),
        rms=_rms(off),
        at_s=float(t_s[places[worst]]),
        outside=len(outside),
        first=first,
        shifted=_shifted(column, places, expected, allowed) if len(outside) else 0,
    )


def differences(found: Samples, expected: Samples) -> Samples:
    """Of each sample, its sign left out; none where both are no number, or both infinite alike, else infinite there."""
    with np.errstate(invalid="ignore", over="ignore"):
        off = np.abs(found - expected)
    same = (found == expected) | (np.isnan(found) & np.isnan(expected))
    return np.where(same, 0.0, np.where(np.isfinite(off), off, np.inf))


def _rms(off: Samples) -> float:
    """Root mean square; the largest is taken out, so that no square is beyond what a number holds."""
    largest = float(off.max())
    if largest == 0 or not math.isfinite(largest):
        return largest
    return largest * math.sqrt(float(np.mean((off / largest) ** 2)))


def _shifted(column: Samples, places: NDArray[np.int64], expected: Samples, allowed: float) -> int:
    """By how many samples a column is late that is as expected when that is undone; 0 where that does not help.

    What does not change shows nothing.
    """
    for shift in (shift for n in range(1, MOST_SHIFTED + 1) for shift in (n, -n)):
        moved = places + shift
        there = (moved >= 0) & (moved < len(column))
        known = expected[there]
        tells = len(known) > 2 * MOST_SHIFTED and np.ptp(known) > allowed
        if tells and (differences(column[moved[there]], known) <= allowed).all():
            return shift
    return 0
