"""The inverter stays connected through jumps of the voltage's angle, and its active power comes back."""

import math
from bisect import bisect_left, bisect_right
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.checks.connection.demand import Demand, failed_throughout, judged_stay
from pvlvrt_compliance.checks.connection.letting_go import Stop, stop_of
from pvlvrt_compliance.checks.recovery import judge_recovery, recovery_band
from pvlvrt_compliance.data.marks import marks_in
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable
from pvlvrt_compliance.evidence.frequency import ends_at_another_frequency
from pvlvrt_compliance.evidence.stretches import between_steps_s, settling_s
from pvlvrt_compliance.measure.extremes import first_most, largest
from pvlvrt_compliance.measure.fourier import ComplexSamples
from pvlvrt_compliance.profile.requirements import PhaseJumpRideThrough
from pvlvrt_compliance.results import Band, Status, Verdict
from pvlvrt_compliance.space_vectors import fortescue

KIND = "phase_jump_ride_through"

_TURN_DEG = 360.0


class SeenJump(NamedTuple):
    """One jump of the angle of the voltage without the inverter's current."""

    at_s: float
    positive_deg: float  # of the positive sequence
    phase_deg: float  # of the phase that jumps the furthest
    seen: str  # measured, or asked for
    accuracy_deg: float  # how well it is known: nearer to a limit is on it

    @property
    def in_words(self) -> str:
        """The jump as a message names it."""
        words = f"{self.positive_deg:.1f} deg of the positive sequence"
        alone = abs(self.phase_deg - self.positive_deg) > self.accuracy_deg
        return f"{words} ({self.phase_deg:.1f} deg of one phase)" if alone else words


class PhaseJumpRideThroughCheck(Check):
    """Judges whether the inverter stays connected through jumps of the angle, and how soon P is back then."""

    kind = KIND
    title = "Ride-through of jumps of the angle"
    requirement = PhaseJumpRideThrough
    judges_connection = True

    def judge(self, requirement: PhaseJumpRideThrough, evidence: Evidence) -> Verdict:
        """Judge connection through every jump of the disturbance, and the power after the last one.

        Raises
        ------
        NotApplicable
            When no angle jumps, a jump is beyond what the code names, or the inverter tripped before the first one or
            while the voltage was not normal.
        MeasurementError
            When a voltage or P is missing, or the record does not say whether the breaker is closed.
        """
        jumps = [jump_at(evidence, t) for t in evidence.disturbance.angle_steps_s]
        if not jumps:
            raise NotApplicable("no angle of the voltage jumps in this test")
        for jump in jumps:
            if (beyond := _beyond(requirement, jump)) is not None:
                raise NotApplicable(
                    f"the jump at {jump.at_s:.3f} s, {jump.seen}, of {jump.in_words} is beyond {beyond}"
                )
        if (stop := stop_of(evidence)) is not None:
            return _judge_trip(requirement, evidence, jumps, stop)
        furthest = first_most(jumps, lambda jump: abs(jump.positive_deg), _TURN_DEG)
        verdict = judge_recovery(
            KIND,
            requirement,
            evidence,
            from_s=jumps[-1].at_s,
            fraction=requirement.recovery_fraction,
            time_s=requirement.recovery_time_s,
            rests_on=[number for _, number in marks_in(requirement)],
            since=f"the last jump (largest: {furthest.in_words}, {furthest.seen})",
        )
        if verdict.status is Status.FAIL and ends_at_another_frequency(evidence):
            raise NotApplicable("connected through every jump; the frequency ends elsewhere, and the power with it")
        return verdict

    def limits(self, requirement: PhaseJumpRideThrough, evidence: Evidence) -> tuple[Band, ...]:
        """The power that must be back after the last jump; of an inverter that let go, none."""
        if stop_of(evidence) is not None or ends_at_another_frequency(evidence):
            return ()
        from_s = evidence.disturbance.angle_steps_s[-1]
        return recovery_band(
            KIND,
            evidence,
            from_s=from_s,
            fraction=requirement.recovery_fraction,
            time_s=requirement.recovery_time_s,
        )


def jump_at(evidence: Evidence, at_s: float) -> SeenJump:
    """The jump at an instant: measured over the cycles before and after it, less what the frequency turns in a cycle.

    Where the voltage is not steady for so long, or where it vanishes, it is the jump asked for.
    """
    phasors = evidence.no_load_phasors_pu if evidence.no_load_phasors_pu is not None else evidence.voltage_phasors_pu
    cycle_s, accuracy_deg = settling_s(evidence), evidence.thresholds.angle_accuracy_deg.value
    before_s, _ = between_steps_s(evidence, at_s - 1e-6)
    _, after_s = between_steps_s(evidence, at_s)
    jumps_s = evidence.disturbance.angle_steps_s
    here, after = bisect_left(jumps_s, at_s), bisect_right(jumps_s, at_s)
    beside_s = (*jumps_s[max(here - 1, 0) : here], *jumps_s[after : after + 1])
    alone = all(abs(t - at_s) > 2 * cycle_s for t in beside_s)
    alone = alone and evidence.disturbance.is_frequency_steady(at_s - 2 * cycle_s, at_s + 2 * cycle_s)
    if alone and at_s - before_s > 2 * cycle_s and after_s - at_s > cycle_s:
        before = evidence.t_s[max(int(np.searchsorted(evidence.t_s, at_s - 1e-9)) - 1, 0)]  # the last sample
        first, last, then = (_at(phasors, evidence, t) for t in (before - cycle_s, before, before + 2 * cycle_s))
        drift = np.angle(_positive(last) * np.conj(_positive(first)))
        jump = _measured(at_s, last, then * np.exp(-1j * drift), accuracy_deg)
        if math.isfinite(jump.positive_deg) and math.isfinite(jump.phase_deg):
            return jump
    asked = evidence.disturbance.jump_at(at_s)
    return SeenJump(at_s, asked.positive_deg, asked.phase_deg, "asked for", accuracy_deg)


def _measured(at_s: float, last: ComplexSamples, then: ComplexSamples, accuracy_deg: float) -> SeenJump:
    ratios = then * np.conj(last)
    of_phases = np.degrees(np.angle(ratios))
    most = of_phases[largest(np.abs(of_phases), _TURN_DEG).at]
    positive = np.degrees(np.angle(_positive(then) * np.conj(_positive(last))))
    return SeenJump(at_s, float(positive), float(most), "measured", accuracy_deg)


def _positive(phasors: ComplexSamples) -> complex:
    return complex(fortescue(*phasors)[0])


def _at(phasors: ComplexSamples, evidence: Evidence, t_s: float) -> ComplexSamples:
    index = min(int(np.searchsorted(evidence.t_s, t_s)), len(evidence.t_s) - 1)
    found: ComplexSamples = phasors[:, index]
    return found


def _beyond(requirement: PhaseJumpRideThrough, jump: SeenJump) -> str | None:
    """The limit that a jump is beyond, in words; None when the code demands to ride through it."""
    if abs(jump.positive_deg) > requirement.all_phases_deg.value + jump.accuracy_deg:
        return f"the {requirement.all_phases_deg.value:g} deg of the code"
    single = requirement.single_phase_deg
    if single is not None and abs(jump.phase_deg) > single.value + jump.accuracy_deg:
        return f"the {single.value:g} deg of one phase of the code"
    return None


def _judge_trip(requirement: PhaseJumpRideThrough, evidence: Evidence, jumps: list[SeenJump], stop: Stop) -> Verdict:
    if stop.at_s < jumps[0].at_s:
        raise NotApplicable("tripped before the first jump")
    if not evidence.disturbance.is_normal(stop.at_s):
        raise NotApplicable("tripped while the voltage was not normal, which is judged by ride_through")
    grid = evidence.disturbance
    jump = next(jump for jump in reversed(jumps) if jump.at_s <= stop.at_s)
    mark, clause = requirement.all_phases_deg, requirement.clause
    demand = Demand(jump.at_s, max(grid.end_s - jump.at_s, 0.0), "the code", clause, mark)
    message = (
        f"{stop.in_words}, {stop.at_s - jump.at_s:.3f} s after a jump of {jump.in_words} ({jump.seen}); the code"
        " demands connection"
    )
    if evidence.expect == "ride_through" and stop.at_s < grid.end_s:
        return judged_stay(KIND, requirement, Status.FAIL, message, demand, stopped_at_s=stop.at_s)
    return failed_throughout(KIND, requirement, message, demand, stopped_at_s=stop.at_s)
