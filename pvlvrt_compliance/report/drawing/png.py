"""Panels as PNG, by matplotlib (extra ``plot``)."""

import io
import textwrap
import warnings
from collections.abc import Sequence
from typing import Any

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.report.drawing.model import STROKES_PX, Area, Line, Panel, outlines, plain, values
from pvlvrt_compliance.report.drawing.spans import span_of
from pvlvrt_compliance.report.drawing.svg import LETTERS_A_LINE

SUFFIX = ".png"
_POINTS_A_PX = 0.75


def render(name: str, title: str, panels: Sequence[Panel]) -> bytes:
    """Return the panels as one PNG; parameters as of `svg.render`.

    Raises
    ------
    UsageError
        When matplotlib is not installed.
    """
    try:
        from matplotlib.figure import Figure
    except ImportError:
        extra = "pip install 'pvlvrt-compliance[plot]'"
        raise UsageError(f"a PNG needs matplotlib: {extra}; .svg and .html need nothing more") from None
    figure = Figure(figsize=(8, 3.8 * len(panels)), layout="constrained")
    figure.suptitle("\n".join([_literal(name), *textwrap.wrap(_literal(title), LETTERS_A_LINE)]))
    for axes, panel in zip(figure.subplots(len(panels), squeeze=False)[:, 0], panels, strict=True):
        _draw(axes, panel)
    file = io.BytesIO()
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph ")  # a letter that its font lacks is drawn as a box
        figure.savefig(file, format="png", dpi=120, metadata={"Software": None})
    return file.getvalue()


def _draw(axes: Any, panel: Panel) -> None:
    for area in panel.areas:
        _fill(axes, area)
    for line in panel.lines:
        _plot(axes, line)
    x_span, y_span = span_of(panel)
    axes.set(title=panel.title, xlabel=panel.x.label, ylabel=panel.y.label, xscale=panel.x.scale)
    axes.set(xlim=x_span, ylim=y_span)
    axes.grid(alpha=0.3)
    if axes.get_legend_handles_labels()[1]:
        axes.legend(fontsize="small")


def _fill(axes: Any, area: Area) -> None:
    look: dict[str, Any] = {
        "facecolor": (area.colour, area.opacity),
        "edgecolor": area.colour if area.edged else "none",
    }
    corners = [points for strip in area.strips for points in outlines(strip)]
    for k, points in enumerate(corners):
        axes.fill(*zip(*points, strict=True), label=_label(area, k), **look)


def _plot(axes: Any, line: Line) -> None:
    strokes = tuple(length / line.width for length in STROKES_PX[line.dash])  # matplotlib counts in widths
    look: dict[str, Any] = {
        "color": line.colour,
        "alpha": line.opacity,
        "linewidth": _POINTS_A_PX * line.width,
        "linestyle": (0, strokes) if strokes else "-",
    }
    for k, run in enumerate(line.runs):
        axes.plot(values(run.x), run.y, label=_label(line, k), **look)


def _label(of: Line | Area, piece: int) -> str:
    """The name of what stands in the legend, once; of the rest what matplotlib leaves out."""
    return _literal(plain(of.name)) if of.in_legend and piece == 0 else "_nolegend_"


def _literal(text: str) -> str:
    """A text that matplotlib does not read as a formula."""
    return text.replace("$", r"\$")
