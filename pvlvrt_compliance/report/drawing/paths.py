"""Curves and areas as short SVG paths: whole numbers, each from the point before, no more points than can be seen."""

from collections.abc import Iterator
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.evidence.outline import bends
from pvlvrt_compliance.report.drawing.canvas import UNITS_A_PX, Array, Canvas
from pvlvrt_compliance.report.drawing.model import Area, Bars, Line, Run

_FINE = 1.2  # units: what a line may be off by
_FAR = 1e6  # units: well outside of any frame
_MEETING = 0.1  # units
_CELL = 24.0  # units: a swing within is no longer seen as a curve
_FINEST_CELL, _MORE_THAN_HALF = 3.0, 1.1  # of an outline: units, and of half a period
_SWINGS, _LEAST_SWING = 2.2, 8.0  # ways up and down in a cell by its height, and the least height (units), of a swing


class Drawn(NamedTuple):
    """A line as paths: of its strokes, of what is filled where it swings too fast to be seen, and of that's edges."""

    stroke: str
    fill: str
    edges: str = ""


def line_paths(line: Line, canvas: Canvas) -> Drawn:
    """The paths of a line."""
    parts = [part for run in line.runs for x, y in _pieces(run, canvas) for part in _parted(x, y, canvas)]
    return Drawn(*("".join(paths) for paths in zip(*parts, strict=True))) if parts else Drawn("", "")


def area_path(area: Area, canvas: Canvas) -> str:
    """The path around all strips of an area."""
    return "".join(path for edges in _meeting(area, canvas) for path in _strip_paths(*edges))


def edges_path(area: Area, canvas: Canvas) -> str:
    """The paths along both lines of all strips of an area, without its ends."""
    return "".join(
        _edges(*(edge[known] for edge in edges))
        for edges in _meeting(area, canvas)
        for known in _known(np.logical_and.reduce([np.isfinite(edge) for edge in edges]))
    )


def bars_path(bars: Bars, canvas: Canvas) -> str:
    """The path around all bars."""
    at, heights = np.asarray(bars.at), np.asarray(bars.heights)
    shown = np.isfinite(heights)
    left, right = (canvas.across(at[shown] + side * bars.width / 2) for side in (-1, 1))
    (zero,) = canvas.down([max(canvas.y[0], 0.0)])
    corners = zip(left, right, canvas.down(heights[shown]), strict=True)
    return "".join(f"M{a:.0f} {zero:.0f}V{top:.0f}H{b:.0f}V{zero:.0f}z" for a, b, top in corners)


def _pieces(run: Run, canvas: Canvas) -> Iterator[tuple[Array, Array]]:
    """The points of a run between its gaps, in units."""
    x, y = canvas.across(run.x), canvas.down(run.y)
    for known in _known(np.isfinite(x) & np.isfinite(y)):
        yield x[known], y[known]


def _known(finite: NDArray[np.bool_]) -> Iterator[slice]:
    if finite.all():
        yield slice(0, len(finite))
        return
    edges = np.flatnonzero(np.diff(np.concatenate(([False], finite, [False])).astype(np.int8)))
    yield from (slice(int(first), int(end)) for first, end in edges.reshape(-1, 2))


def _meeting(area: Area, canvas: Canvas) -> Iterator[list[Array]]:
    """Places, lower and upper line of strips, those that meet as one."""
    last: list[Array] = []
    for strip in area.strips:
        edges = [canvas.across(strip.x), canvas.down(strip.lower), canvas.down(strip.upper)]
        if last and abs(edges[0][0] - last[0][-1]) < _MEETING:
            last = [np.append(before, after) for before, after in zip(last, edges, strict=True)]
            continue
        if last:
            yield last
        last = edges
    if last:
        yield last


def _strip_paths(x: Array, lower: Array, upper: Array) -> Iterator[str]:
    for known in _known(np.isfinite(x) & np.isfinite(lower) & np.isfinite(upper)):
        yield _outline(x[known], lower[known], upper[known])


def _parted(x: Array, y: Array, canvas: Canvas) -> Iterator[Drawn]:
    """Points as stroke, and as fill wherever they go up and down within a cell."""
    if len(x) <= canvas.width / _CELL or not x[0] < x[-1] or (np.diff(x) < 0).any():
        yield Drawn(_stroke(x, y), "")
        return
    begins = _cells(x, canvas)
    lows, highs = np.minimum.reduceat(y, begins), np.maximum.reduceat(y, begins)
    ways = np.add.reduceat(np.abs(np.diff(y, prepend=y[:1])), begins)
    swings = (ways > _SWINGS * (highs - lows)) & (highs - lows > _LEAST_SWING)
    swings[1:-1] |= swings[:-2] & swings[2:]  # one cell between two others
    swings[1:-1] &= swings[:-2] | swings[2:]  # none on its own
    swings[-1] |= swings[-2:].any()  # a last one that is shorter
    ends = np.append(begins[1:], len(x))
    for group in _alike(swings):
        first, end = int(begins[group.start]), int(ends[group.stop - 1])
        if not swings[group.start]:
            yield Drawn(_stroke(x[first : end + 1], y[first : end + 1]), "")  # up to the first of the next
            continue
        cuts = np.searchsorted(x[first : end + 1], canvas.instants) + first
        for begin, stop in pairwise(sorted({first, *(int(cut) for cut in cuts if first < cut < end), end})):
            yield _swung_in(x[begin:stop], y[begin:stop])


def _cells(x: Array, canvas: Canvas) -> NDArray[np.int64]:
    """The first point of each cell: cells of one width, parted at instants, those without a point left out."""
    edges = np.unique(np.concatenate([np.arange(0, canvas.width, _CELL), canvas.instants]))
    return np.unique(np.searchsorted(x, edges[edges < x[-1]]))


def _alike(flags: NDArray[np.bool_]) -> Iterator[slice]:
    edges = [0, *(np.flatnonzero(np.diff(flags)) + 1).tolist(), len(flags)]
    yield from (slice(a, b) for a, b in pairwise(edges))


def _swung_in(x: Array, y: Array) -> Drawn:
    """The outline of what a wave swings in: at each place its highest and lowest values of about one period."""
    turns = np.count_nonzero(np.diff(np.sign(np.diff(y))))
    half_period = (x[-1] - x[0]) / max(turns, 1)
    cell = min(max(_MORE_THAN_HALF * half_period, _FINEST_CELL), _CELL)
    begins = np.unique(np.searchsorted(x, np.arange(x[0], x[-1], cell))) if x[-1] > x[0] else np.zeros(1, dtype=int)
    high = _joined(np.maximum.reduceat(y, begins), np.fmax)
    low = _joined(np.minimum.reduceat(y, begins), np.fmin)
    places = np.append(x[begins], x[-1])
    return Drawn("", _outline(places, high, low), _edges(places, high, low))


def _joined(levels: Array, further: Any) -> Array:
    """Levels of cells at their edges: the further one of both sides; the outermost as the ones next to them."""
    joined: Array = further(np.append(levels, np.nan), np.append(np.nan, levels))
    if len(levels) > 1:
        joined[[0, -1]] = joined[[1, -2]]
    return joined


def _stroke(x: Array, y: Array) -> str:
    x, y = _seen(x, y)
    if len(x) > 2 and (np.diff(x) >= 0).all():
        kept = bends(_FINE, _rising(x), y)
        x, y = x[kept], y[kept]
    return _path(x, y)


def _edges(x: Array, lower: Array, upper: Array) -> str:
    return _stroke(x, lower) + _stroke(x, upper)


def _outline(x: Array, lower: Array, upper: Array) -> str:
    if len(x) > 2 and (np.diff(x) >= 0).all():
        kept = bends(_FINE, _rising(x), lower, upper)
        x, lower, upper = x[kept], lower[kept], upper[kept]
    return _path(np.append(x, x[::-1]), np.append(lower, upper[::-1])) + "z"


def _rising(x: Array) -> Array:
    """Places that rise everywhere, where some are the same."""
    return x + 1e-6 * np.arange(len(x))


def _seen(x: Array, y: Array) -> tuple[Array, Array]:
    """Of the points in one column of pixels the first, the highest, the lowest and the last."""
    columns = np.floor(x / UNITS_A_PX)
    begins = np.flatnonzero(np.diff(columns, prepend=np.nan) != 0)
    if len(x) <= 2 * len(begins) or (np.diff(x) < 0).any():
        return x, y
    sizes = np.diff(np.append(begins, len(x)))
    low, high = (np.repeat(edge.reduceat(y, begins), sizes) for edge in (np.minimum, np.maximum))
    kept = (y == low) | (y == high)
    kept[[0, -1]] = True
    return x[kept], y[kept]


def _path(x: Array, y: Array) -> str:
    """Points as an absolute beginning and steps from there; those that go straight on are one."""
    points = np.stack([x, y], axis=1).clip(-_FAR, _FAR).round().astype(np.int64)
    steps = np.diff(points, axis=0)
    steps = steps[(steps != 0).any(axis=1)]
    if not len(steps):
        return f"M{points[0, 0]} {points[0, 1]}h0"
    turns = steps[1:, 0] * steps[:-1, 1] != steps[1:, 1] * steps[:-1, 0]
    turns |= (steps[1:] * steps[:-1]).sum(axis=1) < 0  # straight back is a turn, too
    steps = np.add.reduceat(steps, np.flatnonzero(np.append(True, turns)))
    text = "l" + " ".join(f"{a} {b}" for a, b in steps.tolist())
    return f"M{points[0, 0]} {points[0, 1]}{text.replace(' -', '-')}"
