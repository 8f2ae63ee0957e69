"""One record against one profile: every requirement becomes a verdict, whatever the record is like."""

from collections.abc import Callable

from pvlvrt_compliance.checks.check import Check, RowCheck
from pvlvrt_compliance.checks.judging import in_words, judge_safely, limits_safely
from pvlvrt_compliance.checks.registry import find_check
from pvlvrt_compliance.checks.validity import reason_not_to_count
from pvlvrt_compliance.checks.verdicts import unjudged
from pvlvrt_compliance.disturbance.model import Disturbance
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.collect import collect, disturbance_of
from pvlvrt_compliance.evidence.cursors import cursors_of
from pvlvrt_compliance.evidence.evidence import Evidence, after_trip
from pvlvrt_compliance.evidence.instruments import BY_DEFINITION, Instruments
from pvlvrt_compliance.measure.quantities import MeasuredWindows
from pvlvrt_compliance.measure.silence import SILENT
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.profile.requirements import Requirement
from pvlvrt_compliance.results import (
    Band,
    Characteristic,
    Drawn,
    Instant,
    Rating,
    Spectrum,
    Status,
    TestResult,
    Verdict,
    worst,
)
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Waveforms

_FIELDS: dict[str, type[Drawn]] = {
    "bands": Band,
    "spectra": Spectrum,
    "characteristics": Characteristic,
    "instants": Instant,
}
"""Where a result has what is drawn."""

_JUDGED = (Status.PASS, Status.FAIL)
_OF_ONE_SAG = 2  # stretches: the sag, and what follows it


def evaluate(
    profile: Profile,
    test: TestCase,
    waveforms: Waveforms,
    nominal: Nominal,
    available_power_w: float,
    disturbance: Disturbance | None = None,
) -> TestResult:
    """Judge one record by every requirement of a profile.

    Parameters
    ----------
    profile : Profile
        What is demanded.
    test : TestCase
        What was applied.
    waveforms : Waveforms
        The record, simulated or measured.
    nominal : Nominal
        Base of the per-unit values.
    available_power_w : float
        What the PV array could give before the disturbance (W).
    disturbance : Disturbance, optional
        What the grid did; by default what the test's scenario asks of it.

    Returns
    -------
    TestResult
        A verdict on each requirement; what cannot be measured is `not_evaluated` with the reason, nothing is raised.
    """
    evidence = evidence_of(profile, test, waveforms, nominal, available_power_w, disturbance)
    try:
        return judge_record(profile, test, evidence)
    finally:
        evidence.forget()  # else the record stays in memory until the interpreter looks for what nobody needs


@SILENT
def evidence_of(
    profile: Profile,
    test: TestCase,
    waveforms: Waveforms,
    nominal: Nominal,
    available_power_w: float,
    disturbance: Disturbance | None = None,
    instruments: Instruments = BY_DEFINITION,
) -> Evidence:
    """What `evaluate` judges one record by; the parameters are its own, and what series are measured with."""
    release = _release(profile)
    return collect(profile, test, waveforms, nominal, available_power_w, disturbance, release, instruments)


@SILENT
def judge_record(profile: Profile, test: TestCase, evidence: Evidence) -> TestResult:
    """Judge the evidence of one record by every requirement of a profile, as `evaluate` does."""
    verdicts, drawn = _judge_all(profile, test, evidence)
    result = _result(profile, test, verdicts, evidence.disturbance)
    nominal, waveforms = evidence.nominal, evidence.waveforms
    found = {
        **{name: tuple(one for one in drawn if isinstance(one, kind)) for name, kind in _FIELDS.items()},
        "measurements": _measurements(evidence),
        "cursors": cursors_of(evidence, {one.quantity for one in drawn if isinstance(one, Band)}),
        "duration_s": waveforms.end_s - waveforms.t0_s,
        "trip_cause": evidence.trip_cause,
        "rating": Rating(
            apparent_power_kva=nominal.apparent_power_kva,
            phase_voltage_v=nominal.phase_voltage_v,
            frequency_hz=nominal.frequency_hz,
        ),
        "available_power_kw": evidence.available_power_w / 1e3,
    }
    return result.model_copy(update=found)


def _measurements(evidence: Evidence) -> MeasuredWindows:
    """The windows of the (first) sag, and where the voltage has further steps those of each stretch."""
    if len(evidence.voltage_stretches) <= _OF_ONE_SAG:
        return evidence.measurements
    try:
        stretches = evidence.measured_stretches
    except MeasurementError:  # no frequency to count cycles of
        return evidence.measurements
    return evidence.measurements.model_copy(update={"stretches": stretches})


def errored(profile: Profile, test: TestCase, reason: str) -> TestResult:
    """Result of a test that gave no waveforms to judge: every requirement is an `error` with the reason."""
    verdicts = [unjudged(kind, requirement, Status.ERROR, reason) for kind, requirement in demands_of(profile, test)]
    return _result(profile, test, verdicts, disturbance_of(profile, test))


def demands_of(profile: Profile, test: TestCase) -> list[tuple[str, Requirement]]:
    """Each requirement that a record of this test is judged by, with its kind."""
    return [
        (kind, demand) for kind, demand in profile.requirements.by_kind() if test.judges(kind) and not _of_rows(kind)
    ]


def _of_rows(kind: str) -> bool:
    try:
        return isinstance(find_check(kind), RowCheck)
    except Exception:  # a check that cannot be loaded is told where its record is judged
        return False


def _release(profile: Profile) -> Callable[[Evidence], float | None]:
    """What says when the connection is no longer demanded: the first check of it that lets the inverter go."""
    judges = _judges_of_connection(profile)

    def first(evidence: Evidence) -> float | None:
        found = [check.released_at_s(demand, evidence) for _, demand, check in judges]
        return min((at_s for at_s in found if at_s is not None), default=None)

    return first


def _judges_of_connection(profile: Profile) -> list[tuple[str, Requirement, Check]]:
    found = []
    for kind, demand in profile.requirements.by_kind():
        try:
            check = find_check(kind)
        except Exception:  # a check that cannot be loaded is told where its record is judged
            continue
        if check is not None and check.judges_connection:
            found.append((kind, demand, check))
    return found


def _judge_all(profile: Profile, test: TestCase, evidence: Evidence) -> tuple[list[Verdict], tuple[Drawn, ...]]:
    demands = demands_of(profile, test)
    try:
        reason = reason_not_to_count(profile.conditions, evidence)
    except MeasurementError as error:
        reason = str(error)
    if reason is not None:
        return [unjudged(kind, demand, Status.NOT_EVALUATED, reason) for kind, demand in demands], ()
    demands += _left_out_connection(profile, demands, evidence)
    judged = [_judge(kind, requirement, evidence) for kind, requirement in demands]
    verdicts = [verdict for verdict, _ in judged]
    if test.expect != "may_trip" and test.only is None:  # what nobody asked for may well have been judged
        verdicts = _not_let_off_altogether(verdicts)
    return verdicts, tuple(one for _, drawn in judged for one in drawn)


def _left_out_connection(
    profile: Profile, demands: list[tuple[str, Requirement]], evidence: Evidence
) -> list[tuple[str, Requirement]]:
    """Checks of the connection that a row leaves out, where the inverter let go: that is judged in every test."""
    if _stop(evidence) is None:
        return []
    kept = {kind for kind, _ in demands}
    return [(kind, demand) for kind, demand, _ in _judges_of_connection(profile) if kind not in kept]


def _not_let_off_altogether(verdicts: list[Verdict]) -> list[Verdict]:
    """A test in which nothing at all was judged is no evidence: its first verdict says so."""
    if not verdicts or any(verdict.status is not Status.NOT_APPLICABLE for verdict in verdicts):
        return verdicts
    first = verdicts[0]
    message = f"nothing in this test was judged; {first.message}"
    return [first.model_copy(update={"status": Status.NOT_EVALUATED, "message": message}), *verdicts[1:]]


def _judge(kind: str, requirement: Requirement, evidence: Evidence) -> tuple[Verdict, tuple[Drawn, ...]]:
    """The verdict, and what a figure draws beside it."""
    try:
        check = find_check(kind)
    except Exception as error:
        return unjudged(kind, requirement, Status.ERROR, f"the check could not be loaded: {in_words(error)}"), ()
    if check is None:
        reason = f"no installed package has a check for the requirement {kind!r}"
        return unjudged(kind, requirement, Status.NOT_EVALUATED, reason), ()
    if not (check.judges_connection or check.judges_up_to_trip) and (stop := _stop(evidence)) is not None:
        return unjudged(kind, requirement, Status.NOT_APPLICABLE, stop), ()
    return _with_limits(check, requirement, evidence)


def _with_limits(check: Check, requirement: Requirement, evidence: Evidence) -> tuple[Verdict, tuple[Drawn, ...]]:
    verdict = judge_safely(check, requirement, evidence)
    return verdict, limits_safely(check, requirement, evidence) if verdict.status in _JUDGED else ()


def _stop(evidence: Evidence) -> str | None:
    """How the inverter let go, None when it did not, or nobody can say."""
    try:
        opened_s = evidence.known_opening_s
    except MeasurementError:  # whoever judges the connection says so
        return None
    if opened_s is None:
        return None
    cause = f" by the {evidence.trip_cause}" if evidence.trip_cause else ""
    return f"{after_trip(opened_s)}{cause}"


def _result(profile: Profile, test: TestCase, verdicts: list[Verdict], disturbance: Disturbance) -> TestResult:
    return TestResult(
        id=test.id,
        profile=profile.id,
        title=test.title,
        scenario=test.scenario.model_dump(mode="json"),
        disturbance=disturbance,
        expect=test.expect,
        by_s=test.by_s,
        k_factor=test.k_factor,
        status=worst(verdict.status for verdict in verdicts),
        checks=tuple(verdicts),
        clause=test.clause,
        confidence=test.confidence,
    )
