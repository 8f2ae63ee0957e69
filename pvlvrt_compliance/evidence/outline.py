"""A series as the few points that straight lines between them need."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.evidence.series import Mask
from pvlvrt_compliance.waveforms.container import Samples


def bends(fine: float, x: Samples, *lines: Samples) -> Mask:
    """Which points a broken line needs, so that none that it leaves out is further than ``fine`` from it.

    Points are left out two, four, eight, ... at a time. What is not finite stays, and so do the first and the last.

    Parameters
    ----------
    fine : float
        In the unit of the lines.
    x : array, shape (n,)
        Places of the points, rising.
    lines : array, shape (n,)
        Lines over these places; a point that one of them needs is kept for all.
    """
    return bends_of_each(np.array([fine]), [len(x)], x, *lines)


def bends_of_each(fine: Samples, counts: Sequence[int], x: Samples, *lines: Samples) -> Mask:
    """The same of many broken lines that stand one behind the other, at little more than the cost of one.

    Parameters
    ----------
    fine : array, shape (m,)
        Of each.
    counts : sequence of int, shape (m,)
        How many points each has, n together.
    x : array, shape (n,)
        Places of the points; those of each rise.
    lines : array, shape (n,)
        As of `bends`.
    """
    sizes = np.asarray(counts)
    count, allowed = np.repeat(sizes, sizes), np.repeat(fine, sizes)
    number = np.arange(len(count)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    kept, straight, step = np.ones(len(count), dtype=np.bool_), np.ones(len(count), dtype=np.bool_), 1
    begin = np.flatnonzero(number % 2 == 0)
    while len(begin := begin[(number[begin] % (2 * step) == 0) & (number[begin] + 2 * step < count[begin])]):
        halves = begin[straight[begin] & straight[begin + step]]
        straight[begin] = False
        begin = halves[_is_straight(allowed, x, lines, halves, 2 * step)]
        straight[begin] = True
        kept[begin + step] = False
        step *= 2
    return kept


def _is_straight(fine: Samples, x: Samples, lines: tuple[Samples, ...], begin: NDArray[np.int64], length: int) -> Mask:
    """Whether all points of each stretch lie near the line from its first to its last."""
    straight = np.ones(len(begin), dtype=np.bool_)
    inside = begin[:, np.newaxis] + np.arange(1, length)
    x_0, x_1 = x[begin, np.newaxis], x[begin + length, np.newaxis]
    share = (x[inside] - x_0) / (x_1 - x_0)
    near = fine[begin, np.newaxis]
    for line in lines:
        first, last = line[begin, np.newaxis], line[begin + length, np.newaxis]
        straight &= (np.abs(line[inside] - (first + share * (last - first))) <= near).all(axis=1)
    return straight
