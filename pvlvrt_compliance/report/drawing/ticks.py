"""Round numbers along an axis."""

import math

from pvlvrt_compliance.report.drawing.model import Point, Scale


def share(value: float, span: Point, scale: Scale) -> float:
    """How far along an axis a value lies: 0 at its begin, 1 at its end."""
    if scale == "log":
        value, span = math.log(value), (math.log(span[0]), math.log(span[1]))
    return (value - span[0]) / (span[1] - span[0])


def ticks(span: Point, scale: Scale = "linear") -> list[float]:
    """Numbers to write along an axis: round ones, about six, or 1, 2 and 5 of each decade of a logarithmic one."""
    return _decades(*span) if scale == "log" else _round_steps(*span)


def _round_steps(low: float, high: float) -> list[float]:
    """Round numbers within a span, about six."""
    size = 10 ** math.floor(math.log10((high - low) / 6))
    step = next(size * factor for factor in (1, 2, 5, 10, 20) if (high - low) / (size * factor) <= 8)
    return [round(k * step, 9) for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]


def _decades(low: float, high: float) -> list[float]:
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    return [value for decade in decades for factor in (1, 2, 5) if low <= (value := factor * 10.0**decade) <= high]
