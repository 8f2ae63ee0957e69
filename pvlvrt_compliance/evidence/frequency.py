"""The frequency that a check judges: measured, without what steps of the voltage and of its angle make of it."""

import numpy as np

from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable
from pvlvrt_compliance.evidence.excursions import excursions, runs_of
from pvlvrt_compliance.evidence.no_load import has_source
from pvlvrt_compliance.evidence.series import Mask
from pvlvrt_compliance.evidence.stretches import after_each_step
from pvlvrt_compliance.measure.extremes import largest
from pvlvrt_compliance.waveforms.container import Samples

_LOOSER = 100
"""Rounding of a frequency in that of other values: it is an angle over time, and the angle grows with the record."""


def frequency_hz(evidence: Evidence) -> Samples:
    """Frequency at each sample (Hz), the last known value held; shape (n,), NaN before the first."""
    return evidence.once("frequency_hz", lambda: _held(known_frequency_hz(evidence)))


def _held(known: Samples) -> Samples:
    held = known.copy()
    for first, end in runs_of(~np.isfinite(known)):
        held[first:end] = known[first - 1] if first else np.nan
    return held


def known_frequency_hz(evidence: Evidence) -> Samples:
    """Frequency at each sample (Hz), NaN where it is not known, shape (n,).

    It is not for some cycles after each step of the voltage or of its angle: a jump of the angle is no frequency, and
    codes leave out the instants of a fault and of its clearing; nor where the source has hardly any voltage. A record
    without the source's voltage has that of the terminals, whose angle the inverter's current turns behind an
    impedance: there it is not known for as long as the voltage is not normal, and until the current has settled after
    that and after each step.
    """
    return evidence.once(
        "known_frequency_hz", lambda: np.where(_disturbed(evidence), np.nan, evidence.tracked_frequency_hz)
    )


def held_in_words(evidence: Evidence) -> str:
    """What a message says of a frequency that was not measured throughout, empty when it was."""
    return "" if has_source(evidence) else " (at the terminals, held while their voltage was not normal)"


def _disturbed(evidence: Evidence) -> Mask:
    """Where the measured frequency is not the grid's."""
    spoiled = evidence.thresholds.frequency_settled_cycles.value
    settled = evidence.thresholds.terminals_settled_cycles.value
    spoiled_s, settled_s = spoiled / evidence.frequency_hz, settled / evidence.frequency_hz
    disturbed = after_each_step(evidence, spoiled_s, evidence.disturbance.steps_of("angle", "voltage"))
    if has_source(evidence):
        faint = evidence.sequence_pu("u0", 0) < evidence.thresholds.least_source_pu.value
        return disturbed | _around(faint, evidence, spoiled)
    abnormal = evidence.disturbance.normal.is_left_by(evidence.voltage_positive_pu, evidence.voltage_negative_pu)
    disturbed |= after_each_step(evidence, settled_s, evidence.disturbance.voltage_steps_s)
    return disturbed | _around(abnormal, evidence, settled)


def _around(mask: Mask, evidence: Evidence, after_cycles: float) -> Mask:
    """A mask with the cycle before each stretch, in which a one-cycle voltage was on its way, and some cycles after."""
    cycle_s = 1 / evidence.frequency_hz
    around = np.zeros(len(mask), dtype=np.bool_)
    for begin_s, end_s in excursions(mask, evidence.t_s, gap_s=cycle_s):
        around[evidence.samples(begin_s - cycle_s, end_s + after_cycles * cycle_s)] = True
    return around


def largest_deviation(evidence: Evidence) -> tuple[float, float]:
    """Frequency furthest from nominal (Hz) and its first instant (s).

    Raises
    ------
    NotApplicable
        When the record has no voltage to measure a frequency of, or stays near nominal (`frequency_deviation_hz`).
    """
    frequency = frequency_hz(evidence)
    first = int(np.isfinite(frequency).argmax())  # what is not known after that is held
    if not np.isfinite(frequency[first]):
        raise NotApplicable("the record has no frequency")
    known, nominal_hz = frequency[first:], evidence.nominal.frequency_hz
    near_hz = evidence.thresholds.frequency_deviation_hz.value
    if max(abs(float(known.max()) - nominal_hz), abs(float(known.min()) - nominal_hz)) <= near_hz:
        raise NotApplicable(f"the frequency stays within {near_hz:g} Hz of nominal")
    _, since = largest(np.abs(known - nominal_hz), _LOOSER * nominal_hz)
    return float(frequency[first + since]), float(evidence.t_s[first + since])


def ends_at_another_frequency(evidence: Evidence) -> tuple[float, float] | None:
    """Frequencies before the disturbance and at the end of the record (Hz), None where they are alike or not known."""
    before, after = evidence.measurements.before, evidence.measurements.after
    first, last = (window.frequency_hz if window else None for window in (before, after))
    if first is None or last is None or abs(last - first) <= evidence.thresholds.frequency_deviation_hz.value:
        return None
    return first, last
