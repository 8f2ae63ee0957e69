"""Where a panel stands in its figure, the same in every drawer: words of marks above it, axis and legend below."""

import math
from typing import NamedTuple

from pvlvrt_compliance.report.drawing.model import Drawing, Panel, plain
from pvlvrt_compliance.report.drawing.names import curve_name
from pvlvrt_compliance.report.language import Texts

WIDTH_PX = 760
NARROW_PX = 372  # two of them stand beside each other on paper
LEFT_PX, RIGHT_PX, BOTTOM_PX = 62, 12, 40
ROW_PX = 15  # of words above
LEGEND_ROW_PX = 17
SYMBOL_PX, CHARACTER_PX = 45.0, 6.0  # of a legend

_HEIGHT_PX, _SQUARE_PX = 150.0, 340.0
_TOP_PX = 6
_LEAST_PLOT_PX = 606.0  # between the margins of the narrowest figure: on A4, and on a phone, which scrolls it


class Frame(NamedTuple):
    """Heights of a figure (px, from its top): its panel's top and floor, and all of it; rows of words above it."""

    top: int
    floor: int
    height: int
    rows: tuple[int, ...]  # of marks with words, the nearest first
    columns: int  # of the legend
    width: int = WIDTH_PX

    @property
    def plot(self) -> int:
        """Width between the margins (px)."""
        return self.width - LEFT_PX - RIGHT_PX


def frame_of(panel: Panel, drawing: Drawing, texts: Texts, narrow: bool = False) -> Frame:
    """The frame of a panel: as many rows as its words and its legend need in the narrowest figure.

    A ``narrow`` one takes half of a line, and is as high as it is wide within its margins.
    """
    width = NARROW_PX if narrow else WIDTH_PX
    plot_px = width - LEFT_PX - RIGHT_PX
    room_px = min(_LEAST_PLOT_PX, plot_px)
    square_px = min(_SQUARE_PX, plot_px)
    marks = drawing.marks if panel.over == "time" else ()
    rows = tuple(sorted({mark.row for mark in marks if mark.words}))
    top = _TOP_PX + ROW_PX * len(rows)
    floor = top + round(square_px if panel.equal else _HEIGHT_PX * panel.height)
    names = legend_of(panel, texts)
    widest = max((SYMBOL_PX + CHARACTER_PX * len(plain(name)) for name in names), default=room_px)
    columns = max(int(room_px / widest), 1)  # plotly sets several rows in columns of one width
    legend_px = LEGEND_ROW_PX * math.ceil(len(names) / columns)
    return Frame(top, floor, floor + BOTTOM_PX + legend_px + 4, rows, columns, width)


def legend_of(panel: Panel, texts: Texts) -> list[str]:
    """The names in the legend of a panel, with their markup."""
    names = [
        *(area.name for area in panel.areas if area.in_legend),
        *(bars.name for bars in panel.bars if bars.in_legend),
        *(line.name for line in panel.lines if line.in_legend),
    ]
    return [curve_name(name, texts) for name in names]
