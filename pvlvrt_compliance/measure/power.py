"""Instantaneous active and reactive power."""

from typing import NamedTuple

from pvlvrt_compliance.space_vectors import clarke
from pvlvrt_compliance.waveforms.container import Samples, Segment


class Power(NamedTuple):
    """Instantaneous powers, generator sign, shape (n,)."""

    p: Samples  # active (W)
    q: Samples  # reactive (var), positive with the current behind the voltage


def instantaneous_power(segment: Segment) -> Power:
    """Powers that flow to the grid at each sample: p + jq = u conj(i), eqs (2) and (3) of the paper.

    Raises
    ------
    MeasurementError
        When a voltage or a current is missing.
    """
    s = clarke(*segment.three_phase("u")) * clarke(*segment.three_phase("i")).conj()
    return Power(p=s.real, q=s.imag)
