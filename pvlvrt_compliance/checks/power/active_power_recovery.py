"""The active power comes back after clearing, the sooner the shallower the sag was."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.checks.check import StretchCheck
from pvlvrt_compliance.checks.limits import around, level, of_each
from pvlvrt_compliance.checks.parts import Part, judged_by_parts
from pvlvrt_compliance.checks.power.faults import faults, levels, next_fault_s, require_clearing, window_in
from pvlvrt_compliance.checks.recovery import part_after, recovered_after_s, settled_after_s
from pvlvrt_compliance.data.marks import Marked
from pvlvrt_compliance.disturbance.model import Stretch
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable, require_finite
from pvlvrt_compliance.profile.requirements import ActivePowerRecovery
from pvlvrt_compliance.profile.tables import RecoveryRow
from pvlvrt_compliance.results import Band, Verdict
from pvlvrt_compliance.results.band import ACTIVE_POWER

KIND = "active_power_recovery"


class _Return(NamedTuple):
    """The time after a clearing in which P is looked at (s)."""

    from_s: float  # the voltage's return
    until_s: float | None  # the next fault, or a trip; None: the record ends it


class ActivePowerRecoveryCheck(StretchCheck):
    """Judges how soon P comes back after each sag, by times that a table states for its depth."""

    kind = KIND
    title = "Recovery of the active power"
    requirement = ActivePowerRecovery
    until = "trip"

    def stretches(self, requirement: ActivePowerRecovery, evidence: Evidence) -> Sequence[Stretch]:  # noqa: ARG002
        """The faults, each from its start to its clearing."""
        return faults(evidence)

    def judge_stretch(self, requirement: ActivePowerRecovery, evidence: Evidence, stretch: Stretch) -> Verdict:
        """Judge when P is back at the first fraction, and when it stays within the tolerance of its value before.

        Times count from the first V+ after clearing that has returned. The depth is the mean V+ of the fault's window,
        as NTS 631 takes V+ of a sag (Tables 48 to 50); of a sag too short for one, the lowest one-cycle V+; of a fault
        of several levels, that of the deepest. Reports the time with the least margin relative to its limit. Where the
        next fault, or a trip, comes before a time is over, that time is judged only if it was kept.

        Raises
        ------
        NotApplicable
            When there was no active power before, the table has no row for the depth, the limits of the voltage have
            let the inverter go before the clearing, it tripped before, or the next fault comes too soon.
        MeasurementError
            When V+ or P cannot be measured, V+ does not return, or the record ends before P is back and before it must
            be.
        """
        residual_pu, row = _row(requirement, evidence, stretch)
        seen = _return(evidence, stretch, requirement.return_pu.value)
        before_kw = evidence.starting_power_kw
        first_kw = requirement.first_fraction.value * before_kw
        band_kw = requirement.tolerance_fraction.value * evidence.nominal.apparent_power_kva
        first = _part(
            f"P at {100 * requirement.first_fraction.value:g} % of the {before_kw:.1f} kW before the sag to "
            f"{residual_pu:.3f} pu",
            evidence,
            seen,
            recovered_after_s(evidence, seen.from_s, first_kw, seen.until_s),
            row.first_s,
            (requirement.rows.mark_of(row), requirement.return_pu, requirement.first_fraction),
        )
        if not first.passed:  # a record that is too short for the final value shows this all the same
            return judged_by_parts(KIND, requirement, (first,))
        final = _part(
            f"P within {band_kw:.1f} kW of the {before_kw:.1f} kW before the sag to {residual_pu:.3f} pu",
            evidence,
            seen,
            _within_after_s(evidence, seen, before_kw, band_kw),
            row.first_s + row.final_extra_s,
            (requirement.rows.mark_of(row), requirement.return_pu, requirement.tolerance_fraction),
        )
        return judged_by_parts(KIND, requirement, (first, final))

    def limits(self, requirement: ActivePowerRecovery, evidence: Evidence) -> tuple[Band, ...]:
        """After each fault: the first fraction from its time on, then the tolerance around P before."""

        def bands(stretch: Stretch) -> Iterator[Band]:
            _, row = _row(requirement, evidence, stretch)
            seen = _return(evidence, stretch, requirement.return_pu.value)
            end_s, before_kw = seen.until_s or evidence.waveforms.end_s, evidence.starting_power_kw
            room_kw = requirement.tolerance_fraction.value * evidence.nominal.apparent_power_kva
            first_s, final_s = seen.from_s + row.first_s, seen.from_s + row.first_s + row.final_extra_s
            if first_s < end_s:
                least_kw = requirement.first_fraction.value * before_kw
                yield level(KIND, ACTIVE_POWER, "P first back", (first_s, end_s), lower=least_kw)
            if final_s < end_s:
                yield around(KIND, ACTIVE_POWER, "P back", (final_s, end_s), before_kw, room_kw)

        return of_each(self.stretches(requirement, evidence), bands)


def _row(requirement: ActivePowerRecovery, evidence: Evidence, fault: Stretch) -> tuple[float, RecoveryRow]:
    """V+ of a fault (pu), and the row of the table that its depth has.

    Raises
    ------
    NotApplicable
        When there is none, or nothing is demanded after the fault.
    MeasurementError
        When V+ cannot be measured.
    """
    require_clearing(fault, evidence)
    _require_no_release(fault, evidence)
    residual_pu = min(_residual_pu(part, evidence) for part in levels(fault, evidence))
    # On the edge of two rows by less than the rounding of a voltage is on it, whichever way it was rounded.
    row = requirement.rows.row_for(residual_pu + evidence.thresholds.voltage_tolerance_pu.value)
    if row is None:
        raise NotApplicable(f"no recovery is demanded after a sag to V+ = {residual_pu:.3f} pu")
    return residual_pu, row


def _require_no_release(fault: Stretch, evidence: Evidence) -> None:
    """Let off an inverter that the voltage had let go before the clearing; a row asks for all of its disturbance."""
    released_s = evidence.released_at_s
    if released_s is not None and released_s < fault.end_s:
        raise NotApplicable(f"not judged from {released_s:.3f} s on, when the inverter may let go")


def _residual_pu(level: Stretch, evidence: Evidence) -> float:
    window = window_in(level, evidence)
    if window is not None and not level.ramps:
        inside = evidence.window_of(level)
        if inside.voltage_positive_pu is None:
            raise MeasurementError("V+ could not be measured")
        return inside.voltage_positive_pu
    part = evidence.samples(level.begin_s, level.end_s)
    return float(require_finite(evidence.voltage_positive_pu[part], "V+", evidence.t_s[part]).min())


def _return(evidence: Evidence, fault: Stretch, return_pu: float) -> _Return:
    until_s = next_fault_s(fault, evidence)
    after = part_after(evidence, fault.end_s, until_s)
    t_s = evidence.t_s[after]
    returned = require_finite(evidence.voltage_positive_pu[after], "V+", t_s) >= return_pu
    if returned.any():
        return _Return(float(t_s[returned.argmax()]), until_s)
    if until_s is not None:
        raise NotApplicable(f"V+ does not return to {return_pu:g} pu before {until_s:.3f} s")
    raise MeasurementError(f"V+ does not return to {return_pu:g} pu before the record ends")


def _within_after_s(evidence: Evidence, seen: _Return, target_kw: float, band_kw: float) -> float | None:
    """Time until P stays within a band on both sides of a power (s), None when it ends outside."""
    after = part_after(evidence, *seen)
    t_s = evidence.t_s[after]
    outside = np.abs(require_finite(evidence.active_power_kw[after], "P", t_s) - target_kw) > band_kw
    return settled_after_s(t_s, outside, seen.from_s)


def _part(
    what: str, evidence: Evidence, seen: _Return, back_s: float | None, allowed_s: float, rests_on: tuple[Marked, ...]
) -> Part:
    """Time until P is back; where it is not by the end of what is seen, the time that was observed.

    Raises
    ------
    NotApplicable
        When the next fault, or a trip, comes before P is back and before it must be.
    MeasurementError
        When the record ends so.
    """
    observed_s = (evidence.waveforms.end_s if seen.until_s is None else seen.until_s) - seen.from_s
    if back_s is None and observed_s <= allowed_s:
        if seen.until_s is not None:
            raise NotApplicable(f"only {observed_s:.3f} s of {allowed_s:g} s follow the voltage's return for {what}")
        raise MeasurementError(f"the record ends {observed_s:.3f} s after the voltage's return, before {what}")
    took_s = observed_s if back_s is None else back_s
    words = f"{'not back' if back_s is None else 'back'} after the voltage's return: {what}"
    return Part(words, took_s, allowed_s, "s", seen.from_s + took_s, rests_on, evidence.half_cycle_s)
