"""Curves and areas as what is inked of them on a canvas: strokes, and what is filled where a wave swings too fast."""

from collections.abc import Iterator
from functools import lru_cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.report.drawing.canvas import Array, Canvas, floats
from pvlvrt_compliance.report.drawing.ink import Ink, Way
from pvlvrt_compliance.report.drawing.model import Area, Bars, Line

_MEETING = 0.1  # units
_CELL = 24.0  # units: a swing within is no longer seen as a curve
_FINEST_CELL, _MORE_THAN_HALF = 3.0, 1.1  # of an outline: units, and of half a period
_SWINGS, _LEAST_SWING = 2.2, 8.0  # ways up and down in a cell by its height, and the least height (units), of a swing


class Drawn(NamedTuple):
    """A line as paths: of its strokes, of what is filled where it swings too fast to be seen, and of that's edges."""

    stroke: str
    fill: str
    edges: str = ""


class Ways(NamedTuple):
    """The same while it is inked."""

    stroke: list[Way]
    fill: list[Way]
    edges: list[Way]

    def drawn(self, ink: Ink) -> Drawn:
        """As paths."""
        return Drawn(*map(ink.path, self))


def line_ways(line: Line, canvas: Canvas, ink: Ink) -> Ways:
    """A line as it is inked."""
    ways = Ways([], [], [])
    for x, y in _pieces(line, canvas):
        _part(x, y, canvas, ink, ways)
    return ways


def area_ways(area: Area, canvas: Canvas, ink: Ink, *, along_edges: bool) -> Ways:
    """What lies around all strips of an area as it is inked, and, if wanted, both lines of them without their ends."""
    ways = Ways([], [], [])
    for x, lower, upper in _strips(area, canvas):
        ways.fill.append(ink.outline(x, lower, upper))
        if along_edges:
            ways.edges.extend((ink.line(x, lower), ink.line(x, upper)))
    return ways


def bars_path(bars: Bars, canvas: Canvas) -> str:
    """The path around all bars."""
    at, heights = np.asarray(bars.at), np.asarray(bars.heights)
    shown = np.isfinite(heights)
    left, right = (canvas.across(at[shown] + side * bars.width / 2) for side in (-1, 1))
    (zero,) = canvas.down([max(canvas.y[0], 0.0)])
    corners = zip(left, right, canvas.down(heights[shown]), strict=True)
    return "".join(f"M{a:.0f} {zero:.0f}V{top:.0f}H{b:.0f}V{zero:.0f}z" for a, b, top in corners)


def _pieces(line: Line, canvas: Canvas) -> Iterator[tuple[Array, Array]]:
    """The points of a line between its gaps, in units."""
    if not line.runs:
        return
    x = canvas.across(np.concatenate([floats(run.x) for run in line.runs]))
    y = canvas.down(np.concatenate([floats(run.y) for run in line.runs]))
    first = np.cumsum([0, *(len(run.y) for run in line.runs[:-1])])
    for known in _known(np.isfinite(x) & np.isfinite(y), first):
        yield x[known], y[known]


def _strips(area: Area, canvas: Canvas) -> Iterator[tuple[Array, Array, Array]]:
    """Places, lower and upper line of strips between their gaps, in units, those that meet as one."""
    if not area.strips:
        return
    edges = [np.concatenate([floats(strip[k]) for strip in area.strips]) for k in range(3)]
    x, lower, upper = canvas.across(edges[0]), canvas.down(edges[1]), canvas.down(edges[2])
    first = np.cumsum([0, *(len(strip.lower) for strip in area.strips[:-1])])
    meets = np.append(False, np.abs(x[first[1:]] - x[first[1:] - 1]) < _MEETING)
    for known in _known(np.isfinite(x) & np.isfinite(lower) & np.isfinite(upper), first[~meets]):
        yield x[known], lower[known], upper[known]


def _known(finite: NDArray[np.bool_], first: NDArray[np.int64]) -> Iterator[slice]:
    """Stretches of points that are finite, parted before those that are first of something."""
    if finite.all():
        edges = [*dict.fromkeys(first.tolist()), len(finite)]
        yield from (slice(begin, end) for begin, end in pairwise(edges) if begin < end)
        return
    parted = np.zeros(len(finite) + 1, dtype=np.bool_)
    parted[first], parted[-1] = True, True
    before = parted[:-1] | ~np.append(False, finite[:-1])
    after = parted[1:] | ~np.append(finite[1:], False)
    begins, ends = (np.flatnonzero(finite & edge).tolist() for edge in (before, after))
    yield from (slice(begin, end + 1) for begin, end in zip(begins, ends, strict=True))


def _part(x: Array, y: Array, canvas: Canvas, ink: Ink, ways: Ways) -> None:
    """Ink points as stroke, and as fill wherever they go up and down within a cell."""
    if len(x) <= canvas.width / _CELL or not x[0] < x[-1] or (np.diff(x) < 0).any():
        ways.stroke.append(ink.line(x, y))
        return
    begins = _cells(x, canvas)
    lows, highs = np.minimum.reduceat(y, begins), np.maximum.reduceat(y, begins)
    sizes = np.add.reduceat(np.abs(np.diff(y, prepend=y[:1])), begins)
    swings = (sizes > _SWINGS * (highs - lows)) & (highs - lows > _LEAST_SWING)
    swings[1:-1] |= swings[:-2] & swings[2:]  # one cell between two others
    swings[1:-1] &= swings[:-2] | swings[2:]  # none on its own
    swings[-1] |= swings[-2:].any()  # a last one that is shorter
    ends = np.append(begins[1:], len(x))
    cuts = np.unique(np.searchsorted(x, canvas.instants))
    for group in _alike(swings):
        first, end = int(begins[group.start]), int(ends[group.stop - 1])
        if not swings[group.start]:
            ways.stroke.append(ink.line(x[first : end + 1], y[first : end + 1]))  # up to the first of the next
            continue
        within = slice(np.searchsorted(cuts, first, "right"), np.searchsorted(cuts, end))
        for begin, stop in pairwise([first, *cuts[within].tolist(), end]):
            _swing(x[begin:stop], y[begin:stop], ink, ways)


def _cells(x: Array, canvas: Canvas) -> NDArray[np.int64]:
    """The first point of each cell: cells of one width, parted at instants, those without a point left out."""
    edges = _cell_edges(canvas.width, canvas.instants)
    begins = np.searchsorted(x, edges[edges < x[-1]])
    found: NDArray[np.int64] = begins[np.append(True, np.diff(begins) > 0)]
    return found


@lru_cache(maxsize=8)
def _cell_edges(width: float, instants: tuple[float, ...]) -> Array:
    edges: Array = np.unique(np.concatenate([np.arange(0, width, _CELL), instants]))
    return edges


def _alike(flags: NDArray[np.bool_]) -> Iterator[slice]:
    edges = [0, *(np.flatnonzero(np.diff(flags)) + 1).tolist(), len(flags)]
    yield from (slice(a, b) for a, b in pairwise(edges))


def _swing(x: Array, y: Array, ink: Ink, ways: Ways) -> None:
    """Ink what a wave swings in: at each place its highest and lowest values of about one period."""
    turns = np.count_nonzero(np.diff(np.sign(np.diff(y))))
    half_period = (x[-1] - x[0]) / max(turns, 1)
    cell = min(max(_MORE_THAN_HALF * half_period, _FINEST_CELL), _CELL)
    places = np.arange(x[0], x[-1], cell)
    begins = np.unique([0, *np.searchsorted(x, places[places < x[-1]])])  # rounding may put the last beyond the end
    high = _joined(np.maximum.reduceat(y, begins), np.fmax)
    low = _joined(np.minimum.reduceat(y, begins), np.fmin)
    places = np.append(x[begins], x[-1])
    ways.fill.append(ink.outline(places, high, low))
    ways.edges.extend((ink.line(places, high), ink.line(places, low)))


def _joined(levels: Array, further: Any) -> Array:
    """Levels of cells at their edges: the further one of both sides; the outermost as the ones next to them."""
    joined: Array = further(np.append(levels, np.nan), np.append(np.nan, levels))
    if len(levels) > 1:
        joined[[0, -1]] = joined[[1, -2]]
    return joined
