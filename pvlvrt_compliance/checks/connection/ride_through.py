"""The inverter stays connected where envelopes and regions demand it, and its active power comes back."""

from collections.abc import Iterator

from pvlvrt_compliance.checks.check import Check, decisive, nearest
from pvlvrt_compliance.checks.connection.demand import Demand, judged_stay
from pvlvrt_compliance.checks.connection.envelopes import envelope_bands
from pvlvrt_compliance.checks.connection.feeding import least_current, without_current
from pvlvrt_compliance.checks.connection.letting_go import stop_of
from pvlvrt_compliance.checks.connection.recoveries import judged_recovery, recovery_bands
from pvlvrt_compliance.checks.connection.regions import Visit, region_bands, visits
from pvlvrt_compliance.checks.connection.release import Limits, limits_of, released_at_s
from pvlvrt_compliance.checks.connection.responses import responses
from pvlvrt_compliance.checks.connection.trips import judged_trip
from pvlvrt_compliance.checks.verdicts import judged_at_most
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable
from pvlvrt_compliance.evidence.stretches import name_at
from pvlvrt_compliance.profile.requirements import RideThrough
from pvlvrt_compliance.results import Band, Status, Verdict

KIND = "ride_through"


class RideThroughCheck(Check):
    """Judges how long the inverter stays connected and feeds, by the limits of the voltage; then P's return."""

    kind = KIND
    title = "Ride-through of voltage disturbances"
    requirement = RideThrough
    judges_connection = True

    def judge(self, requirement: RideThrough, evidence: Evidence) -> Verdict:
        """Judge connection, feeding, what regions ask for besides, and the recovery of the active power.

        Envelopes and regions let the inverter go by the voltage without its current; a row of a test table that does
        not say otherwise is ridden through as a whole. A trip in a normal grid fails in every test. Of several verdicts
        a failed one is reported, with the least margin; the message names the others that failed.

        Raises
        ------
        NotApplicable
            When the code demands nothing of the disturbance, or frequency or angle decide, which their checks judge.
        MeasurementError
            When the record does not say whether the breaker is closed, or a voltage, a current or P cannot be measured;
            when the inverter let go and the profile is silent on what had moved.
        """
        limits = limits_of(requirement, evidence)
        others = list(_besides(requirement, evidence, limits))
        try:
            connection = _connection(requirement, evidence, limits)
        except NotApplicable:
            if not others:
                raise
            return _reported(others)
        return _reported([connection, *others])

    def released_at_s(self, requirement: RideThrough, evidence: Evidence) -> float | None:
        """When the limits of the voltage do; of a row that is ridden through as a whole, not before it is over."""
        return released_at_s(requirement, evidence)

    def limits(self, requirement: RideThrough, evidence: Evidence) -> tuple[Band, ...]:
        """The envelopes and the regions that apply to the record, and the power that must be back."""
        regions = [] if requirement.regions is None else region_bands(KIND, requirement, evidence)
        recovery = () if stop_of(evidence) is not None else recovery_bands(KIND, requirement, evidence)
        return (*regions, *envelope_bands(KIND, requirement, evidence), *recovery)


def _reported(verdicts: list[Verdict]) -> Verdict:
    """The worst failed verdict, with what else failed; else the passed time with the least margin."""
    failed = [verdict for verdict in verdicts if verdict.status is Status.FAIL]
    if failed:
        worst = decisive(failed)
        also = "; also: ".join(verdict.message for verdict in failed if verdict is not worst)
        return worst.model_copy(update={"message": f"{worst.message}; also: {also}"}) if also else worst
    times = [verdict for verdict in verdicts if verdict.unit == "s"]
    return nearest(times or verdicts, lambda verdict: verdict.margin or 0.0)


def _connection(requirement: RideThrough, evidence: Evidence, limits: Limits) -> Verdict:
    stop = stop_of(evidence)
    if stop is not None:
        return judged_trip(requirement, evidence, limits, stop)
    release = limits.release
    if release is not None and release.until_s < evidence.disturbance.end_s and evidence.expect != "ride_through":
        return _released(requirement, evidence, release)
    found = judged_recovery(KIND, requirement, evidence)
    if found is not None:
        return found
    demand = limits.whole(evidence)
    message = f"connected throughout, through all of the {demand.stay_s:.3f} s of the disturbance"
    end_s = max(evidence.record_end_s, demand.until_s)
    return judged_stay(KIND, requirement, Status.PASS, message, demand, stopped_at_s=end_s)


def _released(requirement: RideThrough, evidence: Evidence, release: Demand) -> Verdict:
    """A disturbance that lasts longer than what is demanded of it, with the breaker closed throughout."""
    lasts_s = evidence.disturbance.end_s - evidence.disturbance.start_s
    if release.stay_s <= 0:
        raise NotApplicable(f"{release.by} demands nothing of this disturbance of {lasts_s:.3f} s")
    message = (
        f"connected throughout; of this disturbance of {lasts_s:.3f} s {release.in_words}, so it does not demand"
        " recovery"
    )
    last_s = min(evidence.disturbance.end_s, evidence.waveforms.end_s)
    return judged_stay(KIND, requirement, Status.PASS, message, release, stopped_at_s=last_s)


def _besides(requirement: RideThrough, evidence: Evidence, limits: Limits) -> Iterator[Verdict]:
    """What is asked for besides connection, as long as that is demanded."""
    ends_s = (evidence.record_end_s, evidence.known_opening_s, evidence.released_at_s)
    until_s = min(t for t in ends_s if t is not None)
    terminals: list[Visit] = []
    table = requirement.regions
    if table is not None:
        terminals = visits(table, requirement.envelope_tolerance_pu.value, evidence, "terminals")
        yield from responses(requirement, table, terminals, limits.visits, evidence)
        found = least_current(requirement, table, terminals, limits.visits, evidence, until_s)
        yield from (_named(verdict, evidence) for verdict in found)
    missing = without_current(requirement, [*terminals, *limits.visits], evidence, until_s)
    yield from (_named(verdict, evidence) for verdict in missing)
    if evidence.by_s is not None:
        yield _open_in_time(requirement, evidence, evidence.by_s)


def _named(verdict: Verdict, evidence: Evidence) -> Verdict:
    """The verdict with the stretch that it speaks of, in a record of several."""
    name = name_at(evidence, verdict.at_s or 0.0)
    text = f"{name}: {verdict.message}" if name else verdict.message
    return verdict.model_copy(update={"stretch": name, "message": text})


def _open_in_time(requirement: RideThrough, evidence: Evidence, by_s: float) -> Verdict:
    start_s, opened_s = evidence.disturbance.start_s, evidence.disconnected_at_s
    took_s = (evidence.record_end_s if opened_s is None else opened_s) - start_s
    came = "the breaker stayed closed" if opened_s is None else f"the breaker opened after {took_s:.3f} s"
    return judged_at_most(
        KIND,
        requirement,
        f"{came}; the test demands that it is open after {by_s:.3f} s",
        measured=took_s,
        limit=by_s,
        unit="s",
        at_s=start_s + by_s,
        rests_on=(requirement.envelope_tolerance_pu,),
        uncertainty=evidence.thresholds.uncertainty_instant_s.value,
    )
