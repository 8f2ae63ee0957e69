"""Root mean square over one cycle: at each sample, and refreshed each half cycle."""

import numpy as np

from pvlvrt_compliance.measure.fourier import one_cycle_mean
from pvlvrt_compliance.measure.sliding import Frequency, running_integral
from pvlvrt_compliance.waveforms.container import Samples

# Of a half cycle: a refresh that misses its sample by less falls on it.
_ROUND_OFF = 1e-9


def sliding_rms(x: Samples, dt_s: float, frequency_hz: Frequency) -> Samples:
    """Rms of the cycle that ends at each sample, U(t) = sqrt((1/T) integral of x^2 over t - T .. t).

    Exact for periodic signals though T is no whole number of samples. Half a cycle late.

    Parameters
    ----------
    x : array, shape (..., n)
        Samples.
    dt_s : float
        Sampling step (s).
    frequency_hz : float or array, shape (n,)
        Frequency that the cycle is counted of (Hz), one for all or one at each sample (`steering_frequency`).

    Returns
    -------
    array, shape (..., n)
        Rms in the unit of x; NaN during the first cycle and one sample.

    Raises
    ------
    MeasurementError
        When a cycle has fewer than two samples.
    """
    # Interpolation between samples may leave a mean square a hair below zero where a signal has gone.
    rms: Samples = np.sqrt(np.maximum(one_cycle_mean(x * x, dt_s, frequency_hz), 0.0))
    return rms


def half_cycle_rms(x: Samples, dt_s: float, frequency_hz: Frequency) -> Samples:
    """Rms over one cycle, refreshed each half cycle and held in between: U_rms(1/2) of IEC 61000-4-30, clause 3.

    The half cycles are counted from the first sample, not from a zero crossing of each channel; a refresh takes the
    cycle that ends at the first sample at or after it. Hence up to one cycle late, and half a cycle on average for
    what lasts.

    Parameters, returns and errors as `sliding_rms`.
    """
    rms = sliding_rms(x, dt_s, frequency_hz)
    n = x.shape[-1]
    cycles = running_integral(np.broadcast_to(frequency_hz, (n,)).astype(np.float64)) * dt_s
    halves = np.floor(2 * cycles + _ROUND_OFF)
    # The first cycle's own refresh comes a sample late, where the sliding value begins.
    refreshed = np.diff(halves, prepend=0.0) > 0
    refreshed[np.isfinite(rms).reshape(-1, n).any(axis=0).argmax()] = True
    last = np.maximum.accumulate(np.where(refreshed, np.arange(n), 0))
    held: Samples = rms[..., last]
    return held
