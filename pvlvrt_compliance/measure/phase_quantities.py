"""Line-to-line quantities from those of the phases, and the voltages that codes speak of."""

import numpy as np

from pvlvrt_compliance.measure.fourier import ComplexSamples, one_cycle_phasor
from pvlvrt_compliance.measure.sliding import Frequency
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


def amplitudes_for(phasors: ComplexSamples, quantity: str) -> Samples:
    """Amplitudes that a voltage which a code speaks of is the mean or an extreme of, shape (3, n).

    Those of the phases, or line to line: these in pu of the nominal line-to-line voltage, 1 in a healthy grid as the
    phase voltages are.

    Parameters
    ----------
    phasors : array, shape (3, n)
        Phase-to-neutral voltages (pu).
    quantity : str
        One of `VOLTAGES`.
    """
    if not quantity.endswith("line_to_line"):
        return np.abs(phasors)
    amplitudes = np.stack([np.abs(phasors[k] - phasors[(k + 1) % 3]) for k in range(3)])
    amplitudes /= np.sqrt(3)
    return amplitudes


def of_amplitudes(amplitudes: Samples, quantity: str) -> Samples:
    """Mean or extreme of the amplitudes of `amplitudes_for`, shape (n,)."""
    if quantity == "mean_phase":
        mean: Samples = amplitudes.mean(axis=0)
        return mean
    extreme: Samples = amplitudes.min(axis=0) if quantity.startswith("lowest") else amplitudes.max(axis=0)
    return extreme
