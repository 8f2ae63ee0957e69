"""A panel of a drawing as the plain dictionary that plotly.js draws, once `figures.js` has unpacked its numbers."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from pvlvrt_compliance.report.drawing.canvas import UNITS_A_PX, canvas_of, spots_in
from pvlvrt_compliance.report.drawing.colours import BLACK, GREY, GRID, PAPER
from pvlvrt_compliance.report.drawing.frame import BOTTOM_PX, LEFT_PX, RIGHT_PX, ROW_PX, Frame, frame_of
from pvlvrt_compliance.report.drawing.model import Area, Bars, Dash, Drawing, Line, Mark, Panel, Shade
from pvlvrt_compliance.report.drawing.names import curve_name
from pvlvrt_compliance.report.drawing.packing import short
from pvlvrt_compliance.report.drawing.plotly_traces import (
    area_trace,
    bar_trace,
    line_trace,
    literal,
    translucent,
)
from pvlvrt_compliance.report.drawing.spots import placed
from pvlvrt_compliance.report.language import Texts

Figure = dict[str, Any]

_MOST_SHAPES = 50  # of lines of one look
_HALO = 0.8  # of the ground behind words that stand on curves

FONT = "system-ui, -apple-system, 'Segoe UI', 'Liberation Sans', Arial, sans-serif"


def render(panel: Panel, drawing: Drawing, texts: Texts) -> Figure:
    """Return a panel for plotly.js 3 or later.

    Parameters
    ----------
    panel : Panel
    drawing : Drawing
        What the panel is of; its marks and shades stand in every panel over time.
    texts : Texts
        The language of all words in it.

    Returns
    -------
    dict
        ``{"data": [...], "layout": {...}}``, ready for `packing.packed`: many numbers are arrays. A trace of samples
        has ``packed`` in place of ``x`` and ``y``: see `plotly_traces`; `figures.js` unpacks it.
    """
    marks, shades = (drawing.marks, drawing.shades) if panel.over == "time" else ((), ())
    frame = frame_of(panel, drawing, texts)
    layout = {
        **_COMMON_LAYOUT,
        "height": frame.height,
        "margin": {"l": LEFT_PX, "r": RIGHT_PX, "t": frame.top, "b": frame.height - frame.floor},
        "xaxis": _x_axis(panel, texts),
        "yaxis": _y_axis(panel, texts),
        "legend": {**_LEGEND, "y": short(-BOTTOM_PX / (frame.floor - frame.top))},
        "shapes": [*map(_shade, shades), *_verticals(marks)],
        "annotations": [
            *(_words(mark, frame, texts) for mark in marks if mark.words),
            *_pointed(panel, drawing, frame, texts),
        ],
    }
    return {"data": list(_traces(panel, texts)), "layout": layout}


_COMMON_LAYOUT: Mapping[str, Any] = {
    "font": {"family": FONT, "size": 12, "color": BLACK},
    "paper_bgcolor": PAPER,
    "plot_bgcolor": PAPER,
    "hoverlabel": {"bgcolor": PAPER, "bordercolor": GREY, "font": {"color": BLACK}},
    "modebar": {"bgcolor": "rgba(0,0,0,0)", "color": GREY, "activecolor": BLACK},
    "hovermode": "x unified",
    "dragmode": "zoom",
    "showlegend": True,
}

_LEGEND: Mapping[str, Any] = {
    "orientation": "h",
    "x": 0,
    "yanchor": "top",
    "font": {"size": 11},
    "bgcolor": "rgba(0,0,0,0)",
}

_AXIS: Mapping[str, Any] = {
    "showline": True,
    "linecolor": GREY,
    "mirror": True,
    "gridcolor": GRID,
    "zerolinecolor": GREY,
    "zerolinewidth": 0.5,
    "ticks": "outside",
    "ticklen": 4,
    "tickcolor": GREY,
}


def _x_axis(panel: Panel, texts: Texts) -> Figure:
    span = {} if panel.x.span is None else {"range": [short(at) for at in panel.x.span]}
    title = {"text": texts.named("axis", panel.x.label), "standoff": 6}
    of_time = {"hoverformat": ".4f", "zeroline": False} if panel.over == "time" else {}
    square = {"constrain": "domain"} if panel.equal else {}
    return {**_AXIS, "type": panel.x.scale, **span, "title": title, **of_time, **square}


def _y_axis(panel: Panel, texts: Texts) -> Figure:
    span = {} if panel.y.span is None else {"range": [short(at) for at in panel.y.span]}
    equal = {"scaleanchor": "x", "scaleratio": 1, "constrain": "domain"} if panel.equal else {}
    return {
        **_AXIS,
        "type": panel.y.scale,
        **span,
        "title": {"text": texts.named("axis", panel.y.label), "standoff": 4},
        "rangemode": "tozero" if panel.y.from_zero else "normal",
        "nticks": 6,
        **equal,
    }


def _traces(panel: Panel, texts: Texts) -> Iterator[Figure]:
    def named(item: Line | Area | Bars) -> str:
        return literal(curve_name(item.name, texts))

    for area in panel.areas:
        yield {**area_trace(area), "name": named(area)}
    for bars in panel.bars:
        yield {**bar_trace(bars), "name": named(bars)}
    for line in panel.lines:
        yield {**line_trace(line), "name": named(line)}


def _shade(shade: Shade) -> Figure:
    return {
        "type": "rect",
        "layer": "below",
        "xref": "x",
        "yref": "paper",
        "x0": short(shade.begin_s),
        "x1": short(shade.end_s),
        "y0": 0,
        "y1": 1,
        "line": {"width": 0},
        "fillcolor": translucent(shade.colour, shade.opacity),
    }


def _verticals(marks: Sequence[Mark]) -> Iterator[Figure]:
    """Lines at instants: a shape each, or of very many of one look one, as each takes a browser milliseconds."""
    looks: dict[tuple[str, Dash | None], list[Mark]] = {}
    for mark in marks:
        if mark.dash:
            looks.setdefault((mark.colour, mark.dash), []).append(mark)
    for (colour, dash), lines in looks.items():
        if len(lines) <= _MOST_SHAPES:
            yield from map(_vertical, lines)
        else:
            path = "".join(f"M{short(mark.at_s)},0V1" for mark in lines)
            line = {"color": colour, "width": 1, "dash": dash}
            yield {"type": "path", "xref": "x", "yref": "paper", "path": path, "line": line}


def _vertical(mark: Mark) -> Figure:
    return {
        "type": "line",
        "xref": "x",
        "yref": "paper",
        "x0": short(mark.at_s),
        "x1": short(mark.at_s),
        "y0": 0,
        "y1": 1,
        "line": {"color": mark.colour, "width": 1, "dash": mark.dash},
    }


def _words(mark: Mark, frame: Frame, texts: Texts) -> Figure:
    return {
        "text": literal(mark.words.said(texts)) if mark.words else "",
        "x": short(mark.at_s),
        "xref": "x",
        "xanchor": mark.anchor,
        "y": 1,
        "yref": "paper",
        "yanchor": "bottom",
        "yshift": ROW_PX * frame.rows.index(mark.row),
        "showarrow": False,
        "font": {"size": 11, "color": mark.words_colour},
    }


def _pointed(panel: Panel, drawing: Drawing, frame: Frame, texts: Texts) -> Iterator[Figure]:
    """A dot each, and words beside it."""
    if not panel.spots:
        return
    canvas = canvas_of(panel, drawing, frame)
    x, y = (values / UNITS_A_PX for values in spots_in(panel, canvas))
    words = [spot.words.said(texts) for spot in panel.spots]
    points = list(zip(x.tolist(), y.tolist(), strict=True))
    places = placed(points, words, canvas.width / UNITS_A_PX, canvas.height / UNITS_A_PX)
    for spot, text, place in zip(panel.spots, words, places, strict=True):
        yield {
            "text": literal(texts("mark.broken", check=text) if spot.is_broken else text),
            "bgcolor": translucent(PAPER, _HALO),
            "x": short(spot.x),
            "y": short(spot.y),
            "showarrow": True,
            "arrowhead": 6,  # a dot
            "arrowcolor": spot.colour,
            "ax": 0,
            "ay": place.below_px,
            "xanchor": place.anchor,
            "yanchor": "bottom" if place.below_px < 0 else "top",
            "font": {"size": 11, "color": spot.colour},
        }
