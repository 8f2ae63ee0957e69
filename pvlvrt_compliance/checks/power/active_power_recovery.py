"""The active power comes back after clearing, the sooner the shallower the sag was."""

import numpy as np

from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.checks.parts import Part, judged_by_parts
from pvlvrt_compliance.checks.recovery import recovered_after_s, settled_after_s
from pvlvrt_compliance.data.marks import Marked
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable, require_finite, required
from pvlvrt_compliance.profile.requirements import ActivePowerRecovery
from pvlvrt_compliance.results import Verdict

KIND = "active_power_recovery"


class ActivePowerRecoveryCheck(Check):
    """Judges how soon P comes back after the sag, by times that a table states for its depth."""

    kind = KIND
    title = "Recovery of the active power"
    requirement = ActivePowerRecovery

    def judge(self, requirement: ActivePowerRecovery, evidence: Evidence) -> Verdict:
        """Judge when P is back at the first fraction, and when it stays within the tolerance of its value before.

        Times count from the first V+ after clearing that has returned. The depth is the mean V+ of the during-window,
        as NTS 631 takes V+ of a sag (Tables 48 to 50); of a sag too short for one, the lowest one-cycle V+. Reports the
        time with the least margin relative to its limit.

        Raises
        ------
        NotApplicable
            When the table has no row for the depth.
        MeasurementError
            When V+ or P cannot be measured, V+ does not return, or the record ends before P is back and before it must
            be.
        """
        residual_pu = _residual_pu(evidence)
        row = requirement.rows.row_for(residual_pu)
        if row is None:
            raise NotApplicable(f"no recovery is demanded after a sag to V+ = {residual_pu:.3f} pu")
        from_s = _returned_at_s(evidence, requirement.return_pu.value)
        before_kw = evidence.power_before_kw
        first_kw = requirement.first_fraction.value * before_kw
        band_kw = requirement.tolerance_fraction.value * evidence.nominal.apparent_power_kva
        first = _part(
            f"P at {100 * requirement.first_fraction.value:g} % of the {before_kw:.1f} kW before the sag to "
            f"{residual_pu:.3f} pu",
            evidence,
            from_s,
            recovered_after_s(evidence, from_s, first_kw),
            row.first_s,
            (requirement.rows, requirement.return_pu, requirement.first_fraction),
        )
        if not first.passed:  # a record that is too short for the final value shows this all the same
            return judged_by_parts(KIND, requirement, (first,))
        final = _part(
            f"P within {band_kw:.1f} kW of the {before_kw:.1f} kW before the sag to {residual_pu:.3f} pu",
            evidence,
            from_s,
            _within_after_s(evidence, from_s, before_kw, band_kw),
            row.first_s + row.final_extra_s,
            (requirement.rows, requirement.return_pu, requirement.tolerance_fraction),
        )
        return judged_by_parts(KIND, requirement, (first, final))


def _residual_pu(evidence: Evidence) -> float:
    if evidence.during_span is not None:
        return required(evidence.during().voltage_positive_pu, "V+")
    inside = evidence.between(evidence.disturbance.start_s, evidence.disturbance.clear_s)
    return float(require_finite(evidence.voltage_positive_pu[inside], "V+", evidence.t_s[inside]).min())


def _returned_at_s(evidence: Evidence, return_pu: float) -> float:
    after = evidence.between(evidence.disturbance.clear_s, evidence.waveforms.end_s)
    t_s = evidence.t_s[after]
    returned = require_finite(evidence.voltage_positive_pu[after], "V+", t_s) >= return_pu
    if not returned.any():
        raise MeasurementError(f"V+ does not return to {return_pu:g} pu before the record ends")
    return float(t_s[returned.argmax()])


def _within_after_s(evidence: Evidence, from_s: float, target_kw: float, band_kw: float) -> float | None:
    """Time from an instant until P stays within a band on both sides of a power (s), None when it ends outside."""
    after = evidence.between(from_s, evidence.waveforms.end_s)
    t_s = evidence.t_s[after]
    outside = np.abs(require_finite(evidence.active_power_kw[after], "P", t_s) - target_kw) > band_kw
    return settled_after_s(t_s, outside, from_s)


def _part(
    what: str,
    evidence: Evidence,
    from_s: float,
    back_s: float | None,
    allowed_s: float,
    rests_on: tuple[Marked, ...],
) -> Part:
    """Time until P is back; where it is not by the end of the record, the time that was observed.

    Raises
    ------
    MeasurementError
        When the record ends before P is back and before it must be.
    """
    observed_s = evidence.waveforms.end_s - from_s
    if back_s is None and observed_s <= allowed_s:
        raise MeasurementError(f"the record ends {observed_s:.3f} s after the voltage's return, before {what}")
    took_s = observed_s if back_s is None else back_s
    words = f"{'not back' if back_s is None else 'back'} after the voltage's return: {what}"
    return Part(words, took_s, allowed_s, "s", from_s + took_s, rests_on)
