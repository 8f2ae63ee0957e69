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
_MANY = 12  # values of a list that is placed among the numbers
_NO_SMALLER = 1.0006  # once it is rounded to four digits
_DIGITS = 9  # of a number in the JSON: a nanosecond of a second


def packed(figures: Any) -> str:
    """Return figures as `plotly_json.render` gives them as one text without anything that could end a script."""
    numbers = bytearray()
    shrunk = json.dumps(_shrunk(figures, numbers), separators=(",", ":"), allow_nan=False).encode()
    return compressed(len(shrunk).to_bytes(4, "little") + shrunk + bytes(numbers))


def compressed(content: bytes) -> str:
    """Content as text that `figures.js` makes the content of again."""
    return base64.b64encode(zlib.compress(content, 9)).decode("ascii")


def _shrunk(part: Any, numbers: bytearray) -> Any:
    """The same without the numbers of arrays, which are added to the others."""
    if isinstance(part, list):
        return _shrunk_list(part, numbers)
    if isinstance(part, dict):
        if "bdata" in part:
            return _placed_array(part, numbers)
        return {name: _shrunk(item, numbers) for name, item in part.items()}
    return float(f"{part:.{_DIGITS}g}") if isinstance(part, float) else part


def _shrunk_list(part: list[Any], numbers: bytearray) -> Any:
    if len(part) >= _MANY and all(item is None or isinstance(item, float) for item in part):
        return _placed(np.array(part, dtype=np.float64), numbers)  # None becomes no number
    return [_shrunk(item, numbers) for item in part]


def _placed_array(part: dict[str, str], numbers: bytearray) -> dict[str, Any]:
    array = np.frombuffer(base64.b64decode(part["bdata"]), dtype=f"<{part['dtype']}")
    if part["dtype"] == "f4":
        return _placed(array.astype(np.float64), numbers)
    placed: dict[str, Any] = {"dtype": part["dtype"], "at": len(numbers), "count": len(array)}
    numbers += array.tobytes()
    return placed


def _placed(values: NDArray[np.float64], numbers: bytearray) -> dict[str, Any]:
    """Where values are placed among the numbers, in steps of their range."""
    low, step, data = _quantised(values)
    placed = {"dtype": "q2", "at": len(numbers), "count": len(values), "low": low, "step": step}
    numbers += data
    return placed


def _quantised(values: NDArray[np.float64]) -> tuple[float, float, bytes]:
    """The least value, a step, and all values in steps from it: differences, low bytes, then high bytes."""
    known = np.isfinite(values)
    low, high = (float(values[known].min()), float(values[known].max())) if known.any() else (0.0, 0.0)
    low, step = _short(low, (high - low) / _STEPS or 1.0)
    levels = np.full(len(values), _GAP, dtype=np.int64)
    levels[known] = np.maximum(np.round((values[known] - low) / step), 0)
    rest = (np.diff(levels, prepend=0) % 65_536).astype("<u2")
    planes = rest.view(np.uint8).reshape(-1, 2).T
    return low, step, planes.tobytes()


def _short(low: float, step: float) -> tuple[float, float]:
    """The same with few digits, for those compress worst: a step that is no smaller, a least value where it may be."""
    short_step, short_low = float(f"{_NO_SMALLER * step:.4g}"), float(f"{low:.{_DIGITS}g}")
    return (short_low if abs(short_low - low) < short_step / 4 else low), short_step
