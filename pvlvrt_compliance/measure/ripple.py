"""Ripple at twice the fundamental, as unbalance leaves it in active power and DC voltage."""

from pvlvrt_compliance.measure.fourier import component, mean
from pvlvrt_compliance.waveforms.container import Samples


def ripple_amplitude(x: Samples, dt_s: float, frequency_hz: float, detrend: bool = False, order: int = 2) -> float:
    """Amplitude (half peak-to-peak) of a multiple of the fundamental, over the whole cycles at a window's beginning.

    Parameters
    ----------
    x : array, shape (n,)
        Samples.
    dt_s, frequency_hz : float
        Sampling step (s); frequency of the fundamental (Hz).
    detrend : bool
        Subtract the least-squares straight line first, for what drifts: it takes 6/(pi h)^2 of a ripple of h periods.
    order : int
        Multiple of the fundamental.

    Raises
    ------
    MeasurementError
        When the window does not hold one cycle.
    """
    return abs(component(x, dt_s, frequency_hz, detrend=detrend, order=order))


def ripple_percent(x: Samples, dt_s: float, frequency_hz: float) -> float | None:
    """Detrended ripple at twice the fundamental, in percent of the mean; None where the mean is not above zero.

    Parameters and errors as `ripple_amplitude`.
    """
    level = mean(x, dt_s, frequency_hz)
    return 100 * ripple_amplitude(x, dt_s, frequency_hz, detrend=True) / level if level > 0 else None
