"""What a panel is drawn on: its axes in units of a picture."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.report.drawing.frame import Frame
from pvlvrt_compliance.report.drawing.model import Drawing, OnGrid, Panel, Places, Point, Scale
from pvlvrt_compliance.report.drawing.spans import span_of

Array = NDArray[np.float64]

UNITS_A_PX = 2
"""Of the coordinates in paths."""


class Canvas(NamedTuple):
    """What a panel is drawn on: spans and scales of its axes, its size in units, instants that part what they part."""

    x: Point
    y: Point
    width: float
    height: float
    scales: tuple[Scale, Scale] = ("linear", "linear")
    instants: tuple[float, ...] = ()  # in units

    def across(self, x: Places | Array) -> Array:
        """Places in units from the left."""
        return self.width * _shares(floats(x), self.x, self.scales[0])

    def down(self, y: Sequence[float] | Any) -> Array:
        """Values in units from the top."""
        with np.errstate(over="ignore"):  # what is beyond all numbers is a gap
            return self.height * (1 - _shares(floats(y), self.y, self.scales[1]))


def floats(of: Places | Array) -> Array:
    """Places, or values, as an array of float64."""
    found: Array = np.asarray(of.first + of.step * of.numbers if isinstance(of, OnGrid) else of, dtype=np.float64)
    return found


def canvas_of(panel: Panel, drawing: Drawing, frame: Frame) -> Canvas:
    """What a panel is drawn on in its frame."""
    height_px = frame.floor - frame.top
    x, y = span_of(panel)
    if panel.equal:
        x, y = _equal(x, y, frame.plot / height_px)
    size = (UNITS_A_PX * float(frame.plot), UNITS_A_PX * float(height_px))
    canvas = Canvas(x, y, *size, scales=(panel.x.scale, panel.y.scale))
    marks = drawing.marks if panel.over == "time" else ()
    return canvas._replace(instants=tuple(canvas.across([mark.at_s for mark in marks if mark.dash]).tolist()))


def spots_in(panel: Panel, canvas: Canvas) -> tuple[Array, Array]:
    """Where the spots of a panel are (units), from the left and from the top."""
    return canvas.across([spot.x for spot in panel.spots]), canvas.down([spot.y for spot in panel.spots])


def _equal(x: Point, y: Point, ratio: float) -> tuple[Point, Point]:
    """Spans of axes on which a unit is as long, about the same middles; ``ratio``: how much wider than high it is."""
    height = max(y[1] - y[0], (x[1] - x[0]) / ratio)
    middles = ((x[0] + x[1]) / 2, (y[0] + y[1]) / 2)
    sizes = (height * ratio / 2, height / 2)
    first, second = ((middle - size, middle + size) for middle, size in zip(middles, sizes, strict=True))
    return first, second


def _shares(values: Array, span: Point, scale: Scale) -> Array:
    low, high = span
    if scale == "log":
        with np.errstate(divide="ignore", invalid="ignore"):
            values, low, high = np.log(values), float(np.log(low)), float(np.log(high))
    return (values - low) / (high - low)
