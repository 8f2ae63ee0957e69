"""A drawing of a test as the plain dictionary that plotly.js draws, once `report.js` has unpacked its numbers."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from pvlvrt_compliance.report.drawing.colours import BLACK, GREY
from pvlvrt_compliance.report.drawing.instants import ROWS
from pvlvrt_compliance.report.drawing.model import Drawing, Mark, Panel, Shade, plain
from pvlvrt_compliance.report.drawing.plotly_traces import area_trace, line_trace, translucent

Figure = dict[str, Any]

_HEIGHT_PX = 150.0
_ROW_PX = 15  # of words above the first panel
_GAP_PX = 30.0
_TOP_PX = 55.0 + ROWS * _ROW_PX
_BOTTOM_PX = 44.0
_LEGEND_ROW_PX = 17.0
_LEAST_PLOT_PX = 606.0  # between the margins of the narrowest figure: on A4, and on a phone, which scrolls it
_SYMBOL_PX, _CHARACTER_PX = 45.0, 6.0  # of a legend; a title is bold
_BOLD_PX = 7.5
_FONT = "system-ui, -apple-system, 'Segoe UI', 'Liberation Sans', Arial, sans-serif"


class _Place(NamedTuple):
    """Where a panel stands: order from the top and its share of the height, from the bottom up; its legend."""

    order: int
    bottom: float
    top: float
    legend: float

    @property
    def suffix(self) -> str:
        return "" if self.order == 1 else str(self.order)


def render(drawing: Drawing) -> Figure:
    """Return the drawing for plotly.js 3 or later.

    Returns
    -------
    dict
        ``{"data": [...], "layout": {...}}``, ready for JSON, all of it lines over one axis of time. A trace of samples
        has ``packed`` in place of ``x`` and ``y``: see `plotly_traces`; `report.js` unpacks it.
    """
    panels = drawing.panels
    plot_px = sum(panel.height * _HEIGHT_PX for panel in panels) + sum(_gap_px(panel) for panel in panels[1:])
    placed = list(zip(panels, _places(panels, plot_px), strict=True))
    layout = {
        **_COMMON_LAYOUT,
        "height": round(plot_px + _TOP_PX + _BOTTOM_PX),
        "xaxis": _time_axis(drawing, anchor=f"y{placed[-1][1].suffix}" if placed else "y"),
        "updatemenus": [_zoom_buttons(drawing)],
        "shapes": [*map(_shade, drawing.shades), *(_vertical(mark) for mark in drawing.marks if mark.dash)],
        "annotations": [
            *(_words(mark) for mark in drawing.marks if mark.words),
            *(_title(panel, at) for panel, at in placed),
        ],
    }
    for panel, at in placed:
        layout[f"yaxis{at.suffix}"] = _value_axis(panel, at)
        layout[f"legend{at.suffix}"] = {**_LEGEND, "y": at.legend}
    return {"data": [trace for panel, at in placed for trace in _traces(panel, at)], "layout": layout}


_COMMON_LAYOUT: Mapping[str, Any] = {
    "margin": {"l": 62, "r": 12, "t": _TOP_PX, "b": _BOTTOM_PX},
    "font": {"family": _FONT, "size": 12, "color": BLACK},
    "paper_bgcolor": "#ffffff",
    "plot_bgcolor": "#ffffff",
    "hovermode": "x unified",
    "hoversubplots": "axis",
    "dragmode": "zoom",
}

_LEGEND: Mapping[str, Any] = {
    "orientation": "h",
    "x": 1,
    "xanchor": "right",
    "yanchor": "bottom",
    "font": {"size": 11},
    "bgcolor": "rgba(0,0,0,0)",
}

_AXIS: Mapping[str, Any] = {
    "showline": True,
    "linecolor": GREY,
    "mirror": True,
    "gridcolor": "#e4e4e4",
    "zerolinecolor": "#bdbdbd",
    "ticks": "outside",
    "ticklen": 4,
    "tickcolor": GREY,
}


def _places(panels: Sequence[Panel], plot_px: float) -> Iterator[_Place]:
    top_px = plot_px
    for order, panel in enumerate(panels, start=1):
        if order > 1:
            top_px -= _gap_px(panel)
        legend_px = top_px + (_LEGEND_ROW_PX if order > 1 and _rows_above(panel) else 0.0)
        bottom_px = top_px - panel.height * _HEIGHT_PX
        yield _Place(order, max(bottom_px / plot_px, 0.0), top_px / plot_px, legend_px / plot_px)
        top_px = bottom_px


def _gap_px(panel: Panel) -> float:
    return _GAP_PX + _rows_above(panel) * _LEGEND_ROW_PX


def _rows_above(panel: Panel) -> int:
    """Rows that the legend takes above the title of its panel; none where it fits beside it, however narrow."""
    names = [area.name for area in panel.areas if area.in_legend]
    names += [line.name for line in panel.lines if line.in_legend]
    widths = [_SYMBOL_PX + _CHARACTER_PX * len(plain(name)) for name in names]
    if _BOLD_PX * len(panel.title) + sum(widths) <= _LEAST_PLOT_PX:
        return 0
    if sum(widths) <= _LEAST_PLOT_PX:
        return 1
    in_a_row = max(int(_LEAST_PLOT_PX / max(widths)), 1)  # plotly sets several rows in columns of one width
    return math.ceil(len(widths) / in_a_row)


def _time_axis(drawing: Drawing, anchor: str) -> Figure:
    label = drawing.panels[0].x.label if drawing.panels else ""
    return {
        **_AXIS,
        "mirror": "all",
        "anchor": anchor,
        "range": list(drawing.span),
        "title": {"text": label, "standoff": 6},
        "hoverformat": ".4f",
        "zeroline": False,
    }


def _zoom_buttons(drawing: Drawing) -> Figure:
    return {
        "type": "buttons",
        "direction": "right",
        "showactive": False,
        "x": 0,
        "xanchor": "left",
        "y": 1,
        "yanchor": "bottom",
        "pad": {"b": 9 + (ROWS + 1) * _ROW_PX, "t": 0, "l": 0, "r": 0},
        "font": {"size": 11},
        "buttons": [
            {"label": zoom.name, "method": "relayout", "args": [{"xaxis.range": [zoom.begin_s, zoom.end_s]}]}
            for zoom in drawing.zooms
        ],
    }


def _value_axis(panel: Panel, at: _Place) -> Figure:
    return {
        **_AXIS,
        "anchor": "x",
        "domain": [at.bottom, at.top],
        "title": {"text": panel.y.label, "standoff": 4},
        "rangemode": "tozero" if panel.y.from_zero else "normal",
        "nticks": 6,
    }


def _traces(panel: Panel, at: _Place) -> Iterator[Figure]:
    axes = {"yaxis": f"y{at.suffix}", "legend": f"legend{at.suffix}"}
    for area in panel.areas:
        yield {**axes, **area_trace(area)}
    for line in panel.lines:
        yield {**axes, **line_trace(line)}


def _shade(shade: Shade) -> Figure:
    return {
        "type": "rect",
        "layer": "below",
        "xref": "x",
        "yref": "paper",
        "x0": shade.begin_s,
        "x1": shade.end_s,
        "y0": 0,
        "y1": 1,
        "line": {"width": 0},
        "fillcolor": translucent(shade.colour, shade.opacity),
    }


def _vertical(mark: Mark) -> Figure:
    return {
        "type": "line",
        "xref": "x",
        "yref": "paper",
        "x0": mark.at_s,
        "x1": mark.at_s,
        "y0": 0,
        "y1": 1,
        "line": {"color": mark.colour, "width": 1, "dash": mark.dash},
    }


def _words(mark: Mark) -> Figure:
    return {
        "text": mark.words,
        "x": mark.at_s,
        "xref": "x",
        "xanchor": mark.anchor,
        "y": 1,
        "yref": "paper",
        "yanchor": "bottom",
        "yshift": 5 + _ROW_PX * mark.row,
        "showarrow": False,
        "font": {"size": 11, "color": mark.words_colour},
    }


def _title(panel: Panel, at: _Place) -> Figure:
    return {
        "text": f"<b>{panel.title}</b>",
        "x": 0,
        "xref": "paper",
        "xanchor": "left",
        "y": at.top,
        "yref": "paper",
        "yanchor": "bottom",
        "yshift": 2,
        "showarrow": False,
        "font": {"size": 12},
    }
