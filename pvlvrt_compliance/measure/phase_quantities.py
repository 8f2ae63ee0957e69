"""Line-to-line quantities from those of the phases, and the voltages that codes speak of."""

import numpy as np

from pvlvrt_compliance.measure.fourier import ComplexSamples, Frequency, one_cycle_phasor
from pvlvrt_compliance.space_vectors import fortescue
from pvlvrt_compliance.waveforms.container import Samples, Segment, ThreePhase


def line_to_line(segment: Segment, kind: str) -> ThreePhase:
    """Differences of the phases: u_ab = u_a - u_b in ``a``, u_bc in ``b``, u_ca in ``c``, shape (n,) each.

    The zero sequence drops out: codes that judge line-to-line voltages do not see it.

    Parameters
    ----------
    segment : Segment
        Uniformly sampled record.
    kind : str
        ``u`` or ``u0`` (V); ``i`` gives the currents of a delta winding (A).

    Raises
    ------
    MeasurementError
        When a channel is missing.
    """
    a, b, c = segment.three_phase(kind)
    return ThreePhase(a=a - b, b=b - c, c=c - a)


def line_to_line_amplitudes(segment: Segment, kind: str, frequency_hz: Frequency) -> Samples:
    """Amplitudes of the fundamental of u_ab, u_bc, u_ca over the cycle that ends at each sample, shape (3, n).

    Peak values; sqrt(3) times the phases' in balance. NaN during the first cycle and one sample. Those of the phases
    are `sequences.phase_amplitudes`. ``frequency_hz`` (Hz) is one for all samples or one at each, shape (n,).

    Raises
    ------
    MeasurementError
        When a channel is missing, or a cycle has fewer than two samples.
    """
    return np.abs(one_cycle_phasor(np.stack(line_to_line(segment, kind)), segment.dt_s, frequency_hz))


VOLTAGES = ("mean_phase", "lowest_phase", "highest_phase", "lowest_line_to_line", "highest_line_to_line")
"""Voltages that codes speak of besides V+."""


def voltage_amplitude(phasors: ComplexSamples, quantity: str) -> Samples:
    """Amplitude of the voltage that a code speaks of, in pu of its own nominal value, shape (n,).

    Line-to-line voltages are in pu of the nominal line-to-line voltage: 1 in a healthy grid, as the phase voltages.

    Parameters
    ----------
    phasors : array, shape (3, n)
        Phase-to-neutral voltages (pu).
    quantity : str
        ``positive_sequence``, ``mean_phase``, or ``lowest_`` or ``highest_`` of ``phase`` or ``line_to_line``.
    """
    if quantity == "positive_sequence":
        positive: Samples = np.abs(fortescue(*phasors)[0])
        return positive
    if quantity.endswith("line_to_line"):
        phasors = (phasors - np.roll(phasors, -1, axis=0)) / np.sqrt(3)
    amplitudes = np.abs(phasors)
    if quantity == "mean_phase":
        mean: Samples = amplitudes.mean(axis=0)
        return mean
    extreme: Samples = amplitudes.min(axis=0) if quantity.startswith("lowest") else amplitudes.max(axis=0)
    return extreme
