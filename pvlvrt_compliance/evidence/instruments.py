"""What series are measured with: the functions of `measure`, or others that give the same."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.measure.fourier import ComplexSamples, one_cycle_mean
from pvlvrt_compliance.measure.power import instantaneous_power
from pvlvrt_compliance.measure.sequences import sequence_phasors
from pvlvrt_compliance.measure.sliding import Frequency
from pvlvrt_compliance.measure.tracking import tracked_frequency
from pvlvrt_compliance.waveforms.container import Samples, Segment


class Instruments(NamedTuple):
    """Functions that make a series of a segment; `measure` says of what, and how.

    Whoever has faster ones hands them to the evidence. They have to give the same but for rounding (1e-9 of what is
    measured), not-a-number where `measure` has it, and its errors. A series that no check asks for is never made.
    """

    sequence_phasors: Callable[[Segment, str, Frequency], ComplexSamples]
    """Those of `measure.sequences.sequence_phasors`, shape (3, n): segment, kind and frequency (Hz)."""
    mean_powers: Callable[[Segment, Frequency], Samples]
    """Means of p (W) and q (var) over one cycle of a frequency (Hz), shape (2, n)."""
    tracked_frequency: Callable[[Segment, float, str, float], Samples]
    """`measure.tracking.tracked_frequency`: segment, nominal frequency (Hz), kind and floor."""


def sequences(segment: Segment, kind: str, frequency_hz: Frequency) -> ComplexSamples:
    """One-cycle phasors of the sequences, shape (3, n), as `sequence_phasors`."""
    return np.stack(sequence_phasors(segment, kind, frequency_hz))


def mean_powers(segment: Segment, frequency_hz: Frequency) -> Samples:
    """Means of p (W) and q (var) over the cycle that ends at each sample, shape (2, n), as `one_cycle_mean`."""
    return one_cycle_mean(np.stack(instantaneous_power(segment)), segment.dt_s, frequency_hz)


BY_DEFINITION = Instruments(sequences, mean_powers, tracked_frequency)
"""The functions of `measure` themselves."""
