"""Panels as SVG: those of a profile from a template (`render`), one of a test as a compact picture (`figure`)."""

import textwrap
from collections.abc import Sequence
from typing import NamedTuple

from pvlvrt_compliance.report.drawing.clipping import Frame, area_within, lines_within
from pvlvrt_compliance.report.drawing.model import (
    STROKES_PX,
    Area,
    Dash,
    Line,
    Panel,
    Point,
    Points,
    Strip,
    broken_lines,
    outlines,
    plain,
)
from pvlvrt_compliance.report.drawing.spans import span_of
from pvlvrt_compliance.report.drawing.still import figure, figures
from pvlvrt_compliance.report.drawing.ticks import share, ticks
from pvlvrt_compliance.resources import resource_folder

__all__ = ["SUFFIX", "figure", "figures", "render"]

SUFFIX = ".svg"
WIDTH, PANEL_HEIGHT, LEFT, RIGHT, TOP, BOTTOM, LEGEND_ROW = 760, 330, 66, 20, 34, 50, 17
LETTERS_A_LINE = 90
_HEAD, _HEAD_ROW = 36.0, 18.0


def render(name: str, title: str, panels: Sequence[Panel]) -> str:
    """Return the panels as one SVG.

    Parameters
    ----------
    name, title : str
        What they are of: short, and in words.
    panels : sequence of Panel
    """
    from pvlvrt_compliance.report.templates import environment

    heading = textwrap.wrap(title, LETTERS_A_LINE)
    drawn, top = [], _HEAD + _HEAD_ROW * len(heading)
    for panel in panels:
        drawn.append(_Drawing(panel, top))
        top = drawn[-1].bottom
    template = environment(resource_folder("reports"), __file__).get_template("panels.svg.j2")
    return template.render(name=name, title=title, heading=heading, drawings=drawn, width=WIDTH, height=top)


class _Tick(NamedTuple):
    at: float
    label: str


class _Entry(NamedTuple):
    """What stands in a legend."""

    of: Line | Area
    name: str
    is_area: bool


class _Drawing:
    """A panel in the coordinates of the SVG."""

    def __init__(self, panel: Panel, top: float) -> None:
        self.panel = panel
        self.x_span, self.y_span = span_of(panel)
        self.top = top + TOP
        self.floor = self.top + PANEL_HEIGHT
        self.left, self.right = float(LEFT), float(WIDTH - RIGHT)
        self.legend = [
            *(_Entry(area, plain(area.name), True) for area in panel.areas if area.in_legend),
            *(_Entry(line, plain(line.name), False) for line in panel.lines if line.in_legend),
        ]
        self.legend_top = self.floor + BOTTOM
        self.bottom = self.legend_top + LEGEND_ROW * len(self.legend) + 12

    @property
    def x_ticks(self) -> list[_Tick]:
        """Places and texts along the horizontal axis."""
        return [_Tick(self._x(value), f"{value:g}") for value in ticks(self.x_span, self.panel.x.scale)]

    @property
    def y_ticks(self) -> list[_Tick]:
        """Places and texts along the vertical axis."""
        return [_Tick(self._y(value), f"{value:g}") for value in ticks(self.y_span)]

    def paths(self, line: Line) -> list[str]:
        """The runs of a line, each between its gaps, within the frame."""
        pieces = [self._placed(points) for run in line.runs for points in broken_lines(run)]
        return [_path(part) for piece in pieces for part in lines_within(self._frame, piece)]

    def outlines(self, strip: Strip) -> list[str]:
        """The corners of a strip, between its gaps, within the frame."""
        parts = [area_within(self._frame, self._placed(points)) for points in outlines(strip)]
        return [_path(part) for part in parts if part]

    def strokes(self, dash: Dash) -> str:
        """Lengths drawn and left out by turns; nothing for a line that is not broken."""
        return " ".join(f"{length:g}" for length in STROKES_PX[dash])

    @property
    def _frame(self) -> Frame:
        return Frame((self.left, self.right), (self.top, self.floor))

    def _placed(self, points: Points) -> Points:
        return tuple((self._x(x), self._y(y)) for x, y in points)

    def _x(self, value: float) -> float:
        return self.left + (self.right - self.left) * share(value, self.x_span, self.panel.x.scale)

    def _y(self, value: float) -> float:
        return self.floor - PANEL_HEIGHT * share(value, self.y_span, "linear")


def _path(points: Sequence[Point]) -> str:
    """Points as SVG has them."""
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
