"""Fourier components over one cycle and over whole cycles, where a cycle is no whole number of samples.

The functions of this folder are the definition of what is measured. All windows are causal: a value at a sample is made
from that sample and earlier ones, so a response never appears before its cause.
"""

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.sliding import ROUND_OFF, CycleWindows, Frequency, running_integral, steady_average
from pvlvrt_compliance.waveforms.container import Samples

ComplexSamples = NDArray[np.complex128]

AMPLITUDE_FLOOR = 1.0
"""Amplitude of a phasor (V or A, peak) below which it has no angle to speak of, where no other floor is given."""

# Steps that a row of a table of turns has.
_ROW = 256


class WholeCycles(NamedTuple):
    """The whole cycles at the beginning of a window.

    Attributes
    ----------
    samples : int
        Number of samples in them.
    length : float
        Their length in sampling steps, no whole number in general.
    """

    samples: int
    length: float

    @property
    def weights(self) -> Samples:
        """Quadrature weights of the mean over the cycles, shape (samples,), sum 1.

        Trapezoids between the samples; the last one reaches from the last sample to the end of the cycles, where a
        periodic signal has its first value again. The fraction of a step thus counts as much as it lasts.
        """
        weights = np.full(self.samples, 1 / self.length)
        closing = self.length - (self.samples - 1)
        weights[[0, -1]] = 0.5 * (1 + closing) / self.length
        return weights


def turning(n: int, dt_s: float, frequency_hz: Frequency) -> ComplexSamples:
    """Return exp(-j 2 pi integral of f dt) at n samples, angle 0 at the first one; shape (n,)."""
    if isinstance(frequency_hz, np.ndarray):
        turned: ComplexSamples = np.exp(-2j * np.pi * dt_s * running_integral(frequency_hz))
        return turned
    return _turning_steadily(n, dt_s, float(frequency_hz))


@lru_cache(maxsize=4)
def _turning_steadily(n: int, dt_s: float, frequency_hz: float) -> ComplexSamples:
    # The same for all signals of a record. A turn by k steps is one by whole rows of them and one by the rest.
    step = -2j * np.pi * dt_s * frequency_hz
    rows = np.exp(step * _ROW * np.arange(-(-n // _ROW)))
    turned: ComplexSamples = np.outer(rows, np.exp(step * np.arange(_ROW))).reshape(-1)[:n]
    turned.flags.writeable = False
    return turned


def one_cycle_phasor(x: NDArray[Any], dt_s: float, frequency_hz: Frequency, order: int = 1) -> ComplexSamples:
    """Fourier component of the cycle that ends at each sample.

    X(t) = (2/T) integral of x exp(-j order w tau) over tau = t - T .. t, tau = 0 at sample 0: A cos(w t + phi) gives
    A exp(j phi) at every sample. This is the one-cycle window that IEC 61400-21 practice takes phasors with. With a
    frequency at each sample, w tau is the angle turned since sample 0 and T the cycle by the frequency at t.

    Parameters
    ----------
    x : array, shape (..., n)
        Samples, finite.
    dt_s : float
        Sampling step (s).
    frequency_hz : float or array, shape (n,)
        Frequency of the fundamental (Hz), one for all or one at each sample.
    order : int
        Harmonic order, 1 or more.

    Returns
    -------
    array, shape (..., n)
        Phasors in the unit of x, peak values; nan + j nan during the first cycle and one sample.

    Raises
    ------
    MeasurementError
        When a cycle has fewer than two samples.
    """
    return _one_cycle_average(x * turning(x.shape[-1], dt_s, order * frequency_hz), 1 / (frequency_hz * dt_s), 2.0)


def one_cycle_mean(x: Samples, dt_s: float, frequency_hz: Frequency) -> Samples:
    """Mean of the cycle that ends at each sample, shape (..., n), NaN during the first cycle and one sample.

    Parameters and errors as `one_cycle_phasor`.
    """
    mean: Samples = _one_cycle_average(x, 1 / (frequency_hz * dt_s))
    return mean


def _one_cycle_average(y: NDArray[Any], cycle: Frequency, gain: float = 1.0) -> NDArray[Any]:
    if isinstance(cycle, np.ndarray):
        return CycleWindows(cycle).average(y, gain)
    return steady_average(y, cycle, gain)


def whole_cycles(n: int, dt_s: float, frequency_hz: float) -> WholeCycles:
    """Return the whole cycles that n samples hold, each sample standing for the step that follows it.

    A window cut at whole cycles has one sample more or fewer by where the grid falls; one that is missing counts as
    there, for the cycles close on themselves.

    Raises
    ------
    MeasurementError
        When the samples do not hold one cycle.
    """
    cycle = 1 / (frequency_hz * dt_s)
    cycles = math.floor((n + 1) / cycle + ROUND_OFF)
    if cycles < 1:
        raise MeasurementError(f"a window of {n * dt_s:.4f} s is shorter than one cycle of {frequency_hz:g} Hz")
    length = cycles * cycle
    return WholeCycles(min(n, math.ceil(length - ROUND_OFF)), length)


def components(x: Samples, dt_s: float, frequency_hz: float, order: int = 1, detrend: bool = False) -> ComplexSamples:
    """Fourier components over the whole cycles at the beginning of a window.

    Parameters
    ----------
    x : array, shape (..., n)
        Samples.
    dt_s, frequency_hz : float
        Sampling step (s); frequency that the whole cycles are counted of (Hz).
    order : int
        The component at ``order * frequency_hz``.
    detrend : bool
        Subtract the least-squares straight line of those cycles first.

    Returns
    -------
    array, shape (...)
        Phasors in the unit of x, peak values, angle at the first sample.

    Raises
    ------
    MeasurementError
        When the window does not hold one cycle.
    """
    cycles = whole_cycles(x.shape[-1], dt_s, frequency_hz)
    x = x[..., : cycles.samples]
    kernel = cycles.weights * turning(cycles.samples, dt_s, order * frequency_hz)
    x = _without_line(x) if detrend else x
    found: ComplexSamples = 2 * np.asarray(weighted_sum(x, kernel.real) + 1j * weighted_sum(x, kernel.imag))
    return found


def component(x: Samples, dt_s: float, frequency_hz: float, detrend: bool = False, order: int = 1) -> complex:
    """Fourier component of one signal, shape (n,): see `components`."""
    return complex(components(x, dt_s, frequency_hz, order, detrend))


def mean(x: Samples, dt_s: float, frequency_hz: float) -> float:
    """Mean over the whole cycles at the beginning of a window, in the unit of x, shape (n,).

    Raises
    ------
    MeasurementError
        When the window does not hold one cycle.
    """
    cycles = whole_cycles(len(x), dt_s, frequency_hz)
    return float(weighted_sum(x[: cycles.samples], cycles.weights))


def weighted_sum(x: Samples, weights: Samples) -> Samples:
    """Sum of samples by their weights, shape (...).

    Without the matrix library, which wakes threads of its own for a few ten thousand samples: they cost more than that.
    """
    product: Samples = np.einsum("...n,n->...", x, weights)
    return product


def _without_line(x: Samples) -> Samples:
    t = np.arange(x.shape[-1]) - 0.5 * (x.shape[-1] - 1)
    level = x.mean(axis=-1, keepdims=True)
    slope = (weighted_sum(x - level, t) / weighted_sum(t, t))[..., np.newaxis]
    detrended: Samples = x - level - slope * t
    return detrended
