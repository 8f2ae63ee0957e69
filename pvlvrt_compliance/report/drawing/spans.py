"""From where to where the axes of a panel go; of a panel of a profile without numpy."""

from collections.abc import Iterable
from typing import Any

from pvlvrt_compliance.report.drawing.model import Axis, Bars, Panel, Point, Scale, values

_BELOW, _ABOVE = 0.04, 0.06  # of the height, left free
_LARGEST = 1e300  # of a number that an axis can show; a run that got out of hand may hold any


def span_of(panel: Panel) -> tuple[Point, Point]:
    """From where to where the axes of a panel go, x and y: their own spans, or as far as what is drawn.

    Beyond what is drawn the vertical axis goes on a little, so that no line lies on the frame.
    """
    runs = [run for line in panel.lines for run in line.runs]
    strips = [strip for area in panel.areas for strip in area.strips]
    x, y = panel.x.span, panel.y.span
    if x is None:
        places = [*(run.x for run in runs), *(strip.x for strip in strips), *map(_sides, panel.bars)]
        x = _span([values(part) for part in places], panel.x)
    if y is None:
        edges = [run.y for run in runs] + [edge for strip in strips for edge in (strip.lower, strip.upper)]
        edges += [(0.0, *bars.heights) for bars in panel.bars]
        low, high = _span(edges, panel.y)
        y = (low - _BELOW * (high - low), high + _ABOVE * (high - low))
    return _apart(*x, panel.x.scale), _apart(*y, panel.y.scale)


def _sides(bars: Bars) -> tuple[float, ...]:
    """Where bars begin and end on the horizontal axis."""
    return tuple(at + side * bars.width / 2 for at in bars.at for side in (-1, 1))


def _span(lists: Iterable[Any], axis: Axis) -> Point:
    """The least and the largest number in some lists or arrays that the axis can show, apart from each other."""
    known = [v for numbers in lists for v in _ends(numbers, axis.scale)]
    known += [0.0] if axis.from_zero else []
    if not known:
        return (1.0, 10.0) if axis.scale == "log" else (0.0, 1.0)
    return _apart(min(known), max(known), axis.scale)


def _ends(numbers: Any, scale: Scale) -> list[float]:
    """The least and the largest number that a scale can show, or all that it can."""
    if len(numbers) and hasattr(numbers, "min"):  # an array, which says at once where it ends
        ends = [float(numbers.min()), float(numbers.max())]
        if all(abs(v) < _LARGEST and (v > 0 or scale == "linear") for v in ends):
            return ends
    return [float(v) for v in numbers if abs(v) < _LARGEST and (v > 0 or scale == "linear")]


def _apart(low: float, high: float, scale: Scale) -> Point:
    """Two numbers, put apart where they are one: an axis goes from somewhere to somewhere else."""
    if high > low:
        return low, high
    return (low / 2, high * 2) if scale == "log" else (low - 0.5, high + 0.5)
