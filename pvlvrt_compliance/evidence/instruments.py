"""What series are measured with: the functions of `measure`, or others that give the same."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.measure.fourier import ComplexSamples, one_cycle_mean
from pvlvrt_compliance.measure.power import instantaneous_power
from pvlvrt_compliance.measure.sequences import sequence_phasors
from pvlvrt_compliance.measure.sliding import Frequency
from pvlvrt_compliance.measure.tracking import tracked_frequency
from pvlvrt_compliance.measure.window_sums import WINDOWS_BY_DEFINITION, WindowInstruments
from pvlvrt_compliance.waveforms.container import Samples, Segment

__all__ = ["BY_DEFINITION", "Instruments", "WindowInstruments", "mean_powers", "sequences"]


class Instruments(NamedTuple):
    """Functions that make a series of a segment; `measure` says of what, and how.

    Whoever has faster ones hands them to the evidence. They have to give the same but for rounding (1e-9 of what is
    measured), not-a-number where `measure` has it, and its errors. A series that no check asks for is never made. What
    is left out is made of the phasors. A base is what values are divided by.
    """

    sequence_phasors: Callable[[Segment, str, Frequency], ComplexSamples]
    """Those of `measure.sequences.sequence_phasors`, shape (3, n): segment, kind and frequency (Hz)."""
    mean_powers: Callable[[Segment, Frequency, float], Samples]
    """Means of p (W) and q (var) over one cycle of a frequency (Hz), by a base, shape (2, n)."""
    tracked_frequency: Callable[[Segment, float, str, float], Samples]
    """`measure.tracking.tracked_frequency`: segment, nominal frequency (Hz), kind and floor."""
    sequence_current: Callable[[Segment, int, Frequency, float, float], Samples] | None = None
    """`measure.power.sequence_current` of a sequence (0 positive, 1 negative), floor (V) and base; shape (2, n)."""
    sequence_amplitudes: Callable[[Segment, str, Frequency, float], Samples] | None = None
    """Amplitudes of the positive and the negative sequence by a base, shape (2, n)."""
    phase_amplitudes: Callable[[Segment, str, Frequency, float], Samples] | None = None
    """`measure.sequences.phase_amplitudes` by a base, shape (3, n)."""
    windows: WindowInstruments = WINDOWS_BY_DEFINITION
    """What windows are measured with."""


def sequences(segment: Segment, kind: str, frequency_hz: Frequency) -> ComplexSamples:
    """One-cycle phasors of the sequences, shape (3, n), as `sequence_phasors`."""
    return np.stack(sequence_phasors(segment, kind, frequency_hz))


def mean_powers(segment: Segment, frequency_hz: Frequency, base: float = 1.0) -> Samples:
    """Means of p (W) and q (var) by a base over the cycle that ends at each sample, shape (2, n)."""
    means = one_cycle_mean(np.stack(instantaneous_power(segment)), segment.dt_s, frequency_hz)
    means /= base
    return means


BY_DEFINITION = Instruments(sequences, mean_powers, tracked_frequency)
"""The functions of `measure` themselves."""
