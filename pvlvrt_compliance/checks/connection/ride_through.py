"""The inverter stays connected where envelopes and regions demand it, and its active power comes back."""

from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.checks.connection.demand import Demand, judged_stay
from pvlvrt_compliance.checks.connection.envelopes import Limit, envelope_bands, envelope_limits
from pvlvrt_compliance.checks.connection.regions import region_limits, visits
from pvlvrt_compliance.checks.connection.responses import responses
from pvlvrt_compliance.checks.recovery import judge_recovery
from pvlvrt_compliance.data.marks import Marked, marks_in
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable
from pvlvrt_compliance.profile.requirements import RideThrough
from pvlvrt_compliance.results import Band, Status, Verdict

KIND = "ride_through"


class RideThroughCheck(Check):
    """Judges how long the inverter stays connected, by envelopes and regions of the voltage; then P's return."""

    kind = KIND
    title = "Ride-through of voltage disturbances"
    requirement = RideThrough
    judges_connection = True

    def judge(self, requirement: RideThrough, evidence: Evidence) -> Verdict:
        """Judge connection, what regions ask for besides, and the recovery of the active power.

        Each envelope and each region that applies to the record bounds what must be ridden through; the first that the
        voltage leaves lets the inverter go. Of several verdicts the one with the least margin is reported.

        Raises
        ------
        NotApplicable
            When the inverter tripped in a test that leaves the voltage alone: frequency or angle have their own checks.
        MeasurementError
            When the record does not say whether the breaker is closed, or a voltage or P cannot be measured.
        """
        limits = envelope_limits(requirement, evidence)
        found = []
        if requirement.regions is not None:
            found = visits(requirement.regions, requirement.envelope_tolerance_pu.value, evidence)
            limits += region_limits(requirement.regions, found, evidence)
        release = min(
            (limit.release for limit in limits if limit.release), key=lambda demand: demand.until_s, default=None
        )
        checks = [_judge_connection(requirement, evidence, limits, release)]
        if requirement.regions is not None:
            until_s = None if release is None else release.until_s
            checks += responses(requirement, requirement.regions, found, evidence, until_s)
        return _decisive(checks)

    def limits(self, requirement: RideThrough, evidence: Evidence) -> tuple[Band, ...]:
        """The envelopes that apply to the record."""
        return tuple(envelope_bands(KIND, requirement, evidence))


def _decisive(checks: list[Verdict]) -> Verdict:
    """The failed verdict with the least margin, else the passed one; connection without a time to keep comes last."""
    for wanted in (Status.FAIL, Status.PASS):
        timed = [check for check in checks if check.status is wanted and check.margin]
        if timed:
            return min(timed, key=lambda check: check.margin or 0.0)
    return checks[0]


def _judge_connection(
    requirement: RideThrough, evidence: Evidence, limits: list[Limit], release: Demand | None
) -> Verdict:
    if evidence.disconnected_at_s is not None:
        return _judge_trip(requirement, evidence, evidence.disconnected_at_s, limits, release)
    if release is not None and release.until_s < evidence.disturbance.end_s:
        return _judge_long_sag(requirement, evidence, release)
    if requirement.recovery_fraction is None or requirement.recovery_time_s is None or _is_another_matter(evidence):
        return _throughout(requirement, evidence)
    return judge_recovery(
        KIND,
        requirement,
        evidence,
        from_s=evidence.disturbance.end_s,
        fraction=requirement.recovery_fraction,
        time_s=requirement.recovery_time_s,
        rests_on=[number for _, number in marks_in(requirement)],
        since="clearing",
    )


def _judge_trip(
    requirement: RideThrough, evidence: Evidence, tripped_at_s: float, limits: list[Limit], release: Demand | None
) -> Verdict:
    if release is not None and tripped_at_s >= release.until_s:
        message = f"{release.by} demands {release.stay_s:.3f} s, connected for {tripped_at_s - release.since_s:.2f} s"
        return judged_stay(KIND, requirement, Status.NOT_APPLICABLE, message, release, stopped_at_s=tripped_at_s)
    if _is_another_matter(evidence):
        raise NotApplicable("tripped in a test that leaves the voltage alone")
    demand = _demand(requirement, evidence, tripped_at_s, limits, release)
    begun = "the start" if demand.since_s == evidence.disturbance.start_s else f"{demand.since_s:.3f} s"
    message = f"tripped {tripped_at_s - demand.since_s:.3f} s after {begun}; {demand.by}"
    return judged_stay(KIND, requirement, Status.FAIL, message, demand, stopped_at_s=tripped_at_s)


def _is_another_matter(evidence: Evidence) -> bool:
    """Whether frequency or angle move in this test and the voltage does not."""
    return evidence.disturbance.leaves_voltage_alone


def _demand(
    requirement: RideThrough, evidence: Evidence, tripped_at_s: float, limits: list[Limit], release: Demand | None
) -> Demand:
    """What the inverter broke when it tripped; ``by`` says all of it."""
    grid = evidence.disturbance
    known = [release] if release is not None and release.since_s <= tripped_at_s else []
    if not known and tripped_at_s < grid.end_s:
        known = [demand for limit in limits if (demand := limit.demand_at(tripped_at_s)) is not None]
    ahead = [demand for demand in known if tripped_at_s < demand.until_s < float("inf")]
    if ahead:
        first = min(ahead, key=lambda demand: demand.until_s)
        return first._replace(by=f"{first.by} demands {first.stay_s:.3f} s")
    throughout_s = evidence.waveforms.end_s - grid.start_s
    by = "the voltage stays within what demands connection throughout"
    if not limits:
        by = "the profile has no envelope, so it demands connection throughout"
    elif requirement.regions is None and requirement.envelope_over_voltage is None:
        by = "the voltage stays above the envelope, which demands connection throughout"
    mark: Marked = requirement.envelope or requirement.regions or requirement.envelope_tolerance_pu
    clause = requirement.envelope.clause if requirement.envelope else ""
    return Demand(grid.start_s, throughout_s, by, clause, mark)


def _judge_long_sag(requirement: RideThrough, evidence: Evidence, release: Demand) -> Verdict:
    """A disturbance that lasts longer than what is demanded of it, with the breaker closed throughout."""
    blocked_at_s = evidence.blocked_at_s
    if blocked_at_s is not None and blocked_at_s < release.until_s:
        fed_s = blocked_at_s - evidence.disturbance.start_s
        message = f"bridge blocked {fed_s:.3f} s after the start; {release.by} demands {release.stay_s:.3f} s"
        return judged_stay(KIND, requirement, Status.FAIL, message, release, stopped_at_s=blocked_at_s)
    message = (
        f"connected throughout; of this sag of {evidence.disturbance.duration_s:.3f} s {release.by} demands "
        f"{release.stay_s:.3f} s, so it does not demand recovery"
    )
    last_s = min(evidence.disturbance.end_s, evidence.waveforms.end_s)
    return judged_stay(KIND, requirement, Status.PASS, message, release, stopped_at_s=last_s)


def _throughout(requirement: RideThrough, evidence: Evidence) -> Verdict:
    start_s, end_s = evidence.disturbance.start_s, evidence.waveforms.end_s
    mark: Marked = requirement.envelope or requirement.regions or requirement.envelope_tolerance_pu
    clause = requirement.envelope.clause if requirement.envelope else ""
    demand = Demand(start_s, end_s - start_s, "", clause, mark)
    return judged_stay(KIND, requirement, Status.PASS, "connected throughout", demand, stopped_at_s=end_s)
