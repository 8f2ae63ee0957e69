"""Spectrum over ten or twelve cycles, its groups (IEC 61000-4-7), and distortion against the rated current.

The window is ten cycles at 50 Hz and twelve at 60 Hz, about 200 ms, of the frequency that is measured, hence lines
about 5 Hz apart. Line k is at k f / N, N the cycles of the window; harmonic h is line N h.
"""

import itertools
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.measure.fourier import components, turning, weighted_sum, whole_cycles
from pvlvrt_compliance.measure.harmonics import harmonic_amplitudes
from pvlvrt_compliance.waveforms.container import Samples

HIGHEST_ORDER = 50
"""Highest order that is grouped."""


class Spectrum(NamedTuple):
    """Lines of one window."""

    lines: Samples  # rms in the unit of the signal by line, line 0 the magnitude of the mean; shape (..., lines)
    cycles: int  # N, cycles of the fundamental in the window, which is the lines from one harmonic to the next


def window_cycles(nominal_hz: float) -> int:
    """Cycles of a window: 10 at 50 Hz, 12 at 60 Hz (IEC 61000-4-7, clause 4.4.1)."""
    return round(0.2 * nominal_hz)


def group_windows(n: int, dt_s: float, frequency_hz: float, nominal_hz: float) -> tuple[slice, ...]:
    """Consecutive windows of ten or twelve cycles that n samples hold, without gaps; slices of the last axis.

    ``frequency_hz`` is the frequency measured (Hz), ``dt_s`` the sampling step (s). What is left over is in none.
    """
    length = window_cycles(nominal_hz) / (frequency_hz * dt_s)
    edges = np.rint(length * np.arange(int((n + 1) / length) + 1)).astype(int).tolist()
    return tuple(slice(start, stop) for start, stop in itertools.pairwise(edges))


def spectrum(x: Samples, dt_s: float, frequency_hz: float, nominal_hz: float, highest: int = HIGHEST_ORDER) -> Spectrum:
    """Lines of the first ten or twelve cycles, to the upper edge of the group of order ``highest``.

    Least squares on all lines at once (`harmonic_amplitudes`), hence synchronous with the measured frequency although
    the window is no whole number of samples. Lines that the sampling cannot carry are 0.

    Parameters
    ----------
    x : array, shape (..., n)
        Samples.
    dt_s, frequency_hz : float
        Sampling step (s); frequency of the fundamental, as measured (Hz).
    nominal_hz : float
        Nominal frequency (Hz), which decides between ten and twelve cycles.
    highest : int
        Highest order that will be grouped.

    Raises
    ------
    MeasurementError
        When the samples do not hold the ten or twelve cycles.
    """
    cycles = window_cycles(nominal_hz)
    first = x[..., : math.ceil(cycles / (frequency_hz * dt_s))]
    amplitudes = harmonic_amplitudes(first, dt_s, frequency_hz / cycles, (highest + 1) * cycles)
    amplitudes[..., 1:] /= np.sqrt(2)
    return Spectrum(amplitudes, cycles)


def harmonic_groups(found: Spectrum) -> Samples:
    """Rms of the harmonic groups by order, shape (..., orders); order 0 is the mean alone.

    Y_g,h^2 = 1/2 Y_(Nh - N/2)^2 + sum of Y_(Nh + k)^2, |k| < N/2, + 1/2 Y_(Nh + N/2)^2 (IEC 61000-4-7, clause 5.6).
    """
    half = found.cycles // 2
    weights = np.ones(2 * half + 1)
    weights[[0, -1]] = 0.5
    return _grouped(found, np.arange(-half, half + 1), weights, around_mean=False)


def harmonic_subgroups(found: Spectrum) -> Samples:
    """Rms of the harmonic subgroups by order, shape (..., orders); order 0 is the mean alone.

    Line Nh and its neighbours: Y_sg,h^2 = Y_(Nh - 1)^2 + Y_Nh^2 + Y_(Nh + 1)^2 (IEC 61000-4-7, clause 5.6).
    """
    return _grouped(found, np.arange(-1, 2), np.ones(3), around_mean=False)


def interharmonic_groups(found: Spectrum) -> Samples:
    """Rms of all lines between harmonic h and the next, by h from 0, shape (..., orders).

    Y_ig,h^2 = sum of Y_(Nh + k)^2, k = 1 .. N - 1 (IEC 61000-4-7, Annex A).
    """
    return _grouped(found, np.arange(1, found.cycles), np.ones(found.cycles - 1))


def interharmonic_subgroups(found: Spectrum) -> Samples:
    """Rms of the centred subgroups between harmonic h and the next, by h from 0, shape (..., orders).

    Y_isg,h^2 = sum of Y_(Nh + k)^2, k = 2 .. N - 2 (IEC 61000-4-7, Annex A): without the harmonics' neighbours.
    """
    return _grouped(found, np.arange(2, found.cycles - 1), np.ones(found.cycles - 3))


def _grouped(found: Spectrum, offsets: NDArray[np.int_], weights: Samples, around_mean: bool = True) -> Samples:
    orders = np.arange((found.lines.shape[-1] - 1) // found.cycles)
    squares = found.lines[..., np.abs(orders[:, np.newaxis] * found.cycles + offsets)] ** 2
    rms: Samples = np.sqrt(squares @ weights)
    if not around_mean:
        rms[..., 0] = found.lines[..., 0]
    return rms


def thd(grouped: Samples, highest: int = 40) -> Samples:
    """Distortion of orders 2 to ``highest`` over order 1, a fraction of one, shape (...).

    Of `harmonic_groups` THDG, of `harmonic_subgroups` THDS, of `harmonic_amplitudes` THD (IEC 61000-4-7, clause 3.3).
    NaN where there is no fundamental; `distortion_percent` has a floor for it.

    Parameters
    ----------
    grouped : array, shape (..., orders)
        Values by order, from order 0.
    highest : int
        Highest order that counts.
    """
    total = np.sqrt(np.sum(grouped[..., 2 : highest + 1] ** 2, axis=-1))
    first = grouped[..., 1]
    fraction: Samples = np.where(first > 0, total / np.where(first > 0, first, 1.0), np.nan)
    return fraction


def trd(x: Samples, dt_s: float, frequency_hz: float, rated_rms: float) -> Samples:
    """Total rated-current distortion: rms of all but the fundamental over the rated current, a fraction of one.

    TRD = sqrt(I_rms^2 - I_1^2) / I_rated (IEEE 1547-2018, clause 7.3), over the whole cycles at the beginning of a
    window, 200 ms of them for 5 Hz lines. Harmonics of every order that the sampling carries, interharmonics and the
    mean all count. Taken as the rms of what is left after the fundamental, which no difference of large squares spoils.

    Parameters
    ----------
    x : array, shape (..., n)
        Samples (A).
    dt_s, frequency_hz : float
        Sampling step (s); frequency of the fundamental, as measured (Hz).
    rated_rms : float
        Rated current (A, rms).

    Returns
    -------
    array, shape (...)

    Raises
    ------
    MeasurementError
        When the window does not hold one cycle.
    """
    window = whole_cycles(x.shape[-1], dt_s, frequency_hz)
    first = components(x, dt_s, frequency_hz)[..., np.newaxis]
    rest = x[..., : window.samples] - (first * turning(window.samples, dt_s, frequency_hz).conj()).real
    fraction: Samples = np.sqrt(weighted_sum(rest * rest, window.weights)) / rated_rms
    return fraction


def dc_component(x: Samples, dt_s: float, frequency_hz: float) -> Samples:
    """Mean over the whole cycles at the beginning of a window, with its sign, in the unit of x, shape (...).

    Of a window of ten or twelve cycles, the DC component that is judged as injection. x has the shape (..., n).

    Raises
    ------
    MeasurementError
        When the window does not hold one cycle.
    """
    window = whole_cycles(x.shape[-1], dt_s, frequency_hz)
    return weighted_sum(x[..., : window.samples], window.weights)
