"""A panel of a test as a compact static SVG: what is seen without JavaScript, on paper and in a PDF."""

import re
from collections.abc import Iterator, Sequence
from html import escape
from typing import Literal

import numpy as np

from pvlvrt_compliance.report.drawing.canvas import UNITS_A_PX, canvas_of, spots_in
from pvlvrt_compliance.report.drawing.colours import BLACK, EDGES_PX, GREY, GRID, PAPER, variable
from pvlvrt_compliance.report.drawing.frame import (
    BOTTOM_PX,
    CHARACTER_PX,
    LEFT_PX,
    LEGEND_ROW_PX,
    ROW_PX,
    SYMBOL_PX,
    Frame,
    frame_of,
)
from pvlvrt_compliance.report.drawing.ink import Ink
from pvlvrt_compliance.report.drawing.model import (
    STROKES_PX,
    Area,
    Axis,
    Bars,
    Dash,
    Drawing,
    Line,
    Panel,
    Spot,
    plain,
)
from pvlvrt_compliance.report.drawing.names import curve_name
from pvlvrt_compliance.report.drawing.paths import area_ways, bars_path, line_ways
from pvlvrt_compliance.report.drawing.spots import placed
from pvlvrt_compliance.report.drawing.ticks import share, ticks
from pvlvrt_compliance.report.language import Texts

Theme = Literal["page", "plain"]

_SPACE = "http://www.w3.org/2000/svg"
_FONT = "Liberation Sans,DejaVu Sans,Arial,sans-serif"
_RAISED = re.compile("<su([bp])>(.*?)</su[bp]>")
_ANCHORS = {"left": "", "center": ' text-anchor="middle"', "right": ' text-anchor="end"'}
_SWINGING = 0.07  # how much is seen of the fill of what a line swings in


def figure(panel: Panel, drawing: Drawing, texts: Texts, theme: Theme = "page") -> str:
    """Return a panel as one SVG element.

    Parameters
    ----------
    panel : Panel
    drawing : Drawing
        What it is of: its marks and shades stand in every panel over time.
    texts : Texts
        The language of all words in it.
    theme : {"page", "plain"}
        Colours as variables of a page (`colours.style`) that is light or dark, or plain ones for a light ground, with a
        font of its own and a description; one with equal axes is narrow.
    """
    return figures([panel], drawing, texts, theme)[0]


def figures(panels: Sequence[Panel], drawing: Drawing, texts: Texts, theme: Theme = "page") -> list[str]:
    """Several panels of a drawing, each as of `figure`, at little more than the cost of one."""
    ink = Ink()
    stills = [_Still(panel, drawing, texts, theme, ink) for panel in panels]
    return [still.picture() for still in stills]


class _Still:
    """One panel in one frame."""

    def __init__(self, panel: Panel, drawing: Drawing, texts: Texts, theme: Theme, ink: Ink) -> None:
        self.panel, self.texts, self.is_plain = panel, texts, theme == "plain"
        self.marks, self.shades = (drawing.marks, drawing.shades) if panel.over == "time" else ((), ())
        self.frame: Frame = frame_of(panel, drawing, texts, narrow=self.is_plain and panel.equal)
        self.canvas = canvas_of(panel, drawing, self.frame)
        self.ink = ink  # of all panels: a path is asked for when all of them are inked
        drawn_elsewhere = {line.group for line in panel.lines}
        self.inked_lines = [line_ways(line, self.canvas, ink) for line in panel.lines]
        self.inked_areas = [
            area_ways(area, self.canvas, ink, along_edges=area.edged and area.group in drawn_elsewhere)
            for area in panel.areas
        ]

    def picture(self) -> str:
        """The whole of it."""
        title = self.texts(f"figure.{self.panel.key}.title") if self.panel.key else self.panel.title
        says = self.panel.says
        said = f"<desc>{escape(says.said(self.texts))}</desc>" if says and self.is_plain else ""
        alone = f' xmlns="{_SPACE}" role="img" font-family="{_FONT}"' if self.is_plain else ""
        width, height = self.frame.width, self.frame.height
        return (
            f'<svg{alone} viewBox="0 0 {width} {height}" width="{width}" height="{height}" font-size="11"'
            f' fill="{self._paint(BLACK)}"><title>{escape(title)}</title>{said}'
            f"{self._axes()}{self._inside()}"
            f"{''.join(self._words())}{''.join(self._spots())}{''.join(self._legend())}</svg>"
        )

    def _paint(self, colour: str) -> str:
        name = variable(colour)
        return colour if self.is_plain or not name else f"var({name})"

    def _axes(self) -> str:
        """Lines of the grid, the frame, numbers and names of the axes."""
        frame, canvas, grey = self.frame, self.canvas, self._paint(GREY)
        height, middle = frame.floor - frame.top, (frame.top + frame.floor) / 2
        across = [(LEFT_PX + share(v, canvas.x, canvas.scales[0]) * frame.plot, f"{v:g}") for v in self._ticks(0)]
        down = [(frame.floor - share(v, canvas.y, canvas.scales[1]) * height, f"{v:g}") for v in self._ticks(1)]
        grid = "".join(f"M{at:.0f} {frame.top}v{height}" for at, _ in across)
        grid += "".join(f"M{LEFT_PX} {at:.0f}h{frame.plot}" for at, _ in down)
        below = "".join(f'<text x="{at:.0f}" y="{frame.floor + 14}">{text}</text>' for at, text in across)
        beside = "".join(f'<text x="{LEFT_PX - 5}" y="{at + 4:.0f}">{text}</text>' for at, text in down)
        return (
            f'<path d="{grid}" stroke="{self._paint(GRID)}"/>'
            f'<path d="M{LEFT_PX} {frame.top}h{frame.plot}v{height}h-{frame.plot}z" fill="none" stroke="{grey}"/>'
            f'<g text-anchor="middle">{below}<text x="{LEFT_PX + frame.plot / 2:.0f}" y="{frame.floor + 29}"'
            f' font-size="12">{self._name(self.panel.x)}</text><text transform="translate(13 {middle:.0f})rotate(-90)"'
            f' font-size="12">{self._name(self.panel.y)}</text></g><g text-anchor="end">{beside}</g>'
        )

    def _ticks(self, axis: int) -> list[float]:
        span, scale = (self.canvas.x, self.canvas.y)[axis], self.canvas.scales[axis]
        return ticks(span, scale)

    def _name(self, axis: Axis) -> str:
        return escape(self.texts.named("axis", axis.label))

    def _inside(self) -> str:
        """What lies within the frame, cut off at it."""
        frame, canvas = self.frame, self.canvas
        joined = ' stroke-linejoin="round"' if self.is_plain else ""  # a page's style says it
        pieces = [*self._shaded(), *self._areas(), *self._bars(), *self._lines(), *self._verticals()]
        return (
            f'<svg x="{LEFT_PX}" y="{frame.top}" width="{frame.plot}" height="{frame.floor - frame.top}"'
            f' viewBox="0 0 {canvas.width:.0f} {canvas.height:.0f}" fill="none"{joined}>{"".join(pieces)}</svg>'
        )

    def _shaded(self) -> Iterator[str]:
        """Shades of one look after the other."""
        looks: dict[tuple[str, float], str] = {}
        for shade in self.shades:
            begin, end = np.clip(self.canvas.across([shade.begin_s, shade.end_s]), 0, self.canvas.width)
            path = f"M{begin:.0f} 0H{end:.0f}V{self.canvas.height:.0f}H{begin:.0f}z"
            look = (shade.colour, shade.opacity)
            looks[look] = looks.get(look, "") + path
        for (colour, opacity), path in looks.items():
            yield f'<path d="{path}" fill="{self._paint(colour)}" fill-opacity="{opacity:g}"/>'

    def _areas(self) -> Iterator[str]:
        for area, ways in zip(self.panel.areas, self.inked_areas, strict=True):
            drawn = ways.drawn(self.ink)
            if drawn.edges:
                yield self._swinging(drawn.fill, drawn.edges, area.colour)
            elif drawn.fill:
                yield f'<path d="{drawn.fill}"{self._filled(area)}/>'

    def _bars(self) -> Iterator[str]:
        for bars in self.panel.bars:
            look = f' fill="{self._paint(bars.colour)}"{_opacity(bars.opacity)}'
            yield f'<path d="{bars_path(bars, self.canvas)}"{look}/>'

    def _lines(self) -> Iterator[str]:
        for line, ways in zip(self.panel.lines, self.inked_lines, strict=True):
            drawn = ways.drawn(self.ink)
            if drawn.fill:
                yield self._swinging(drawn.fill, drawn.edges, line.colour)
            if drawn.stroke:
                yield f'<path d="{drawn.stroke}"{self._stroked(line, UNITS_A_PX)}/>'

    def _verticals(self) -> Iterator[str]:
        """Lines at instants, those of one look after the other."""
        looks: dict[tuple[str, Dash], str] = {}
        for mark in self.marks:
            if mark.dash:
                (at,) = self.canvas.across([mark.at_s])
                look = (mark.colour, mark.dash)
                looks[look] = looks.get(look, "") + f"M{at:.0f} 0V{self.canvas.height:.0f}"
        for (colour, dash), path in looks.items():
            yield f'<path d="{path}" stroke="{self._paint(colour)}" stroke-width="2"{_strokes(dash, UNITS_A_PX)}/>'

    def _words(self) -> Iterator[str]:
        """Words of instants above the frame."""
        for mark in self.marks:
            if mark.words:
                at = LEFT_PX + self.canvas.across([mark.at_s])[0] / UNITS_A_PX
                y = self.frame.top - 4 - ROW_PX * self.frame.rows.index(mark.row)
                colour = "" if mark.words_colour == BLACK else f' fill="{self._paint(mark.words_colour)}"'
                look = f"{colour}{_ANCHORS[mark.anchor]}"
                yield f'<text x="{at:.0f}" y="{y}"{look}>{escape(mark.words.said(self.texts))}</text>'

    def _spots(self) -> Iterator[str]:
        """A dot each, and its words beside it, none over another's."""
        x, y = (values / UNITS_A_PX for values in spots_in(self.panel, self.canvas))
        words = [spot.words.said(self.texts) for spot in self.panel.spots]
        size = (self.canvas.width / UNITS_A_PX, self.canvas.height / UNITS_A_PX)
        places = placed(list(zip(x.tolist(), y.tolist(), strict=True)), words, *size)
        for spot, text, at, level, place in zip(self.panel.spots, words, x, y, places, strict=True):
            left, top = LEFT_PX + at, self.frame.top + level
            look = f' fill="{self._paint(spot.colour)}"'
            yield self._marker(left, top, spot)
            anchor = f"{look}{_ANCHORS[place.anchor]}{self._halo()}"
            beside = 5 if place.anchor == "left" else -5
            yield f'<text x="{left + beside:.0f}" y="{top + place.below_px:.0f}"{anchor}>{escape(text)}</text>'

    def _marker(self, left: float, top: float, spot: Spot) -> str:
        """A dot, or a cross of what is not met: as a path, which no font has to have."""
        paint = self._paint(spot.colour)
        if not spot.is_broken:
            return f'<circle cx="{left:.0f}" cy="{top:.0f}" r="3" fill="{paint}"/>'
        cross = f"M{left - 4:.0f} {top - 4:.0f}l8 8m0-8l-8 8"
        return f'<path d="{cross}" fill="none" stroke="{paint}" stroke-width="2.5"/>'

    def _halo(self) -> str:
        """The ground around words that stand on curves; a page's style has it."""
        if not self.is_plain:
            return ' class="halo"'
        return f' stroke="{self._paint(PAPER)}" stroke-width="3" stroke-linejoin="round" paint-order="stroke"'

    def _legend(self) -> Iterator[str]:
        """Symbols and names, row by row."""
        panel = self.panel
        items: list[Line | Area | Bars] = [*panel.areas, *panel.bars, *panel.lines]
        entries = [(item, curve_name(item.name, self.texts)) for item in items if item.in_legend]
        columns = self.frame.columns
        step_px, at_px = self.frame.plot / columns, 0.0
        for k, (item, name) in enumerate(entries):
            row, column = divmod(k, columns)
            x = LEFT_PX + (column * step_px if len(entries) > columns else at_px)
            at_px += SYMBOL_PX + CHARACTER_PX * len(plain(name))
            y = self.frame.floor + BOTTOM_PX + LEGEND_ROW_PX * row
            yield self._symbol(item, round(x), y)
            yield f'<text x="{x + 28:.0f}" y="{y + 8}">{_raised(name)}</text>'

    def _symbol(self, of: Line | Area | Bars, x: int, y: int) -> str:
        if isinstance(of, Line):
            return f'<path d="M{x} {y + 4}h24"{self._stroked(of, 1)}/>'
        look = self._filled(of) if isinstance(of, Area) else f' fill="{self._paint(of.colour)}"{_opacity(of.opacity)}'
        return f'<path d="M{x} {y}h24v8h-24z"{look}/>'

    def _filled(self, area: Area) -> str:
        colour = self._paint(area.colour)
        edge = f' stroke="{colour}"' if area.edged else ""
        return f' fill="{colour}" fill-opacity="{area.opacity:g}"{edge}'

    def _swinging(self, fill: str, edges: str, colour: str) -> str:
        """A curve as what it swings in, and the edges of that, which are seen where it is flat, too."""
        paint = self._paint(colour)
        return (
            f'<path d="{fill}" fill="{paint}" fill-opacity="{_SWINGING:g}"/>'
            f'<path d="{edges}" stroke="{paint}" stroke-width="2"{_edge(colour)}/>'
        )

    def _stroked(self, line: Line, scale: int) -> str:
        width = f' stroke-width="{scale * line.width:g}"'
        faint = f' stroke-opacity="{line.opacity:g}"' if line.opacity < 1 else ""
        return f' stroke="{self._paint(line.colour)}"{width}{_strokes(line.dash, scale)}{faint}'


def _edge(colour: str) -> str:
    lengths = " ".join(f"{UNITS_A_PX * length:g}" for length in EDGES_PX.get(colour, ()))
    return f' stroke-dasharray="{lengths}"' if lengths else ""


def _strokes(dash: Dash, scale: int) -> str:
    lengths = " ".join(f"{scale * length:g}" for length in STROKES_PX[dash])
    return f' stroke-dasharray="{lengths}"' if lengths else ""


def _opacity(opacity: float) -> str:
    return f' fill-opacity="{opacity:g}"' if opacity < 1 else ""


def _raised(name: str) -> str:
    """A name as SVG has what is set high or low in it."""
    text, last = "", 0
    for found in _RAISED.finditer(name):
        down = 3 if found[1] == "b" else -4
        text += f'{escape(name[last : found.start()])}<tspan dy="{down}" font-size="8">{escape(found[2])}</tspan>'
        text += f'<tspan dy="{-down}">&#8203;</tspan>' if found.end() < len(name) else ""
        last = found.end()
    return text + escape(name[last:])
