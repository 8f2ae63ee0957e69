"""Sequence phasors and phase amplitudes of three-phase quantities, one-cycle."""

import numpy as np

from pvlvrt_compliance.measure.fourier import ComplexSamples, one_cycle_phasor
from pvlvrt_compliance.measure.sliding import Frequency
from pvlvrt_compliance.space_vectors import SQRT3_2, Sequences
from pvlvrt_compliance.waveforms.container import Samples, Segment


def sequence_phasors(segment: Segment, kind: str, frequency_hz: Frequency) -> Sequences:
    """Positive, negative and zero sequence of the cycle that ends at each sample (Fortescue).

    Parameters
    ----------
    segment : Segment
        Uniformly sampled record.
    kind : str
        ``u`` or ``u0`` (V) or ``i`` (A).
    frequency_hz : float or array, shape (n,)
        Frequency of the fundamental (Hz), one for all or one at each sample.

    Returns
    -------
    Sequences
        Phasors as `one_cycle_phasor` gives them: NaN at first, angles referenced to the segment's first sample.

    Raises
    ------
    MeasurementError
        When a channel is missing.
    """
    # Fortescue's sequences of the samples first: three signals are averaged either way, and sums of samples are cheap.
    a, b, c = segment.three_phase(kind)
    forward = np.empty(len(a), dtype=np.complex128)
    forward.real = (a - 0.5 * (b + c)) / 3
    forward.imag = (b - c) * (SQRT3_2 / 3)
    turned = np.stack((forward, forward.conj(), (a + b + c) / 3))
    return Sequences(*one_cycle_phasor(turned, segment.dt_s, frequency_hz))


def phase_amplitudes(segment: Segment, kind: str, frequency_hz: Frequency) -> Samples:
    """Amplitude of the fundamental of each phase over the cycle that ends at each sample, shape (3, n).

    Parameters and errors as `sequence_phasors`.
    """
    return np.abs(_phase_phasors(segment, kind, frequency_hz))


def _phase_phasors(segment: Segment, kind: str, frequency_hz: Frequency) -> ComplexSamples:
    return one_cycle_phasor(np.stack(segment.three_phase(kind)), segment.dt_s, frequency_hz)
