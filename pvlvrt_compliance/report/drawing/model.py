"""What is drawn, as plain data that no drawer's library is needed for: panels of lines and areas."""

import math
import re
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

if TYPE_CHECKING:  # what is drawn of a profile needs no numpy
    import numpy as np
    from numpy.typing import NDArray

    from pvlvrt_compliance.report.language import Texts

Scale = Literal["linear", "log"]
Dash = Literal["solid", "dash", "dot", "dashdot", "longdash"]
Over = Literal["time", "other"]
"""What the horizontal axis is of: the time of the record, shared with other panels, or something of its own."""

Point = tuple[float, float]
Points = tuple[Point, ...]

BLACK = "#222222"

STROKES_PX: dict[Dash, tuple[float, ...]] = {
    "solid": (),
    "dash": (9, 9),
    "dot": (3, 3),
    "dashdot": (9, 3, 3, 3),
    "longdash": (15, 15),
}
"""Lengths drawn and left out by turns, as plotly.js has them for lines up to 3 px wide."""

_MARKUP = re.compile("</?su[bp]>")


class Text(NamedTuple):
    """A text of the catalogues, by its key, and the values for its places."""

    key: str
    values: "dict[str, Said]"

    def said(self, texts: "Texts") -> str:
        """The text in a language."""
        return texts(self.key, **{name: _said(value, texts) for name, value in self.values.items()})


class Named(NamedTuple):
    """A name of the data, which a table of the catalogues has words for."""

    table: str
    name: str

    def __str__(self) -> str:
        return self.name.replace("_", " ")


Said = str | float | Text | Named | tuple[Text, ...]
"""A value of a text: as it is, a name, or itself a text; several are listed."""


def _said(value: Said, texts: "Texts") -> str | float:
    if isinstance(value, Text):
        return value.said(texts)
    if isinstance(value, Named):
        return texts.named(*value)
    if isinstance(value, tuple):
        return ", ".join(text.said(texts) for text in value)
    return value


class OnGrid(NamedTuple):
    """Places on a uniform grid: ``first + step * number``, for samples that are picked from a record."""

    first: float
    step: float
    numbers: "NDArray[np.int64]"  # shape (n,), rising


Places = OnGrid | Sequence[float]
"""Values of the horizontal axis, shape (n,)."""


class Run(NamedTuple):
    """Points that straight lines join; what is not finite is a gap."""

    x: Places
    y: Sequence[float] | Any  # or an array of float64, shape (n,)


class Strip(NamedTuple):
    """What lies between two broken lines over the same places."""

    x: Places
    lower: Sequence[float] | Any
    upper: Sequence[float] | Any


class Line(NamedTuple):
    """A curve or a limit: runs of points of one look.

    Of a ``group`` one line or area stands in the legend for all, and shows and hides them together.
    """

    name: str
    runs: tuple[Run, ...]
    colour: str = BLACK
    width: float = 1.3  # px
    dash: Dash = "solid"
    opacity: float = 1.0
    group: str = ""
    in_legend: bool = True
    told: bool = False  # whether its values are told under the pointer
    swings_s: float = 0.0  # the period of a wave, 0 of what is none: where its periods are close it is drawn fainter


class Area(NamedTuple):
    """Strips of one look, filled; with an edge of the same colour where it is ``edged``."""

    name: str
    strips: tuple[Strip, ...]
    colour: str = BLACK
    opacity: float = 0.18
    edged: bool = True
    group: str = ""
    in_legend: bool = True


class Bars(NamedTuple):
    """Bars from zero up to (or down to) a height each, of one look."""

    name: str
    at: tuple[float, ...]  # middles, shape (n,)
    heights: tuple[float, ...]  # shape (n,); what is not finite has no bar
    width: float = 0.8  # of each, in units of the horizontal axis
    colour: str = BLACK
    opacity: float = 1.0
    in_legend: bool = True


class Spot(NamedTuple):
    """A point that is pointed out, with words."""

    x: float
    y: float
    words: Text
    colour: str = BLACK
    is_broken: bool = False  # whether a limit is not met there


class Axis(NamedTuple):
    """One axis: what it is of with its unit, and from where to where; None: as far as what is drawn."""

    label: str
    span: Point | None = None
    scale: Scale = "linear"
    from_zero: bool = False


class Panel(NamedTuple):
    """One set of axes, ``height`` relative to the others; areas and bars lie below the lines, spots above.

    Title, labels of the axes and names of curves are English; of a panel with a ``key`` a report has its own words for
    them (tables ``figure``, ``axis`` and ``curve`` of the catalogues).
    """

    title: str
    x: Axis
    y: Axis
    lines: tuple[Line, ...]
    areas: tuple[Area, ...] = ()
    height: float = 1.0
    key: str = ""
    says: Text | None = None  # what is to be seen
    over: Over = "time"
    equal: bool = False  # whether a unit is as long on both axes
    bars: tuple[Bars, ...] = ()
    spots: tuple[Spot, ...] = ()


class Mark(NamedTuple):
    """An instant across all panels, with words in a row above them (1 is the nearest); none: without words."""

    at_s: float
    colour: str
    dash: Dash | None = None  # none: words alone, without a line
    words: Text | None = None
    row: int = 1
    anchor: Literal["left", "center", "right"] = "left"
    words_colour: str = BLACK


class Shade(NamedTuple):
    """A stretch of time that is shaded across all panels."""

    begin_s: float
    end_s: float
    colour: str
    opacity: float


class Zoom(NamedTuple):
    """A part of the time that a reader may want to see closer."""

    name: str
    begin_s: float
    end_s: float


class Drawing(NamedTuple):
    """Panels, and what is said of instants across all of them that are over time; they share its axis."""

    panels: tuple[Panel, ...]
    span: Point
    marks: tuple[Mark, ...] = ()
    shades: tuple[Shade, ...] = ()
    zooms: tuple[Zoom, ...] = ()


def broken_lines(run: Run) -> list[Points]:
    """The points of a run between its gaps."""
    return [tuple(points) for points in _between_gaps(run.x, run.y)]


def outlines(strip: Strip) -> list[Points]:
    """The corners of a strip between its gaps: along its lower line, and back along its upper one."""
    return [outline(Strip(*zip(*rows, strict=True))) for rows in _between_gaps(strip.x, strip.lower, strip.upper)]


def _between_gaps(x: Places, *edges: Sequence[float]) -> Iterator[list[Any]]:
    rows = zip(values(x), *edges, strict=True)
    for known, stretch in groupby(rows, key=lambda row: all(map(math.isfinite, row))):
        if known:
            yield list(stretch)


def plain(name: str) -> str:
    """A name without the markup of what is set high or low in it."""
    return _MARKUP.sub("", name)


def outline(strip: Strip) -> Points:
    """The corners of a strip: along its lower line, and back along its upper one."""
    x = values(strip.x)
    return (*zip(x, strip.lower, strict=True), *reversed(list(zip(x, strip.upper, strict=True))))


def values(x: Places) -> Sequence[float]:
    """The places as numbers, shape (n,)."""
    if isinstance(x, OnGrid):
        found: Sequence[float] = (x.first + x.step * x.numbers).tolist()
        return found
    return x
