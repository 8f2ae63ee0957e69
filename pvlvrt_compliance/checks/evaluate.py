"""One record against one profile: every requirement becomes a verdict, whatever the record is like."""

from collections.abc import Iterable

from pvlvrt_compliance.checks.evidence import Evidence, NotApplicable
from pvlvrt_compliance.checks.judging import in_words, judge_safely
from pvlvrt_compliance.checks.registry import Judge, find_judge
from pvlvrt_compliance.checks.results import Check, ProfileSummary, Status, TestResult, worst
from pvlvrt_compliance.checks.validity import reason_not_to_count
from pvlvrt_compliance.checks.verdicts import unjudged
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.quantities import Measurements
from pvlvrt_compliance.measure.summary import measure
from pvlvrt_compliance.measure.windows import STANDARD_RULES, WindowRules
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.profile.requirements import Requirement
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Waveforms

CONNECTION_KINDS = ("ride_through", "frequency_ride_through", "phase_jump_ride_through")
"""Kinds that judge whether the inverter may stop; all others have nothing to say of one that did."""

REPEATED_RUNS = "repeated_runs"
"""Kind that judges all runs of a row together, not one record."""


def evaluate(
    profile: Profile, test: TestCase, waveforms: Waveforms, nominal: Nominal, available_power_w: float
) -> TestResult:
    """Judge one record by every requirement of a profile.

    Parameters
    ----------
    profile : Profile
        What is demanded.
    test : TestCase
        What was applied; its scenario's times count from the start of the record.
    waveforms : Waveforms
        The record, simulated or measured.
    nominal : Nominal
        Base of the per-unit values.
    available_power_w : float
        What the PV array could give before the sag (W).

    Returns
    -------
    TestResult
        A verdict on each requirement; what cannot be measured is `not_evaluated` with the reason, nothing is raised.
    """
    evidence = collect(profile, test, waveforms, nominal, available_power_w)
    checks = _judge_all(profile, test, evidence)
    return _result(profile, test, checks, evidence.measurements, waveforms.end_s - waveforms.t0_s)


def errored(profile: Profile, test: TestCase, reason: str) -> TestResult:
    """Result of a test that gave no waveforms to judge: every requirement is an `error` with the reason."""
    checks = [unjudged(kind, requirement, Status.ERROR, reason) for kind, requirement in demands_of(profile, test)]
    return _result(profile, test, checks, Measurements(), 0.0)


def summarise(profile: Profile, tests: Iterable[TestCase], left_out: Iterable[TestCase] = ()) -> ProfileSummary:
    """The profile as a report on these tests shows it, with what is not verified and what was left out."""
    return ProfileSummary(
        id=profile.id,
        title=profile.title,
        digest=profile.digest,
        notes=profile.unverified({test.id for test in tests}),
        left_out=tuple(test.id for test in left_out),
    )


def collect(
    profile: Profile, test: TestCase, waveforms: Waveforms, nominal: Nominal, available_power_w: float
) -> Evidence:
    """Measure a record and put it together with what is known about its test; parameters as `evaluate`."""
    rules = window_rules(profile)
    scenario = test.scenario
    return Evidence(
        waveforms=waveforms,
        nominal=nominal,
        scenario=scenario,
        available_power_w=available_power_w,
        measurements=measure(waveforms, nominal, scenario.start_s, scenario.clear_s, rules),
        rules=rules,
        blocked_below_pu=profile.conditions.blocked_below_pu.value,
        k_factor=test.k_factor,
        detection=profile.detection,
        requirements=profile.requirements,
    )


def window_rules(profile: Profile) -> WindowRules:
    """The profile's measurement windows, or the standard ones."""
    if profile.windows is None:
        return STANDARD_RULES
    return WindowRules(**{name: number.value for name, number in profile.windows})


def demands_of(profile: Profile, test: TestCase) -> list[tuple[str, Requirement]]:
    """Each requirement that a record of this test is judged by, with its kind."""
    of_a_record = ((kind, demand) for kind, demand in profile.requirements.by_kind() if kind != REPEATED_RUNS)
    return [(kind, demand) for kind, demand in of_a_record if test.judges(kind)]


def _judge_all(profile: Profile, test: TestCase, evidence: Evidence) -> list[Check]:
    demands = demands_of(profile, test)
    try:
        reason = reason_not_to_count(profile.conditions, evidence)
    except MeasurementError as error:
        reason = str(error)
    if reason is not None:
        return [unjudged(kind, requirement, Status.NOT_EVALUATED, reason) for kind, requirement in demands]
    return [_judge(kind, requirement, evidence) for kind, requirement in demands]


def _judge(kind: str, requirement: Requirement, evidence: Evidence) -> Check:
    try:
        judge = find_judge(kind)
    except Exception as error:
        return unjudged(kind, requirement, Status.ERROR, f"the check could not be loaded: {in_words(error)}")
    if judge is None:
        reason = f"no installed package has a check for the requirement {kind!r}"
        return unjudged(kind, requirement, Status.NOT_EVALUATED, reason)
    return judge_safely(kind, _unless_stopped(kind, judge), requirement, evidence)


def _unless_stopped(kind: str, judge: Judge) -> Judge:
    """The judge, but for the verdict on an inverter that stopped for good: that is of the connection alone."""
    if kind in CONNECTION_KINDS:
        return judge

    def judge_what_runs(requirement: Requirement, evidence: Evidence) -> Check:
        if (stop := _stop(evidence)) is not None:
            raise NotApplicable(stop)
        return judge(requirement, evidence)

    return judge_what_runs


def _stop(evidence: Evidence) -> str | None:
    """How the inverter stopped feeding for good, None when it did not; what stopped is judged by ride-through alone."""
    start_s = evidence.scenario.start_s
    if evidence.is_switched and evidence.disconnected_at_s is not None:
        return f"tripped {evidence.disconnected_at_s - start_s:.3f} s after the start"
    if evidence.blocked_at_s is not None:
        return f"bridge blocked {evidence.blocked_at_s - start_s:.3f} s after the start"
    return None


def _result(
    profile: Profile, test: TestCase, checks: list[Check], measurements: Measurements, duration_s: float
) -> TestResult:
    return TestResult(
        id=test.id,
        profile=profile.id,
        title=test.title,
        scenario=test.scenario.model_dump(mode="json"),
        status=worst(check.status for check in checks),
        checks=tuple(checks),
        measurements=measurements,
        clause=test.clause,
        confidence=test.confidence,
        duration_s=duration_s,
    )
