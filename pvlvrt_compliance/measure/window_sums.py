"""What a window is measured by: sums over its whole cycles, and who takes them in place of numpy."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.measure.fourier import ComplexSamples, components, mean, whole_cycles
from pvlvrt_compliance.measure.power import instantaneous_power
from pvlvrt_compliance.measure.ripple import ripple_amplitude
from pvlvrt_compliance.waveforms.container import Samples, Segment, phase_channels


class PowerSums(NamedTuple):
    """Of the instantaneous powers."""

    active: float  # mean (W)
    reactive: float  # mean (var)
    active_2f: float  # amplitude at twice the fundamental (W)


class DcSums(NamedTuple):
    """Of the DC voltage."""

    mean: float  # (V)
    of_2f: float  # amplitude at twice the fundamental, without its straight line (V)


class WindowSums(NamedTuple):
    """What is taken over the whole cycles at the beginning of a window; None where the record lacks the channels."""

    voltages: ComplexSamples | None = None  # phasors of the fundamental (V, peak), shape (3,)
    powers: PowerSums | None = None
    dc: DcSums | None = None


FoundSums = tuple[ComplexSamples, tuple[float, float, float], tuple[float, float]]
"""The same, as plain numbers."""


class WindowInstruments(NamedTuple):
    """Functions that do in place of numpy what a window takes the longest for, and give the same but for rounding."""

    sums: Callable[[Segment, float, int, float], FoundSums] | None = None
    """`window_sums`: a segment with all channels, frequency (Hz), samples of its whole cycles, length in steps."""
    harmonics: Callable[[Samples, float, int], Samples] | None = None
    """`harmonics.harmonic_amplitudes`: samples of whole cycles, angle from one to the next, last order."""
    frequency: Callable[[Segment, float, str, float], float | None] | None = None
    """`frequency.fundamental_frequency`, None where it finds none: segment, nominal frequency (Hz), kind and floor."""


WINDOWS_BY_DEFINITION = WindowInstruments()
"""None: numpy does it."""


def window_sums(segment: Segment, frequency_hz: float, by: WindowInstruments = WINDOWS_BY_DEFINITION) -> WindowSums:
    """Measure the whole cycles at the beginning of a window.

    Parameters
    ----------
    segment : Segment
        The window.
    frequency_hz : float
        Frequency that the cycles are counted of (Hz).
    by : WindowInstruments
        What does so in place of numpy, of a record that has all channels.

    Raises
    ------
    MeasurementError
        When the window does not hold one cycle.
    """
    dt_s, has_dc = segment.dt_s, "v_dc_v" in segment.channels
    has_voltages, has_currents = (has_phases(segment, kind) for kind in ("u", "i"))
    if by.sums is not None and has_voltages and has_currents and has_dc:
        cycles = whole_cycles(len(segment), dt_s, frequency_hz)
        voltages, powers, dc = by.sums(segment, frequency_hz, cycles.samples, cycles.length)
        return WindowSums(voltages, PowerSums(*powers), DcSums(*dc))
    found = WindowSums()
    if has_voltages:
        found = found._replace(voltages=components(np.stack(segment.three_phase("u")), dt_s, frequency_hz))
    if has_voltages and has_currents:
        p, q = instantaneous_power(segment)
        active, reactive = (mean(x, dt_s, frequency_hz) for x in (p, q))
        found = found._replace(powers=PowerSums(active, reactive, ripple_amplitude(p, dt_s, frequency_hz)))
    if has_dc:
        v_dc = segment["v_dc_v"]
        of_2f = ripple_amplitude(v_dc, dt_s, frequency_hz, detrend=True)
        found = found._replace(dc=DcSums(mean(v_dc, dt_s, frequency_hz), of_2f))
    return found


def has_phases(segment: Segment, kind: str) -> bool:
    """Whether a record has the three phases of a kind (a recording may lack some)."""
    return all(name in segment.channels for name in phase_channels(kind))
