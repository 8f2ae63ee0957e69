"""Averages over the cycle that ends at each sample, where a cycle is no whole number of samples.

By trapezoids the integral of a sinusoid is exact but for one factor, the same at all samples, so its difference over a
cycle vanishes where it should. What the integral was a cycle ago, between two samples, is interpolated by a cubic.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.waveforms.container import Samples

Frequency = float | Samples
"""A frequency (Hz): one for all samples, or one at each sample, shape (n,), finite."""

# A cycle that misses a whole number of samples by less than this, in samples, is taken to be whole.
ROUND_OFF = 1e-9

_TOO_FEW = "fewer than two samples a cycle"


def running_integral(y: NDArray[Any]) -> NDArray[Any]:
    """Integral over the samples so far, by trapezoids, 0 at the first one; in sampling steps, shape (..., n)."""
    half = y + y[..., :1]
    half *= 0.5
    integral: NDArray[Any] = np.cumsum(y, axis=-1)
    integral -= half
    return integral


def steady_average(y: NDArray[Any], cycle: float, gain: float = 1.0) -> NDArray[Any]:
    """Mean of the cycle that ends at each sample, times a gain.

    Parameters
    ----------
    y : array of float64 or complex128, shape (..., n)
    cycle : float
        Length of a cycle in sampling steps.
    gain : float

    Returns
    -------
    array, shape (..., n)
        NaN (nan + j nan) during the first cycle and one sample.

    Raises
    ------
    MeasurementError
        When a cycle has fewer than two samples.
    """
    back = math.ceil(cycle - ROUND_OFF)
    average = _unknown_until_a_cycle(y, back)
    if y.shape[-1] > back + 1:
        # The integral up to a sample is the mean of the sums with and without it, less what is the same at all samples.
        sums = np.zeros((*y.shape[:-1], y.shape[-1] + 1), dtype=average.dtype)
        np.cumsum(y, axis=-1, out=sums[..., 1:])
        known = average[..., back + 1 :]
        np.add(sums[..., back + 2 :], sums[..., back + 1 : -1], out=known)
        known *= 0.5 * gain / cycle
        trapezoid = np.full(2, 0.5 * gain / cycle)
        _subtract_filtered(known, sums, np.convolve(cubic_weights(max(back - cycle, 0.0)), trapezoid))
    return average


def steady_average_at(y: NDArray[Any], cycle: float, at: NDArray[np.intp], gain: float = 1.0) -> NDArray[Any]:
    """As `steady_average`, at some samples alone, each of which has a cycle and a sample behind it; shape (..., m)."""
    back = math.ceil(cycle - ROUND_OFF)
    if back < 2:
        raise MeasurementError(_TOO_FEW)
    integral = running_integral(y)
    first = at - back - 1
    past = sum(weight * integral[..., first + k] for k, weight in enumerate(cubic_weights(max(back - cycle, 0.0))))
    average: NDArray[Any] = (integral[..., at] - past) * (gain / cycle)
    return average


def _subtract_filtered(known: NDArray[Any], sums: NDArray[Any], taps: Samples) -> None:
    """Subtract from each sample so many sums, from the place in their row on that it has in its own."""
    reach = known.shape[-1] + len(taps) - 1
    if np.iscomplexobj(sums):  # real and imaginary parts take turns
        taps = np.insert(taps, range(1, len(taps)), 0.0)
    for row in np.ndindex(sums.shape[:-1]):
        parts = known[row].view(np.float64)
        parts -= np.correlate(sums[row][:reach].view(np.float64), taps, "valid")


class CycleWindows:
    """Windows of one cycle that end at each sample, where each sample has a cycle of its own.

    Parameters
    ----------
    cycle : array, shape (n,)
        Length of the cycle that ends at each sample, in sampling steps; finite.
    """

    def __init__(self, cycle: Samples) -> None:
        back = np.ceil(cycle - ROUND_OFF).astype(np.intp)
        self._shortest = int(back.min(initial=2))
        now = np.flatnonzero(np.arange(len(cycle)) > back)
        self._first = now - back[now] - 1
        # As a rule these are all samples from one on, and a slice is no copy.
        self._now: Any = slice(int(now[0]), len(cycle)) if len(now) and now[0] + len(now) == len(cycle) else now
        self._cycle = cycle[self._now]
        self._weights = cubic_weights(np.maximum(back[self._now] - self._cycle, 0.0))

    def average(self, y: NDArray[Any], gain: float = 1.0) -> NDArray[Any]:
        """Mean of the cycle that ends at each sample; parameters, shapes and errors as `steady_average`."""
        average = _unknown_until_a_cycle(y, self._shortest)
        integral = running_integral(y)
        known = integral[..., self._now].copy()
        for node, weight in enumerate(self._weights):
            known -= weight * np.take(integral, self._first + node, axis=-1)
        known *= gain / self._cycle
        average[..., self._now] = known
        return average


def _unknown_until_a_cycle(y: NDArray[Any], back: int) -> NDArray[Any]:
    if back < 2:
        raise MeasurementError(_TOO_FEW)
    return np.full(y.shape, np.nan * (1 + 1j) if np.iscomplexobj(y) else np.nan)


def cubic_weights(f: Any) -> tuple[Any, Any, Any, Any]:
    """Lagrange weights of the nodes -1, 0, 1, 2 for a point between 0 and 1: the value one cycle ago."""
    a, b = f * (f - 1), (f + 1) * (f - 2)
    return -a * (f - 2) / 6, (f - 1) * b / 2, -f * b / 2, (f + 1) * a / 6
