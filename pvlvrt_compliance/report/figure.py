"""The figure of a test, as the plain dictionary that plotly.js draws."""

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from pvlvrt_compliance.report.decimation import BUCKETS, Trace, typed_array
from pvlvrt_compliance.report.instants import ROW_PX, ROWS, Figure, labels, shapes, steps_of
from pvlvrt_compliance.report.panels import BLACK, GREY, Curve, Line, Panel, panels
from pvlvrt_compliance.results import TestResult
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Waveforms

_HEIGHT_PX = 150.0
_GAP_PX = 30.0
_TOP_PX = 55.0 + ROWS * ROW_PX
_BOTTOM_PX = 44.0
_LEGEND_ROW_PX = 17.0
_LEAST_PLOT_PX = 606.0  # between the margins of the narrowest figure: on A4, and on a phone, which scrolls it
_SYMBOL_PX, _CHARACTER_PX = 45.0, 6.0  # of a legend; a title is bold
_BOLD_PX = 7.5
_BEFORE_S, _AFTER_S = 0.02, 0.08  # what the zoom on an instant shows
_TAG = re.compile("<[^>]*>")
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


def test_figure(
    waveforms: Waveforms,
    test: TestResult,
    nominal: Nominal,
    buckets: int = BUCKETS,  # noqa: PT028
) -> Figure:
    """Draw voltages, sequence voltages, currents, powers and DC voltage over one common time axis.

    Parameters
    ----------
    waveforms : Waveforms
        The record; channels that it does not hold leave their panel out.
    test : TestResult
        Gives the steps of the disturbance, the measurement window and the bands of its verdicts.
    nominal : Nominal
        Base of the per-unit values.
    buckets : int
        Of a decimated signal, see `decimate`.

    Returns
    -------
    dict
        ``{"data": [...], "layout": {...}}`` for plotly.js 3 or later, ready for JSON.
    """
    found = panels(waveforms, test, nominal, buckets)
    plot_px = sum(panel.height * _HEIGHT_PX for panel in found) + sum(_gap_px(panel) for panel in found[1:])
    placed = list(zip(found, _places(found, plot_px), strict=True))
    layout = {
        **_COMMON_LAYOUT,
        "height": round(plot_px + _TOP_PX + _BOTTOM_PX),
        "xaxis": _time_axis(waveforms, anchor=f"y{placed[-1][1].suffix}" if placed else "y"),
        "updatemenus": [_zoom_buttons(waveforms, test)],
        "shapes": shapes(waveforms, test),
        "annotations": [*labels(waveforms, test), *(_title(p, at) for p, at in placed)],
    }
    for panel, at in placed:
        layout[f"yaxis{at.suffix}"] = _value_axis(panel, at)
        layout[f"legend{at.suffix}"] = {**_LEGEND, "y": at.legend}
    return {"data": [trace for panel, at in placed for trace in _traces(panel, at)], "layout": layout}


test_figure.__test__ = False  # type: ignore[attr-defined]  # not a test, whatever pytest thinks of the name


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


def _places(found: Sequence[Panel], plot_px: float) -> Iterator[_Place]:
    top_px = plot_px
    for order, panel in enumerate(found, start=1):
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
    names = [curve.name for curve in panel.curves] + [line.name for line in panel.lines if line.in_legend]
    widths = [_SYMBOL_PX + _CHARACTER_PX * len(_TAG.sub("", name)) for name in names]
    if _BOLD_PX * len(panel.title) + sum(widths) <= _LEAST_PLOT_PX:
        return 0
    if sum(widths) <= _LEAST_PLOT_PX:
        return 1
    in_a_row = max(int(_LEAST_PLOT_PX / max(widths)), 1)  # plotly sets several rows in columns of one width
    return math.ceil(len(widths) / in_a_row)


def _time_axis(waveforms: Waveforms, anchor: str) -> Figure:
    return {
        **_AXIS,
        "mirror": "all",
        "anchor": anchor,
        "range": [waveforms.t0_s, waveforms.end_s],
        "title": {"text": "time from the start of the record (s)", "standoff": 6},
        "hoverformat": ".4f",
        "zeroline": False,
    }


def _zoom_buttons(waveforms: Waveforms, test: TestResult) -> Figure:
    """Buttons that show the whole record, the disturbance, or a few cycles around its first or its last step."""
    spans = {"whole record": (waveforms.t0_s, waveforms.end_s)}
    if steps := steps_of(test):
        first_s, last_s = steps[0].at_s, steps[-1].at_s
        if last_s > first_s:
            margin_s = 0.1 * (last_s - first_s)
            spans["disturbance"] = (first_s - margin_s, last_s + margin_s)
        spans["start"] = (first_s - _BEFORE_S, first_s + _AFTER_S)
        if last_s > first_s:
            spans["end"] = (last_s - _BEFORE_S, last_s + _AFTER_S)
    return {
        "type": "buttons",
        "direction": "right",
        "showactive": False,
        "x": 0,
        "xanchor": "left",
        "y": 1,
        "yanchor": "bottom",
        "pad": {"b": 5 + (ROWS + 1) * ROW_PX, "t": 0, "l": 0, "r": 0},
        "font": {"size": 11},
        "buttons": [
            {"label": name, "method": "relayout", "args": [{"xaxis.range": list(span)}]} for name, span in spans.items()
        ],
    }


def _value_axis(panel: Panel, at: _Place) -> Figure:
    return {
        **_AXIS,
        "anchor": "x",
        "domain": [at.bottom, at.top],
        "title": {"text": panel.unit, "standoff": 4},
        "rangemode": "tozero" if panel.from_zero else "normal",
        "nticks": 6,
    }


def _traces(panel: Panel, at: _Place) -> Iterator[Figure]:
    axes = {"type": "scatter", "mode": "lines", "xaxis": "x", "yaxis": f"y{at.suffix}", "legend": f"legend{at.suffix}"}
    for curve in panel.curves:
        for number, trace in enumerate(curve.traces):
            yield {**axes, **_signal_trace(curve, trace, number == 0)}
    for line in panel.lines:
        yield {**axes, **_limit_trace(line)}


def _signal_trace(curve: Curve, trace: Trace, first: bool) -> Figure:
    return {
        "name": curve.name,
        "x0": trace.x0,
        "dx": trace.dx,
        "y": typed_array(trace.y),
        "line": {"color": curve.colour, "width": 1.3},
        "legendgroup": curve.name,
        "showlegend": first,
        "hovertemplate": "%{y:.4~g}",
    }


def _limit_trace(line: Line) -> Figure:
    area = {"fill": "tozeroy", "fillcolor": "rgba(213,94,0,0.10)"} if line.area else {}
    return {
        "name": line.name,
        "x": list(line.x),
        "y": [None if math.isnan(y) else y for y in line.y],
        "line": {"color": line.colour, "width": 1.8, "dash": line.dash},
        "legendgroup": line.group or line.name,
        "showlegend": line.in_legend,
        "hoverinfo": "skip",
        **area,
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
