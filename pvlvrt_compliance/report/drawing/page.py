"""Panels as one HTML page that needs no network and tells values under the pointer, by plotly.js."""

from collections.abc import Sequence
from html import escape
from typing import Any

from pvlvrt_compliance.report.drawing.model import Area, Axis, Line, Panel
from pvlvrt_compliance.report.drawing.plotly_js import as_script, plotly_js
from pvlvrt_compliance.report.drawing.plotly_traces import area_trace, line_trace, literal

SUFFIX = ".html"
_CONFIG = {"displaylogo": False, "responsive": True, "showSendToCloud": False, "plotlyServerURL": ""}
_HEIGHT_PX = 520


def render(name: str, title: str, panels: Sequence[Panel]) -> str:
    """Return the panels as one page, a figure each; parameters as of `svg.render`."""
    heading = escape(f"{name}: {title}")
    places = "".join(f'<div id="figure-{k}"></div>' for k in range(len(panels)))
    calls = "".join(_call(f"figure-{k}", panel) for k, panel in enumerate(panels))
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{heading}</title></head>'
        f'<body style="font-family: sans-serif"><h1>{heading}</h1>{places}'
        f"<script>{plotly_js()}</script><script>{calls}</script></body></html>\n"
    )


def _call(place: str, panel: Panel) -> str:
    arguments = ", ".join(map(as_script, (place, _traces(panel), _layout(panel), _CONFIG)))
    return f"Plotly.newPlot({arguments});\n"


def _traces(panel: Panel) -> list[dict[str, Any]]:
    areas = [_trace(area, area_trace(area, packed=False)) for area in panel.areas]
    return areas + [_trace(line, line_trace(line, packed=False)) for line in panel.lines]


def _trace(of: Line | Area, trace: dict[str, Any]) -> dict[str, Any]:
    told = {"hoverinfo": "x+y+name", "type": "scatter", "mode": "lines"}
    return {**trace, **told, "name": literal(of.name), "legendgroup": of.group or None}


def _layout(panel: Panel) -> dict[str, Any]:
    return {
        "title": {"text": literal(panel.title), "x": 0.05},
        "xaxis": {"title": {"text": literal(panel.x.label)}, "type": panel.x.scale},
        "yaxis": {"title": {"text": literal(panel.y.label)}, **_reach(panel.y)},
        "legend": {"orientation": "h", "y": -0.25},
        "showlegend": True,
        "height": _HEIGHT_PX,
    }


def _reach(axis: Axis) -> dict[str, Any]:
    if axis.span is not None:
        return {"range": list(axis.span)}
    return {"rangemode": "tozero" if axis.from_zero else "normal"}
