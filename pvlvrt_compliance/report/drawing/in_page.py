"""The figures of a test as a page has them: one a panel, and what `figures.js` needs to draw them."""

from functools import cache
from typing import NamedTuple

from markupsafe import Markup

from pvlvrt_compliance.report.drawing import plotly_json, svg
from pvlvrt_compliance.report.drawing.frame import frame_of
from pvlvrt_compliance.report.drawing.looks import Looks
from pvlvrt_compliance.report.drawing.model import Drawing, Over, Panel, Zoom
from pvlvrt_compliance.report.drawing.packing import compressed, packed
from pvlvrt_compliance.report.drawing.plotly_js import plotly_js
from pvlvrt_compliance.report.language import Texts


class Figure(NamedTuple):
    """A figure of the page."""

    key: str
    title: str
    says: str
    over: Over
    height: int  # px
    picture: Markup  # SVG


class Figures(NamedTuple):
    """All figures of a test, parts of the time to zoom on, and what plotly draws of each, packed."""

    each: tuple[Figure, ...]
    zooms: tuple[Zoom, ...]
    data: str


def figures_of(drawing: Drawing, texts: Texts, looks: Looks) -> Figures:
    """The figures of a drawing in a language; the page has the style of the looks besides."""
    data = [plotly_json.render(panel, drawing, texts) for panel in drawing.panels]
    each = tuple(_figure(panel, drawing, texts, looks) for panel in drawing.panels)
    zooms = tuple(zoom._replace(name=texts.named("plot.zoom", zoom.name)) for zoom in drawing.zooms)
    return Figures(each, zooms, packed(data))


@cache
def plotly_packed() -> str:
    """Plotly's JavaScript, compressed, which `figures.js` runs once the first figure comes into view.

    Raises
    ------
    PvlvrtError
        When it is missing from the installation.
    """
    return compressed(plotly_js().encode())


def _figure(panel: Panel, drawing: Drawing, texts: Texts, looks: Looks) -> Figure:
    title = texts(f"figure.{panel.key}.title") if panel.key else panel.title
    says = panel.says.said(texts) if panel.says else ""
    picture = Markup(looks.shortened(svg.figure(panel, drawing, texts, "page")))
    return Figure(panel.key, title, says, panel.over, frame_of(panel, drawing, texts).height, picture)
