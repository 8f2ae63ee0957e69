"""Line-to-line quantities from those of the phases; the phases' own are in `sequences`."""

import numpy as np

from pvlvrt_compliance.measure.fourier import Frequency, one_cycle_phasor
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
