"""Broken lines and outlines as texts of SVG paths, all of a drawing at once: whole numbers, each from the one before.

A call for each of hundreds of short lines costs more than its numbers: here they stand one behind the other.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.evidence.outline import bends_of_each
from pvlvrt_compliance.report.drawing.canvas import UNITS_A_PX, Array

_FINE = 1.2  # units: what a line may be off by
_EVERY_POINT = -1.0  # off by less than nothing: no point is left out
_FAR = 1e6  # units: well outside of any frame

Way = int
"""A line that is inked, by its number, or an outline, by the one that is as far below -1 (``~number``)."""


class Ink:
    """What lines and outlines are drawn with: gathers their points, in units, and says their paths."""

    def __init__(self) -> None:
        self._lines: list[tuple[Array, Array]] = []
        self._outlines: list[tuple[Array, Array, Array]] = []
        self._of_lines: list[str] = []
        self._of_outlines: list[str] = []

    def line(self, x: Array, y: Array) -> Way:
        """Ink a broken line; of its points in one column of pixels the first, highest, lowest and last are seen."""
        self._lines.append((x, y))
        return len(self._lines) - 1

    def outline(self, x: Array, lower: Array, upper: Array) -> Way:
        """Ink what lies between two broken lines over the same places."""
        self._outlines.append((x, lower, upper))
        return ~(len(self._outlines) - 1)

    def path(self, ways: Sequence[Way]) -> str:
        """The path along all of these."""
        if len(self._of_lines) < len(self._lines):
            self._of_lines += _of_lines(self._lines[len(self._of_lines) :])
        if len(self._of_outlines) < len(self._outlines):
            self._of_outlines += _of_outlines(self._outlines[len(self._of_outlines) :])
        return "".join(self._of_lines[way] if way >= 0 else self._of_outlines[~way] for way in ways)


def _of_lines(lines: Sequence[tuple[Array, Array]]) -> list[str]:
    counts = np.array([len(x) for x, _ in lines])
    x, y = (np.concatenate(axis) for axis in zip(*lines, strict=True))
    rises = _rises(counts, x)
    seen = _seen(counts, x, y, rises)
    counts, x, y = _counted(counts, seen), x[seen], y[seen]
    kept = bends_of_each(np.where(rises, _FINE, _EVERY_POINT), counts.tolist(), _rising(counts, x), y)
    return _paths(_counted(counts, kept), x[kept], y[kept])


def _of_outlines(outlines: Sequence[tuple[Array, Array, Array]]) -> list[str]:
    counts = np.array([len(x) for x, _, _ in outlines])
    x, lower, upper = (np.concatenate(axis) for axis in zip(*outlines, strict=True))
    fine = np.where(_rises(counts, x), _FINE, _EVERY_POINT)
    kept = bends_of_each(fine, counts.tolist(), _rising(counts, x), lower, upper)
    counts, x, lower, upper = _counted(counts, kept), x[kept], lower[kept], upper[kept]
    back = 2 * np.repeat(counts, 2 * counts) - 1 - _numbers(2 * counts)
    forth = _numbers(2 * counts)
    ahead = forth <= back
    place = np.repeat(np.cumsum(counts) - counts, 2 * counts) + np.where(ahead, forth, back)
    return [f"{path}z" for path in _paths(2 * counts, x[place], np.where(ahead, lower[place], upper[place]))]


def _numbers(counts: NDArray[np.int64]) -> NDArray[np.int64]:
    """The number of each point in its line."""
    return np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)


def _counted(counts: NDArray[np.int64], kept: NDArray[np.bool_]) -> NDArray[np.int64]:
    """How many points of each line are kept."""
    return np.diff(np.cumsum(kept)[np.cumsum(counts) - 1], prepend=0)


def _rises(counts: NDArray[np.int64], x: Array) -> NDArray[np.bool_]:
    """Which lines never go back."""
    falls = np.append(False, np.diff(x) < 0)
    falls[np.cumsum(counts) - counts] = False
    steady: NDArray[np.bool_] = np.logical_and.reduceat(~falls, np.cumsum(counts) - counts)
    return steady


def _rising(counts: NDArray[np.int64], x: Array) -> Array:
    """Places that rise everywhere, where some are the same."""
    return x + 1e-6 * _numbers(counts)


def _seen(counts: NDArray[np.int64], x: Array, y: Array, rises: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Points that are seen, of the lines that rise and have many in one column of pixels."""
    first = np.cumsum(counts) - counts
    is_new = np.append(True, np.diff(np.floor(x / UNITS_A_PX)) != 0)
    is_new[first] = True
    begins = np.flatnonzero(is_new)
    is_dense = rises & (counts > 2 * np.add.reduceat(is_new.astype(np.int64), first))
    sizes = np.diff(np.append(begins, len(x)))
    low, high = (np.repeat(edge.reduceat(y, begins), sizes) for edge in (np.minimum, np.maximum))
    seen: NDArray[np.bool_] = (y == low) | (y == high) | ~np.repeat(is_dense, counts)
    seen[first] = seen[first + counts - 1] = True
    return seen


def _paths(counts: NDArray[np.int64], x: Array, y: Array) -> list[str]:
    """Points of each line as an absolute beginning and steps from there; those that go straight on are one."""
    points = np.stack([x, y], axis=1).clip(-_FAR, _FAR).round().astype(np.int64)
    line = np.repeat(np.arange(len(counts)), counts)
    steps = np.diff(points, axis=0)
    moves = (steps != 0).any(axis=1) & (line[1:] == line[:-1])
    steps, line = steps[moves], line[1:][moves]
    turns = np.ones(len(steps), dtype=np.bool_)
    turns[1:] = (steps[1:, 0] * steps[:-1, 1] != steps[1:, 1] * steps[:-1, 0]) | (line[1:] != line[:-1])
    turns[1:] |= (steps[1:] * steps[:-1]).sum(axis=1) < 0  # straight back is a turn, too
    begins = np.flatnonzero(turns)
    words = list(map(str, np.add.reduceat(steps, begins).ravel().tolist())) if len(begins) else []
    ends = 2 * np.cumsum(np.bincount(line[begins], minlength=len(counts)))
    heads = points[np.cumsum(counts) - counts].tolist()
    return [
        f"M{a} {b}{'l' + ' '.join(words[begin:end]).replace(' -', '-') if end > begin else 'h0'}"
        for (a, b), begin, end in zip(heads, [0, *ends[:-1].tolist()], ends.tolist(), strict=True)
    ]
