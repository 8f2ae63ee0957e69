"""Which of several values is the largest or the smallest, where some are equal but for rounding.

Another processor, a faster sum or another order of the same sum moves a value in its last digits. Where a series is
flat these would pick the sample, the stretch or the phase that is reported; so the first of all that are equal is.
"""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, NamedTuple, TypeVar

if TYPE_CHECKING:  # items are compared where no array is loaded
    from pvlvrt_compliance.waveforms.container import Samples

ROUNDING = 1e-9
"""Part of a scale below which values are equal; chosen: far above what sums round, far below what is ever printed."""

T = TypeVar("T")


class Extreme(NamedTuple):
    """A largest or smallest value, and where it is first reached."""

    value: float
    at: int
    """The first of those that are equal to it within rounding, counted row by row."""


def largest(x: "Samples", scale: float) -> Extreme:
    """The largest of some values, and the first that equals it.

    Parameters
    ----------
    x : array, shape (n,) or with more axes
        Finite, at least one.
    scale : float
        What their rounding is a part of, same unit: nominal power, the limit.
    """
    value = float(x.max())
    return Extreme(value, int((x >= value - ROUNDING * scale).argmax()))


def smallest(x: "Samples", scale: float) -> Extreme:
    """The smallest of some values, and the first that equals it; parameters as `largest`."""
    value = float(x.min())
    return Extreme(value, int((x <= value + ROUNDING * scale).argmax()))


def first_least(items: Sequence[T], of: Callable[[T], float], scale: float) -> T:
    """The first of some items whose value is the least within rounding.

    Parameters
    ----------
    items : sequence
        At least one.
    of : callable
        Value of an item, infinite perhaps.
    scale : float
        As of `largest`.
    """
    values = [of(item) for item in items]
    enough = min(values) + ROUNDING * scale
    return next(item for item, value in zip(items, values, strict=True) if value <= enough)


def first_most(items: Sequence[T], of: Callable[[T], float], scale: float) -> T:
    """The first of some items whose value is the largest within rounding; parameters as `first_least`."""
    return first_least(items, lambda item: -of(item), scale)
