"""Lines and areas as traces of plotly.js; where their numbers are packed, once `figures.js` has unpacked them."""

import math
import re
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.report.drawing.colours import EDGES_PX
from pvlvrt_compliance.report.drawing.model import Area, Bars, Line, OnGrid, Places, values
from pvlvrt_compliance.report.drawing.packing import short

Trace = dict[str, Any]

_ESCAPED_MARKUP = re.compile("&lt;(/?su[bp])>")
_EDGE_PX = 1.0
_SAME_SAMPLE = 1e-3  # of a step
_MANY = 12  # values of a list that is an array


def line_trace(line: Line, *, packed: bool = True) -> Trace:
    """A line as a trace: one for all of its runs, with gaps between them; ``packed`` as of `area_trace`."""
    told: Trace = {"hovertemplate": "%{y:.4~g}"} if line.told else {"hoverinfo": "skip"}
    opacity = {"opacity": line.opacity} if line.opacity < 1 else {}
    return {
        "name": line.name,
        **_points([(run.x, (run.y,)) for run in line.runs], packed),
        "line": {"color": line.colour, "width": line.width, **({} if line.dash == "solid" else {"dash": line.dash})},
        "legendgroup": line.group or line.name,
        "showlegend": line.in_legend,
        **told,
        **opacity,
        **({"meta": line.swings_s} if line.swings_s else {}),
    }


def area_trace(area: Area, *, packed: bool = True) -> Trace:
    """An area as a trace: one for all of its strips.

    Samples are ``packed`` for `figures.js`, arrays as `packing.packed` takes them, or stand as ``x`` and ``y`` that
    plotly.js needs nothing more for.
    """
    return {
        "name": area.name,
        **_points([(strip.x, (strip.lower, strip.upper)) for strip in area.strips], packed),
        "fill": "toself",
        "fillcolor": translucent(area.colour, area.opacity),
        "line": {"color": area.colour, "width": _EDGE_PX if area.edged else 0, **_edge(area.colour)},
        "legendgroup": area.group or area.name,
        "showlegend": area.in_legend,
        "hoverinfo": "skip",
    }


def bar_trace(bars: Bars) -> Trace:
    """Bars as a trace."""
    return {
        "type": "bar",
        "name": bars.name,
        "x": _listed(bars.at),
        "y": _listed([height if math.isfinite(height) else None for height in bars.heights]),
        "width": short(bars.width),
        "marker": {"color": bars.colour, "opacity": bars.opacity},
        "showlegend": bars.in_legend,
        "hovertemplate": "%{y:.4~g}",
    }


def _edge(colour: str) -> Trace:
    lengths = ",".join(f"{length}px" for length in EDGES_PX.get(colour, ()))
    return {"dash": lengths} if lengths else {}


def literal(text: str) -> str:
    """A text in which plotly reads no markup but that of what is set high or low."""
    return _ESCAPED_MARKUP.sub(r"<\1>", text.replace("&", "&amp;").replace("<", "&lt;"))


def translucent(colour: str, opacity: float) -> str:
    """A colour as CSS has one that shows what lies below."""
    red, green, blue = (int(colour[k : k + 2], 16) for k in (1, 3, 5))
    return f"rgba({red},{green},{blue},{opacity:g})"


def _points(pieces: Sequence[tuple[Places, tuple[Any, ...]]], packed: bool) -> Trace:
    """Coordinates of broken lines, or of areas between two of them each."""
    if packed and pieces and isinstance(pieces[0][0], OnGrid):
        return {"packed": _packed(pieces)}
    x: list[float | None] = []
    y: list[float | None] = []
    for places, edges in pieces:
        there = values(places)
        x += [*([None] if x else []), *there, *(reversed(there) if len(edges) == 2 else [])]
        y += [*([None] if y else []), *edges[0], *(reversed(edges[1]) if len(edges) == 2 else [])]
    y = [None if level is None or not math.isfinite(level) else level for level in y]
    return {"x": _listed(x), "y": _listed(y)} if packed else {"x": x, "y": y}


def _listed(values: Sequence[float | None]) -> list[float | None] | NDArray[np.float64]:
    """A few values as they stand in JSON, many as an array, where None becomes no number."""
    if len(values) >= _MANY:
        return np.array(values, dtype=np.float64)
    return [None if value is None else short(value) for value in values]


def _packed(pieces: Sequence[tuple[Any, tuple[Any, ...]]]) -> Trace:
    """Samples picked from grids, in as few bytes as there can be: a place takes mostly one.

    ``pieces``: first place, step and number of points of each, and 1 where it goes on from the one before; ``skip``:
    how many steps each point is beyond the one before, 0 of the first of a piece; ``y``: values, of areas ``lower`` and
    ``upper``.
    """
    grids = [x for x, _ in pieces]
    ends = [math.nan, *(x.first + x.step * int(x.numbers[-1]) for x in grids)]
    skips = np.diff(np.concatenate([x.numbers for x in grids]), prepend=0)
    skips[np.cumsum([0, *(len(x.numbers) for x in grids[:-1])])] = 0
    names = ("y",) if len(pieces[0][1]) == 1 else ("lower", "upper")
    return {
        "pieces": [_piece(x, end) for x, end in zip(grids, ends, strict=False)],
        "skip": _whole_numbers(skips),
        **{name: single(np.concatenate([edges[k] for _, edges in pieces])) for k, name in enumerate(names)},
    }


def _piece(x: OnGrid, last: float) -> list[float]:
    """One piece of what is packed, after another that ends at a place."""
    first = x.first + x.step * int(x.numbers[0])
    return [short(first), short(x.step), len(x.numbers), int(abs(first - last) < _SAME_SAMPLE * x.step)]


def _whole_numbers(x: NDArray[np.int64]) -> NDArray[Any]:
    """Whole numbers in as few bytes each as the largest needs."""
    largest = x.max(initial=0)
    return x.astype(next(f"<{kind}" for kind in ("u1", "u2", "u4") if largest <= np.iinfo(kind).max))


def single(y: NDArray[np.float64]) -> NDArray[np.float32]:
    """Values as float32; those beyond it become gaps."""
    with np.errstate(over="ignore"):
        found = y.astype("<f4")
    found[~np.isfinite(found)] = np.nan
    return found
