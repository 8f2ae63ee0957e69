"""Small figures as SVG, without a library: a few kilobytes each, whose numbers can be compared with a file's."""

import math
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

WIDTH, HEIGHT = 720, 270
_LEFT, _RIGHT, _TOP, _BOTTOM, _ROW = 62.0, 14.0, 14.0, 42.0, 15.0
_COLOURS = ("#004488", "#bb5566", "#997700", "#228833", "#555555")
_LETTER = 5.9  # width of a letter of the legend (px)


class Curve(NamedTuple):
    """Points in the units of the axes; drawn as a line, or as dots."""

    name: str  # empty: not in the legend
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    dots: bool = False
    dashed: bool = False
    like: int | None = None  # colour of this curve; none: one of its own


class Axes(NamedTuple):
    """One panel."""

    x: str  # what is along the axis, with its unit
    y: str
    curves: tuple[Curve, ...]
    log: bool = False  # horizontally
    equal: bool = False  # one scale on both axes
    share: float = 1.0  # of the width, by that of the others


class Figure(NamedTuple):
    """A file below `docs/`: panels beside each other."""

    file: str
    title: str  # what is to be seen, for those who do not see it
    panels: tuple[Axes, ...]


class _Span(NamedTuple):
    low: float
    high: float


def curve(name: str, x: Any, y: Any, **style: Any) -> Curve:
    """Curve of anything that numpy takes for numbers."""
    return Curve(name, np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64), **style)


def render(figure: Figure) -> str:
    """Text of the file."""
    width = WIDTH / sum(axes.share for axes in figure.panels)
    parts: list[str] = []
    left = 0.0
    for axes in figure.panels:
        parts += _Panel(axes, left, axes.share * width).lines()
        left += axes.share * width
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" role="img"'
    return "\n".join(
        (
            f'{head} font-family="sans-serif" font-size="11" fill="#222">',
            f"<title>{escape(figure.title)}</title>",
            f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>',
            *parts,
            "</svg>\n",
        )
    )


class _Panel:
    """A panel in the coordinates of the file."""

    def __init__(self, axes: Axes, left: float, width: float) -> None:
        self.axes = axes
        self.legend = _rows_of_legend(axes, width - _LEFT - _RIGHT)
        self.left, self.right = left + _LEFT, left + width - _RIGHT
        self.top, self.floor = _TOP + _ROW * len(self.legend), HEIGHT - _BOTTOM
        self.x_span, self.y_span = _span((c.x for c in axes.curves), axes.log), _span((c.y for c in axes.curves), False)
        if axes.equal:
            self._make_equal()

    def lines(self) -> Iterator[str]:
        """Frame, grid, curves and legend."""
        yield from self._grid()
        colours = _colours(self.axes.curves)
        for c, colour in zip(self.axes.curves, colours, strict=True):
            yield self._drawn(c, colour)
        entries = dict(
            zip((c.name for c in self.axes.curves), zip(self.axes.curves, colours, strict=True), strict=True)
        )
        for k, row in enumerate(self.legend):
            yield from self._legend_row(k, row, entries)

    def _make_equal(self) -> None:
        x, y = self.x_span, self.y_span
        scale = max((x.high - x.low) / (self.right - self.left), (y.high - y.low) / (self.floor - self.top))
        half = 0.5 * scale * (self.right - self.left)
        self.x_span = _Span(0.5 * (x.low + x.high) - half, 0.5 * (x.low + x.high) + half)
        half = 0.5 * scale * (self.floor - self.top)
        self.y_span = _Span(0.5 * (y.low + y.high) - half, 0.5 * (y.low + y.high) + half)

    def _x(self, value: float) -> float:
        low, high = self.x_span
        if self.axes.log:
            value, low, high = math.log(value), math.log(low), math.log(high)
        return self.left + (self.right - self.left) * (value - low) / (high - low)

    def _y(self, value: float) -> float:
        return self.floor - (self.floor - self.top) * (value - self.y_span.low) / (self.y_span.high - self.y_span.low)

    def _grid(self) -> Iterator[str]:
        x_ticks = _decades(self.x_span) if self.axes.log else _steps(self.x_span)
        columns = "".join(f"M{self._x(v):.1f} {self.top:.1f}V{self.floor:.1f}" for v in x_ticks)
        rows = "".join(f"M{self.left:.1f} {self._y(v):.1f}H{self.right:.1f}" for v in _steps(self.y_span))
        yield f'<path d="{columns}{rows}" stroke="#ddd" fill="none"/>'
        for v in x_ticks:
            yield f'<text x="{self._x(v):.1f}" y="{self.floor + 14:.1f}" text-anchor="middle">{_said(v)}</text>'
        for v in _steps(self.y_span):
            yield f'<text x="{self.left - 5:.1f}" y="{self._y(v) + 4:.1f}" text-anchor="end">{_said(v)}</text>'
        middle, height = 0.5 * (self.left + self.right), 0.5 * (self.top + self.floor)
        yield f'<text x="{middle:.1f}" y="{self.floor + 31:.1f}" text-anchor="middle">{escape(self.axes.x)}</text>'
        x = self.left - _LEFT + 12
        turned = f'transform="rotate(-90 {x:.1f} {height:.1f})"'
        yield f'<text x="{x:.1f}" y="{height:.1f}" text-anchor="middle" {turned}>{escape(self.axes.y)}</text>'

    def _drawn(self, c: Curve, colour: str) -> str:
        points = [(self._x(float(x)), self._y(float(y))) for x, y in zip(c.x, c.y, strict=True)]
        if c.dots:  # a stroke of no length with a round cap
            path = "".join(f"M{x:.1f} {y:.1f}h0" for x, y in points)
            return f'<path d="{path}" stroke="{colour}" stroke-width="4.5" stroke-linecap="round" fill="none"/>'
        path = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points)
        dash = ' stroke-dasharray="5 3"' if c.dashed else ""
        return f'<path d="{path}" stroke="{colour}" stroke-width="1.4"{dash} fill="none"/>'

    def _legend_row(self, k: int, names: tuple[str, ...], entries: dict[str, tuple[Curve, str]]) -> Iterator[str]:
        x, y = self.left, _TOP + _ROW * k
        for name in names:
            c, colour = entries[name]
            sample = f"M{x + 8:.1f} {y - 4:.1f}h0" if c.dots else f"M{x:.1f} {y - 4:.1f}h16"
            style = 'stroke-width="4.5" stroke-linecap="round"' if c.dots else 'stroke-width="1.4"'
            dash = ' stroke-dasharray="5 3"' if c.dashed else ""
            yield f'<path d="{sample}" stroke="{colour}" {style}{dash} fill="none"/>'
            yield f'<text x="{x + 21:.1f}" y="{y:.1f}">{escape(name)}</text>'
            x += _width(name)


def _colours(curves: tuple[Curve, ...]) -> list[str]:
    found: list[str] = []
    own = 0
    for c in curves:
        if c.like is None:
            found.append(_COLOURS[own % len(_COLOURS)])
            own += 1
        else:
            found.append(found[c.like])
    return found


def _width(name: str) -> float:
    return 21 + _LETTER * len(name) + 14


def _rows_of_legend(axes: Axes, room: float) -> list[tuple[str, ...]]:
    rows: list[tuple[str, ...]] = []
    left = 0.0
    for name in dict.fromkeys(c.name for c in axes.curves if c.name):
        if rows and left + _width(name) - 14 <= room:
            rows[-1] += (name,)
        else:
            rows.append((name,))
            left = 0.0
        left += _width(name)
    return rows


def _span(values: Iterable[NDArray[np.float64]], log: bool) -> _Span:
    together = np.concatenate(list(values))
    low, high = float(together.min()), float(together.max())
    if log:
        return _Span(low, high)
    room = 0.04 * (high - low) or 1.0
    return _Span(low - room, high + room)


def _steps(span: _Span) -> list[float]:
    size = 10.0 ** math.floor(math.log10((span.high - span.low) / 6))
    step = next(size * k for k in (1, 2, 5, 10, 20) if (span.high - span.low) / (size * k) <= 7)
    return [k * step for k in range(math.ceil(span.low / step), math.floor(span.high / step) + 1)]


def _decades(span: _Span) -> list[float]:
    decades = range(math.floor(math.log10(span.low)), math.ceil(math.log10(span.high)) + 1)
    within = (1, 2, 5) if span.high < 1e3 * span.low else (1,)
    return [v for d in decades for k in within if 0.999 * span.low <= (v := k * 10.0**d) <= 1.001 * span.high]


def _said(value: float) -> str:
    return f"{round(value, 9):g}".replace("-", "−")
