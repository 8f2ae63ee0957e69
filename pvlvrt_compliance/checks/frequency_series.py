"""The frequency that a check judges: measured, without what steps of the voltage and of its angle make of it."""

import numpy as np

from pvlvrt_compliance.checks.disturbances import NORMAL_PU, after_each_step, angle_steps_s, voltage_steps_s
from pvlvrt_compliance.checks.evidence import Evidence, NotApplicable
from pvlvrt_compliance.checks.excursions import excursions
from pvlvrt_compliance.checks.series import Mask
from pvlvrt_compliance.waveforms.container import Samples

DEVIATION_HZ = 0.2
"""Frequencies nearer to nominal than this are those of normal operation: the first thresholds for a power that follows
the frequency are 50.2 Hz and 49.8 Hz (NTS 631), 36 mHz of dead-band and more elsewhere, and no band ends inside."""

ACCURACY_HZ = 0.010
"""How well a frequency is known (NTS 631 v2.0 demands it of the measurement): nearer to a limit is on it."""

_SPOILED_CYCLES = 4.1
"""What a frequency rests on and settles in, and a sample or two: a step into the worst isolated two-phase fault leaves
0.17 Hz after two cycles, when all windows lie behind it, and 3 mHz after these."""

_TERMINALS_SETTLED_CYCLES = 5.0
"""From a voltage that is normal again until the current behind it has settled: then the angle of the terminals is that
of the grid, but for a constant (a short-circuit ratio of 2 leaves under 0.1 Hz)."""

_LEAST_SOURCE_PU = 0.05
"""Noise of 0.5 % a sample at 24 kHz turns a voltage of this size, from one cycle to the next, as 0.07 Hz would."""


def frequency_hz(evidence: Evidence) -> Samples:
    """Frequency at each sample (Hz), the last known value held; shape (n,), NaN before the first."""
    known = known_frequency_hz(evidence)
    last = np.maximum.accumulate(np.where(np.isfinite(known), np.arange(len(known)), -1))
    return np.where(last >= 0, known[last], np.nan)


def known_frequency_hz(evidence: Evidence) -> Samples:
    """Frequency at each sample (Hz), NaN where it is not known, shape (n,).

    It is not for some cycles after each step of the voltage or of its angle: a jump of the angle is no frequency, and
    codes leave out the instants of a fault and of its clearing; nor where the source has hardly any voltage. A record
    without the source's voltage has that of the terminals, whose angle the inverter's current turns behind an
    impedance: there it is not known for as long as the voltage is not normal, and until the current has settled after
    that and after each step.
    """
    return np.where(_disturbed(evidence), np.nan, evidence.tracked_frequency_hz)


def held_in_words(evidence: Evidence) -> str:
    """What a message says of a frequency that was not measured throughout, empty when it was."""
    return "" if _has_source(evidence) else " (at the terminals, held while their voltage was not normal)"


def _has_source(evidence: Evidence) -> bool:
    return "u0_a_v" in evidence.waveforms.names


def _disturbed(evidence: Evidence) -> Mask:
    """Where the measured frequency is not the grid's."""
    angles_s, voltages_s = angle_steps_s(evidence.scenario), voltage_steps_s(evidence.scenario)
    disturbed = after_each_step(evidence, _SPOILED_CYCLES, (*angles_s, *voltages_s))
    if _has_source(evidence):
        return disturbed | _around(evidence.sequence_pu("u0", 0) < _LEAST_SOURCE_PU, evidence, _SPOILED_CYCLES)
    positive, negative = evidence.voltage_positive_pu, evidence.voltage_negative_pu
    low, high = NORMAL_PU
    abnormal = (positive < low) | (positive > high) | (negative > 1 - low)
    disturbed |= after_each_step(evidence, _TERMINALS_SETTLED_CYCLES, voltages_s)
    return disturbed | _around(abnormal, evidence, _TERMINALS_SETTLED_CYCLES)


def _around(mask: Mask, evidence: Evidence, after_cycles: float) -> Mask:
    """A mask with the cycle before each stretch, in which a one-cycle voltage was on its way, and some cycles after."""
    cycle_s = 1 / evidence.frequency_hz
    around = np.zeros(len(mask), dtype=np.bool_)
    for begin_s, end_s in excursions(mask, evidence.t_s, gap_s=cycle_s):
        around |= evidence.between(begin_s - cycle_s, end_s + after_cycles * cycle_s)
    return around


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
