"""Long records as few points, without losing a peak."""

import base64
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Samples = NDArray[np.float64]

BUCKETS = 1500
"""Buckets of a decimated trace; each gives two points, so that it can keep its minimum and its maximum."""

_BUCKETS_OF_A_REPORT = 90_000
_FEWEST_BUCKETS = 300


def buckets_for(figures: int) -> int:
    """Buckets of a trace in a report of so many figures, which a browser must still be able to hold."""
    return max(min(BUCKETS, _BUCKETS_OF_A_REPORT // max(figures, 1)), _FEWEST_BUCKETS)


class Trace(NamedTuple):
    """Points on a uniform grid: point k is at ``x0 + k * dx`` (s)."""

    x0: float
    dx: float
    y: Samples


def decimate(t0_s: float, dt_s: float, samples: Samples, buckets: int = BUCKETS) -> Trace:
    """Thin a uniformly sampled signal to at most two points a bucket.

    A bucket gives the samples at the middle of its halves, so a smooth curve stays smooth when zoomed into; where its
    minimum or maximum is extreme among the neighbouring buckets too, that one takes the place of the point of its half.
    Every peak of the signal therefore keeps its value and is drawn within a bucket of its instant.

    Parameters
    ----------
    t0_s, dt_s : float
        Time of the first sample and step (s).
    samples : array, shape (n,)
        The signal; samples that are not finite become gaps.
    buckets : int
        Largest number of buckets; a signal with at most two samples a bucket is returned whole.
    """
    half = max(math.ceil(len(samples) / (2 * buckets)), 1)
    finite = np.where(np.isfinite(samples), samples, np.nan)
    if half == 1:
        return Trace(t0_s, dt_s, finite)
    rows = np.pad(finite, (0, -len(finite) % (2 * half)), mode="edge").reshape(-1, 2 * half)
    points = rows[:, [half // 2, half + half // 2]]
    _keep_extremes(rows, points)
    return Trace(t0_s + (half // 2) * dt_s, half * dt_s, points.ravel())


def _keep_extremes(rows: Samples, points: Samples) -> None:
    """Put local extremes into ``points``, shape (buckets, 2), in the order in which they occur."""
    each = np.arange(len(rows))
    at_max = np.where(np.isnan(rows), -np.inf, rows).argmax(axis=1)
    at_min = np.where(np.isnan(rows), np.inf, rows).argmin(axis=1)
    highest, lowest = rows[each, at_max], rows[each, at_min]
    is_peak, is_trough = _is_local_peak(highest), _is_local_peak(-lowest)
    half = rows.shape[1] // 2
    both = is_peak & is_trough
    to_max = np.where(both, at_max > at_min, at_max >= half).astype(int)
    to_min = np.where(both, at_max <= at_min, at_min >= half).astype(int)
    points[each[is_peak], to_max[is_peak]] = highest[is_peak]
    points[each[is_trough], to_min[is_trough]] = lowest[is_trough]


def _is_local_peak(x: Samples) -> NDArray[np.bool_]:
    filled = np.pad(np.where(np.isnan(x), -np.inf, x), 1, constant_values=-np.inf)
    peak: NDArray[np.bool_] = (filled[1:-1] >= filled[:-2]) & (filled[1:-1] >= filled[2:])
    return peak


def typed_array(y: Samples) -> dict[str, str]:
    """Encode as the base64 float32 array that plotly.js 3 and later read; values beyond float32 become gaps."""
    with np.errstate(over="ignore"):
        single = y.astype("<f4")
    single[~np.isfinite(single)] = np.nan
    return {"dtype": "f4", "bdata": base64.b64encode(single.tobytes()).decode("ascii")}
