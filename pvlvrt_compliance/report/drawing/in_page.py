"""The figures of a test as a page has them: one a panel, and what `figures.js` needs to draw them."""

from typing import NamedTuple

from markupsafe import Markup

from pvlvrt_compliance.report.drawing import plotly_json, svg
from pvlvrt_compliance.report.drawing.frame import frame_of
from pvlvrt_compliance.report.drawing.looks import Looks
from pvlvrt_compliance.report.drawing.model import Drawing, Over, Panel, Zoom
from pvlvrt_compliance.report.drawing.packing import packed
from pvlvrt_compliance.report.language import Texts


class Figure(NamedTuple):
    """A figure of the page."""

    key: str
    title: str
    says: str
    over: Over
    height: int  # px
    picture: str  # SVG


class Figures(NamedTuple):
    """All figures of a test, parts of the time to zoom on, and what plotly draws of each, packed."""

    each: tuple[Figure, ...]
    zooms: tuple[Zoom, ...]
    data: str


def figures_of(drawing: Drawing, texts: Texts) -> Figures:
    """The figures of a drawing in a language; they may wait as they are for a page, which has them `styled`."""
    data = [plotly_json.render(panel, drawing, texts) for panel in drawing.panels]
    pictures = svg.figures(drawing.panels, drawing, texts, "page")
    each = tuple(
        _figure(panel, picture, drawing, texts) for panel, picture in zip(drawing.panels, pictures, strict=True)
    )
    zooms = tuple(zoom._replace(name=texts.named("plot.zoom", zoom.name)) for zoom in drawing.zooms)
    return Figures(each, zooms, packed(data))


def styled(figures: Figures, looks: Looks) -> Figures:
    """Figures whose pictures are markup of a page that has the style of the looks besides."""
    each = (figure._replace(picture=Markup(looks.shortened(figure.picture))) for figure in figures.each)
    return figures._replace(each=tuple(each))


def _figure(panel: Panel, picture: str, drawing: Drawing, texts: Texts) -> Figure:
    title = texts(f"figure.{panel.key}.title") if panel.key else panel.title
    says = panel.says.said(texts) if panel.says else ""
    return Figure(panel.key, title, says, panel.over, frame_of(panel, drawing, texts).height, picture)
