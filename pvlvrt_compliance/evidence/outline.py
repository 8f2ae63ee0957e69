"""A series as the few points that straight lines between them need."""

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
    count = len(lines[0])
    kept = np.ones(count, dtype=np.bool_)
    straight, step = np.ones(max(count - 1, 0), dtype=np.bool_), 1
    while step < count and straight.any():
        begin = np.arange(0, count - 2 * step, 2 * step)
        if not len(begin):
            break
        halves = begin[straight[begin] & straight[begin + step]]
        straight[begin] = False
        whole = halves[_is_straight(fine, x, lines, halves, 2 * step)]
        straight[whole] = True
        kept[whole + step] = False
        step *= 2
    return kept


def _is_straight(fine: float, x: Samples, lines: tuple[Samples, ...], begin: NDArray[np.int64], length: int) -> Mask:
    """Whether all points of each stretch lie near the line from its first to its last."""
    straight = np.ones(len(begin), dtype=np.bool_)
    x_0, x_1 = x[begin, np.newaxis], x[begin + length, np.newaxis]
    share = (x[begin[:, np.newaxis] + np.arange(1, length)] - x_0) / (x_1 - x_0)
    for line in lines:
        first, last = line[begin, np.newaxis], line[begin + length, np.newaxis]
        inside = line[begin[:, np.newaxis] + np.arange(1, length)]
        straight &= (np.abs(inside - (first + share * (last - first))) <= fine).all(axis=1)
    return straight
