"""The frequency that a check judges: measured, without what steps of the voltage and of its angle make of it."""

import numpy as np

from pvlvrt_compliance.checks.disturbances import after_each_step, angle_steps_s, voltage_steps_s
from pvlvrt_compliance.checks.evidence import Evidence, NotApplicable
from pvlvrt_compliance.waveforms.container import Samples

DEVIATION_HZ = 0.2
"""Frequencies nearer to nominal than this are those of normal operation: the first thresholds for a power that follows
the frequency are 50.2 Hz and 49.8 Hz (NTS 631), 36 mHz of dead-band and more elsewhere, and no band ends inside."""

ACCURACY_HZ = 0.010
"""How well a frequency is known (NTS 631 v2.0 demands it of the measurement): nearer to a limit is on it."""

_SPOILED_CYCLES = 2.1


def frequency_hz(evidence: Evidence) -> Samples:
    """Frequency at each sample (Hz), shape (n,); NaN before the first value.

    It rests on two cycles, so for that long after each step of the voltage or of its angle the last value is held: a
    jump of the angle is no frequency, and codes leave out the instants of a fault and of its clearing.
    """
    steps_s = (*voltage_steps_s(evidence.scenario), *angle_steps_s(evidence.scenario))
    measured = evidence.tracked_frequency_hz
    known = np.isfinite(measured) & ~after_each_step(evidence, _SPOILED_CYCLES, steps_s)
    last = np.maximum.accumulate(np.where(known, np.arange(len(measured)), -1))
    return np.where(last >= 0, measured[last], np.nan)


def largest_deviation(evidence: Evidence) -> tuple[float, float]:
    """Frequency furthest from nominal (Hz) and its instant (s).

    Raises
    ------
    NotApplicable
        When the record has no voltage to measure a frequency of, or stays within `DEVIATION_HZ` of nominal.
    """
    frequency = frequency_hz(evidence)
    known = np.flatnonzero(np.isfinite(frequency))
    if not len(known):
        raise NotApplicable("the record has no frequency")
    deviation = np.abs(frequency[known] - evidence.nominal.frequency_hz)
    at = known[deviation.argmax()]
    if deviation.max() <= DEVIATION_HZ:
        raise NotApplicable(f"the frequency stays within {DEVIATION_HZ:g} Hz of nominal")
    return float(frequency[at]), float(evidence.t_s[at])
