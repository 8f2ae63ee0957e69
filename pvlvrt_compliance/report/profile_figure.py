"""Figures of a profile: SVG from a template, PNG by matplotlib (extra ``plot``), HTML by plotly."""

import io
import math
import textwrap
from typing import Any, NamedTuple

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.profile.curves import Point, Points
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.report.profile_curves import Panel, Scale, panels
from pvlvrt_compliance.resources import resource_folder

COLOURS = ("#0a4f8f", "#b3161b", "#0b6b3a", "#7a4b00", "#7b1fa2", "#00707a", "#545c63")
WIDTH, PANEL_HEIGHT, LEFT, RIGHT, TOP, BOTTOM, LEGEND_ROW = 760, 330, 66, 20, 34, 50, 17
_CONFIG = {"displaylogo": False, "responsive": True}
_HEAD, _HEAD_ROW, _LETTERS_A_LINE = 36.0, 18.0, 90


def render_svg(profile: Profile, scale: Scale | None = None) -> str:
    """Return the figure as SVG, drawn without any library.

    Raises
    ------
    UsageError
        When the profile has nothing to draw.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    loader = FileSystemLoader(resource_folder("reports"))
    environment = Environment(loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True)
    heading = textwrap.wrap(profile.title, _LETTERS_A_LINE)
    drawn, top = [], _HEAD + _HEAD_ROW * len(heading)
    for panel in _panels(profile, scale):
        drawn.append(_Drawing(panel, top))
        top = drawn[-1].bottom
    template = environment.get_template("profile.svg.j2")
    return template.render(profile=profile, heading=heading, drawings=drawn, width=WIDTH, height=top, colours=COLOURS)


def render_html(profile: Profile, scale: Scale | None = None) -> str:
    """Return the figure as one HTML file that needs no network and tells values under the pointer.

    Raises
    ------
    UsageError
        When the profile has nothing to draw.
    """
    from html import escape

    from plotly.graph_objects import Figure

    parts = []
    for number, panel in enumerate(_panels(profile, scale)):
        figure = Figure(data=_traces(panel), layout=_layout(panel))
        include = "inline" if number == 0 else False
        parts.append(
            figure.to_html(full_html=False, include_plotlyjs=include, div_id=f"figure-{number}", config=_CONFIG)
        )
    title = escape(f"{profile.id}: {profile.title}")
    head = f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{title}</title></head>'
    return f'{head}<body style="font-family: sans-serif"><h1>{title}</h1>{"".join(parts)}</body></html>\n'


def render_png(profile: Profile, scale: Scale | None = None) -> bytes:
    """Return the figure as PNG.

    Raises
    ------
    UsageError
        When matplotlib is not installed, or the profile has nothing to draw.
    """
    shown = _panels(profile, scale)
    try:
        from matplotlib.figure import Figure
    except ImportError:
        extra = "pip install 'pvlvrt-compliance[plot]'"
        raise UsageError(f"a PNG needs matplotlib: {extra}; .svg and .html need nothing more") from None
    figure = Figure(figsize=(8, 3.8 * len(shown)), layout="constrained")
    figure.suptitle("\n".join([_plain(profile.id), *textwrap.wrap(_plain(profile.title), _LETTERS_A_LINE)]))
    for axes, panel in zip(figure.subplots(len(shown), squeeze=False)[:, 0], shown, strict=True):
        _draw(axes, panel)
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=120, metadata={"Software": None})
    return file.getvalue()


def _panels(profile: Profile, scale: Scale | None) -> tuple[Panel, ...]:
    shown = panels(profile, scale)
    if not shown:
        raise UsageError(f"{profile.id}: the profile has no envelope, regions or curve to draw")
    return shown


def _draw(axes: Any, panel: Panel) -> None:
    for area in panel.areas:
        colour = COLOURS[area.shade]
        axes.fill(*zip(*area.points, strict=True), facecolor=f"{colour}30", edgecolor=colour, label=_plain(area.label))
    for k, line in enumerate(panel.lines):
        axes.plot(*zip(*line.points, strict=True), color=COLOURS[k % len(COLOURS)], label=_plain(line.label))
    axes.set(title=panel.title, xlabel=panel.x_label, ylabel=panel.y_label, xscale=panel.scale)
    axes.set(xlim=panel.x_range, ylim=panel.y_range)
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small")


def _plain(text: str) -> str:
    """A text that matplotlib does not read as a formula."""
    return text.replace("$", r"\$")


def _traces(panel: Panel) -> list[dict[str, Any]]:
    closed = [(area.label, (*area.points, area.points[0]), "toself") for area in panel.areas]
    parts = [*closed, *((line.label, line.points, "none") for line in panel.lines)]
    return [
        {
            "type": "scatter",
            "mode": "lines",
            "x": [x for x, _ in points],
            "y": [y for _, y in points],
            "fill": fill,
            "name": _literal(label),
        }
        for label, points, fill in parts
    ]


def _layout(panel: Panel) -> dict[str, Any]:
    return {
        "title": {"text": panel.title},
        "xaxis": {"title": {"text": panel.x_label}, "type": panel.scale},
        "yaxis": {"title": {"text": panel.y_label}, "range": list(panel.y_range)},
        "legend": {"orientation": "h", "y": -0.25},
        "showlegend": True,
        "colorway": list(COLOURS),
        "height": 520,
    }


def _literal(text: str) -> str:
    """A text that plotly does not read as markup."""
    return text.replace("&", "&amp;").replace("<", "&lt;")


class _Tick(NamedTuple):
    at: float
    label: str


class _Drawing:
    """A panel in the coordinates of the SVG."""

    def __init__(self, panel: Panel, top: float) -> None:
        self.panel = panel
        self.top = top + TOP
        self.floor = self.top + PANEL_HEIGHT
        self.left, self.right = float(LEFT), float(WIDTH - RIGHT)
        self.legend = [
            *((area.shade, area.label, True) for area in panel.areas),
            *((k, line.label, False) for k, line in enumerate(panel.lines)),
        ]
        self.legend_top = self.floor + BOTTOM
        self.bottom = self.legend_top + LEGEND_ROW * len(self.legend) + 12

    @property
    def x_ticks(self) -> list[_Tick]:
        """Places and texts along the horizontal axis."""
        values = _decades(*self.panel.x_range) if self.panel.scale == "log" else _round_steps(*self.panel.x_range)
        return [_Tick(self._x(value), f"{value:g}") for value in values]

    @property
    def y_ticks(self) -> list[_Tick]:
        """Places and texts along the vertical axis."""
        return [_Tick(self._y(value), f"{value:g}") for value in _round_steps(*self.panel.y_range)]

    def path(self, points: Points) -> str:
        """Points as SVG has them."""
        return " ".join(f"{self._x(x):.1f},{self._y(y):.1f}" for x, y in points)

    def _x(self, value: float) -> float:
        return self.left + (self.right - self.left) * _share(value, self.panel.x_range, self.panel.scale)

    def _y(self, value: float) -> float:
        return self.floor - PANEL_HEIGHT * _share(value, self.panel.y_range, "linear")


def _share(value: float, span: Point, scale: Scale) -> float:
    if scale == "log":
        value, span = math.log(value), (math.log(span[0]), math.log(span[1]))
    return (value - span[0]) / (span[1] - span[0])


def _round_steps(low: float, high: float) -> list[float]:
    """Round numbers within a span, about six."""
    size = 10 ** math.floor(math.log10((high - low) / 6))
    step = next(size * factor for factor in (1, 2, 5, 10, 20) if (high - low) / (size * factor) <= 8)
    return [round(k * step, 9) for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]


def _decades(low: float, high: float) -> list[float]:
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    return [value for decade in decades for factor in (1, 2, 5) if low <= (value := factor * 10.0**decade) <= high]
