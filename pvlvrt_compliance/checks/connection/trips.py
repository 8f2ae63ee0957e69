"""Verdicts on a trip: what it broke, or what allowed it."""

from pvlvrt_compliance.checks.connection.demand import Demand, failed_throughout, judged_stay
from pvlvrt_compliance.checks.connection.letting_go import Moved, Stop, grid_frequency_hz, moved_at
from pvlvrt_compliance.checks.connection.release import Limits
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable
from pvlvrt_compliance.evidence.no_load import has_source
from pvlvrt_compliance.evidence.stretches import between_steps_s
from pvlvrt_compliance.profile.requirements import RideThrough
from pvlvrt_compliance.results import Status, Verdict

_KIND = "ride_through"
_OWN_CHECK = {"frequency": "frequency_ride_through", "angle": "phase_jump_ride_through"}
_A_SWING_PU = 0.05  # of V+ at the terminals while the grid stands still: chosen, far above what support moves


def judged_trip(requirement: RideThrough, evidence: Evidence, limits: Limits, stop: Stop) -> Verdict:
    """Verdict on an inverter that let go.

    Raises
    ------
    NotApplicable
        When the code demands nothing of the disturbance, or another check decides.
    MeasurementError
        When only the voltage at the terminals let it go, or the profile is silent on what had moved.
    """
    grid, moved = evidence.disturbance, moved_at(evidence, stop.at_s)
    if evidence.expect == "ride_through" and stop.at_s < grid.end_s:
        return _broken_off(requirement, evidence, stop, limits.whole(evidence, stop.at_s))
    release = limits.release
    released = release is not None and stop.at_s >= release.until_s
    if release is not None and released and evidence.expect != "ride_through" and (moved or stop.at_s < grid.end_s):
        return _released(requirement, evidence, release, stop)
    if moved in ("low voltage", "high voltage") and not released:
        _require_a_limit(requirement, evidence, moved, stop)
        demand = limits.demand_at(stop.at_s) or limits.whole(evidence, stop.at_s)
        return _broken_off(requirement, evidence, stop, demand.at_most(max(grid.end_s, stop.at_s)))
    if moved is not None:
        _leave_to_others(evidence, moved, stop)
    return _in_a_normal_grid(requirement, evidence, limits, stop)


def _released(requirement: RideThrough, evidence: Evidence, release: Demand, stop: Stop) -> Verdict:
    if not has_source(evidence):
        raise MeasurementError(
            f"{stop.in_words}: no-load voltage missing, and the inverter's own current may have changed the voltage at "
            "the terminals by which it might let go"
        )
    if release.stay_s <= 0:
        raise NotApplicable(f"{stop.in_words}; {release.by} demands nothing at this voltage")
    message = f"{stop.in_words}: connected for {stop.at_s - release.since_s:.3f} s; {release.in_words}"
    return judged_stay(_KIND, requirement, Status.PASS, message, release, stopped_at_s=stop.at_s)


def _broken_off(requirement: RideThrough, evidence: Evidence, stop: Stop, demand: Demand) -> Verdict:
    """A trip before the time demanded is over."""
    since = "start" if demand.since_s == evidence.disturbance.start_s else f"step at {demand.since_s:.3f} s"
    after = f"{stop.at_s - demand.since_s:.3f} s after the {since}"
    message = f"{stop.in_words}, {after}; {demand.in_words}{_swing(evidence, stop)}"
    if stop.at_s >= demand.until_s:
        return failed_throughout(_KIND, requirement, message, demand, stopped_at_s=stop.at_s)
    return judged_stay(_KIND, requirement, Status.FAIL, message, demand, stopped_at_s=stop.at_s)


def _in_a_normal_grid(requirement: RideThrough, evidence: Evidence, limits: Limits, stop: Stop) -> Verdict:
    grid = evidence.disturbance
    demand = limits.whole(evidence, stop.at_s)
    if stop.at_s < grid.end_s and grid.steps:
        return _broken_off(requirement, evidence, stop, demand)
    after = f"{stop.at_s - grid.start_s:.3f} s after the start"
    message = f"{stop.in_words}, {after}, in a grid that was normal: connection is demanded throughout"
    return failed_throughout(_KIND, requirement, message, demand, stopped_at_s=stop.at_s)


def _require_a_limit(requirement: RideThrough, evidence: Evidence, moved: Moved, stop: Stop) -> None:
    """Without limits of low voltage a profile demands connection throughout; without those of high voltage, nothing.

    Raises
    ------
    MeasurementError
        When it says nothing of high voltage.
    """
    if moved == "high voltage" and requirement.envelope_over_voltage is None and requirement.regions is None:
        level = evidence.disturbance.no_load(stop.at_s).positive_pu
        after = f"{stop.at_s - evidence.disturbance.start_s:.3f} s after the start"
        raise MeasurementError(
            f"tripped at {level:.3f} pu{stop.cause}, {after}; this profile says nothing of over-voltage"
        )


def _leave_to_others(evidence: Evidence, moved: Moved, stop: Stop) -> None:
    """Frequency and angle have their own checks, where the profile has them.

    Raises
    ------
    NotApplicable
        When it has.
    MeasurementError
        When it says nothing of what moved.
    """
    kind = _OWN_CHECK.get(moved)
    if kind is None:
        return
    if evidence.requirements is not None and evidence.requirements.of_kind(kind) is not None:
        raise NotApplicable(f"{stop.in_words}, which {kind} judges")
    where = f"at {grid_frequency_hz(evidence, stop.at_s):.2f} Hz" if moved == "frequency" else f"at {stop.at_s:.3f} s"
    what = "frequency" if moved == "frequency" else "jumps of the angle"
    after = "" if moved == "frequency" else ", right after a jump of the angle"
    raise MeasurementError(f"tripped {where}{stop.cause}{after}; this profile says nothing of {what}")


def _swing(evidence: Evidence, stop: Stop) -> str:
    """What V+ at the terminals did while the voltage of the source stood still, where it swung."""
    begin_s, _ = between_steps_s(evidence, stop.at_s)
    here = evidence.samples(begin_s + 1.1 / evidence.frequency_hz, stop.at_s)
    if not has_source(evidence) or here.start == here.stop:
        return ""
    seen, source = evidence.voltage_positive_pu[here], evidence.sequence_pu("u0", 0)[here]
    if seen.max() - seen.min() <= _A_SWING_PU + source.max() - source.min():
        return ""
    return f"; V+ at the terminals swung between {seen.min():.2f} and {seen.max():.2f} pu, synchronism was lost"
