"""Figures of plotly in as few characters of a page as there can be, which `figures.js` undoes.

Compressed (zlib) and in base64: the length of the JSON in four bytes, the JSON, then all numbers. An array in the JSON
says its kind (``dtype``), where it begins after the JSON (``at``) and how many it has (``count``). Values of 32 bits
become steps of 16,382ths of their range, finer than a screen has points (``q2``, from ``low`` in ``step``s): each as
what it differs by from the one before, low bytes first, then high bytes, which compresses best; what is no number is
65,535.
"""

import base64
import json
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

_STEPS, _GAP = 16_382, 65_535
_NO_SMALLER = 1.0006  # once it is rounded to four digits
_DIGITS = 9  # of a number in the JSON: a nanosecond of a second


def short(value: float) -> float:
    """A number as it stands in the JSON of figures."""
    return float(f"{value:.{_DIGITS}g}")


def packed(figures: Any) -> str:
    """Return figures as `plotly_json.render` gives them as one text without anything that could end a script."""
    numbers = bytearray()
    described = json.dumps(
        figures, separators=(",", ":"), allow_nan=False, default=lambda array: _placed(array, numbers)
    ).encode()
    return compressed(len(described).to_bytes(4, "little") + described + bytes(numbers))


def compressed(content: bytes) -> str:
    """Content as text that `figures.js` makes the content of again."""
    return base64.b64encode(zlib.compress(content, 9)).decode("ascii")


def _placed(array: NDArray[Any], numbers: bytearray) -> dict[str, Any]:
    """Where an array is placed behind the numbers of those before; what is not of whole numbers in steps of its range.

    Raises
    ------
    TypeError
        When it is no array, and nothing that JSON knows.
    """
    if not isinstance(array, np.ndarray):
        raise TypeError(f"{type(array).__name__} is neither of JSON nor an array")
    placed: dict[str, Any] = {"dtype": f"{array.dtype.kind}{array.itemsize}", "at": len(numbers), "count": len(array)}
    if array.dtype.kind == "u":
        numbers += array.tobytes()
        return placed
    low, step, data = _quantised(array.astype(np.float64))
    numbers += data
    return {**placed, "dtype": "q2", "low": low, "step": step}


def _quantised(values: NDArray[np.float64]) -> tuple[float, float, bytes]:
    """The least value, a step, and all values in steps from it: differences, low bytes, then high bytes."""
    known = np.isfinite(values)
    kept = values if known.all() else values[known]
    low, high = (float(kept.min()), float(kept.max())) if len(kept) else (0.0, 0.0)
    low, step = _short(low, (high - low) / _STEPS or 1.0)
    levels = np.full(len(values), _GAP, dtype=np.int64)
    levels[known] = np.maximum(np.round((kept - low) / step), 0)
    levels[1:] -= levels[:-1].copy()
    return low, step, levels.astype("<u2").view(np.uint8).reshape(-1, 2).T.tobytes()


def _short(low: float, step: float) -> tuple[float, float]:
    """The same with few digits, for those compress worst: a step that is no smaller, a least value where it may be."""
    short_step, short_low = float(f"{_NO_SMALLER * step:.4g}"), short(low)
    return (short_low if abs(short_low - low) < short_step / 4 else low), short_step
