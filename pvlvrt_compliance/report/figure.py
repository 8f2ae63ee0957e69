"""The figure of a test, as the plain dictionary that plotly.js draws."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from pvlvrt_compliance.checks.results import TestResult
from pvlvrt_compliance.report.decimation import BUCKETS, Trace, typed_array
from pvlvrt_compliance.report.panels import BLACK, BLUE, GREY, VERMILION, Curve, Line, Panel, opening_s, panels
from pvlvrt_compliance.report.scenario_words import sag_interval
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Waveforms

Figure = dict[str, Any]

_HEIGHT_PX = 150.0
_GAP_PX = 30.0
_TOP_PX = 100.0
_BOTTOM_PX = 44.0
_ROW_PX = 15
_BEFORE_S, _AFTER_S = 0.02, 0.08  # what the zoom on an instant shows
_FONT = "system-ui, -apple-system, 'Segoe UI', 'Liberation Sans', Arial, sans-serif"


class _Place(NamedTuple):
    """Where a panel stands: order from the top and its share of the height, from the bottom up."""

    order: int
    bottom: float
    top: float

    @property
    def suffix(self) -> str:
        return "" if self.order == 1 else str(self.order)


def test_figure(
    waveforms: Waveforms,
    test: TestResult,
    nominal: Nominal,
    envelope: Sequence[tuple[float, float]] | None = None,  # noqa: PT028
    limits: Mapping[str, float] | None = None,  # noqa: PT028
    buckets: int = BUCKETS,  # noqa: PT028
) -> Figure:
    """Draw voltages, sequence voltages, currents, powers and DC voltage over one common time axis.

    Parameters
    ----------
    waveforms : Waveforms
        The record; channels that it does not hold leave their panel out.
    test : TestResult
        Gives the instants of the sag, the measurement window and the verdicts' limits.
    nominal : Nominal
        Base of the per-unit values.
    envelope : sequence of (s, pu), optional
        Ride-through envelope, time from the start of the sag; the points are joined by straight lines.
    limits : mapping, optional
        ``current_fundamental_pu``, ``current_peak_pu`` and ``reactive_power_kvar``; the last is by default the limit of
        the verdict on `reactive_support`.
    buckets : int
        Of a decimated signal, see `decimate`.

    Returns
    -------
    dict
        ``{"data": [...], "layout": {...}}`` for plotly.js 3 or later, ready for JSON.
    """
    found = panels(waveforms, test, nominal, envelope, {**_limits_of(test), **(limits or {})}, buckets)
    plot_px = sum(panel.height for panel in found) * _HEIGHT_PX + max(len(found) - 1, 0) * _GAP_PX
    placed = list(zip(found, _places(found, plot_px), strict=True))
    layout = {
        **_COMMON_LAYOUT,
        "height": round(plot_px + _TOP_PX + _BOTTOM_PX),
        "xaxis": _time_axis(waveforms, anchor=f"y{placed[-1][1].suffix}" if placed else "y"),
        "updatemenus": [_zoom_buttons(waveforms, test)],
        "shapes": [*_bands(test), *_opening_line(waveforms)],
        "annotations": [*_instants(test), *_opening_label(waveforms), *(_title(p, at) for p, at in placed)],
    }
    for panel, at in placed:
        layout[f"yaxis{at.suffix}"] = _value_axis(panel, at)
        layout[f"legend{at.suffix}"] = {**_LEGEND, "y": at.top}
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


def _limits_of(test: TestResult) -> dict[str, float]:
    for check in test.checks:
        if check.check == "reactive_support" and check.unit == "kvar" and check.limit is not None:
            return {"reactive_power_kvar": check.limit}
    return {}


def _places(found: Sequence[Panel], plot_px: float) -> Iterator[_Place]:
    top_px = plot_px
    for order, panel in enumerate(found, start=1):
        bottom_px = top_px - panel.height * _HEIGHT_PX
        yield _Place(order, max(bottom_px / plot_px, 0.0), top_px / plot_px)
        top_px = bottom_px - _GAP_PX


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
    """Buttons that show the whole record, the sag, or a few cycles around one of its instants."""
    spans = {"whole record": (waveforms.t0_s, waveforms.end_s)}
    if sag := sag_interval(test.scenario):
        margin_s = 0.1 * (sag.clear_s - sag.start_s)
        spans["sag"] = (sag.start_s - margin_s, sag.clear_s + margin_s)
        spans["start"] = (sag.start_s - _BEFORE_S, sag.start_s + _AFTER_S)
        spans["clearing"] = (sag.clear_s - _BEFORE_S, sag.clear_s + _AFTER_S)
    return {
        "type": "buttons",
        "direction": "right",
        "showactive": False,
        "x": 0,
        "xanchor": "left",
        "y": 1,
        "yanchor": "bottom",
        "pad": {"b": 5 + 4 * _ROW_PX, "t": 0, "l": 0, "r": 0},
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
        "hoverinfo": "skip",
        **area,
    }


def _band(start_s: float, end_s: float, colour: str) -> Figure:
    return {
        "type": "rect",
        "layer": "below",
        "xref": "x",
        "yref": "paper",
        "x0": start_s,
        "x1": end_s,
        "y0": 0,
        "y1": 1,
        "line": {"width": 0},
        "fillcolor": colour,
    }


def _vertical(at_s: float, colour: str, dash: str) -> Figure:
    return {
        "type": "line",
        "xref": "x",
        "yref": "paper",
        "x0": at_s,
        "x1": at_s,
        "y0": 0,
        "y1": 1,
        "line": {"color": colour, "width": 1, "dash": dash},
    }


def _bands(test: TestResult) -> Iterator[Figure]:
    sag, during = sag_interval(test.scenario), test.measurements.during
    if sag:
        yield _band(*sag, "rgba(0,0,0,0.045)")
    if during:
        yield _band(during.start_s, during.end_s, "rgba(0,114,178,0.10)")
    if sag:
        yield from (_vertical(at_s, GREY, "dash") for at_s in sag)


def _opening_line(waveforms: Waveforms) -> Iterator[Figure]:
    at_s = opening_s(waveforms)
    if at_s is not None:
        yield _vertical(at_s, VERMILION, "solid")


def _instants(test: TestResult) -> Iterator[Figure]:
    sag, during = sag_interval(test.scenario), test.measurements.during
    if sag:
        yield _label(sag.start_s, f"sag starts {sag.start_s:.3f} s", "right", row=1)
        yield _label(sag.clear_s, f"cleared {sag.clear_s:.3f} s", "left", row=1)
    if during:
        yield _label((during.start_s + during.end_s) / 2, "window “during”", "center", row=2, colour=BLUE)


def _opening_label(waveforms: Waveforms) -> Iterator[Figure]:
    at_s = opening_s(waveforms)
    if at_s is not None:
        yield _label(at_s, f"breaker opens {at_s:.3f} s", "left", row=3, colour=VERMILION)


def _label(at_s: float, text: str, anchor: str, row: int, colour: str = BLACK) -> Figure:
    return {
        "text": text,
        "x": at_s,
        "xref": "x",
        "xanchor": anchor,
        "y": 1,
        "yref": "paper",
        "yanchor": "bottom",
        "yshift": 5 + _ROW_PX * row,
        "showarrow": False,
        "font": {"size": 11, "color": colour},
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
