"""Runs of a row, judged together: consecutive runs, second chances, and runs that were not selected."""

import pytest

from pvlvrt_compliance.profile import TestCase
from pvlvrt_compliance.results import Status, TestResult, Verdict, worst
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.study.rows import points_between, run_rows
from pvlvrt_compliance.study.run import Judged


def with_rule(profile, consecutive, after_trip=None):
    """A profile with nothing but a rule of repeated runs."""
    number = lambda value: {"value": value, "confidence": "memory", "source": "a test"}  # noqa: E731
    rule = {"clause": "6.1", "source": "a test", "consecutive": number(consecutive)}
    if after_trip is not None:
        rule["consecutive_after_trip"] = number(after_trip)
    return type(profile).model_validate(
        profile.model_dump(by_alias=True) | {"requirements": {"repeated_runs": rule}, "tests": ()}
    )


def row(name, count, **fields):
    """Runs of a row at angles 0, 30, 60 ..."""
    scenarios = [Scenario(sag=Sag(depth=0.5), duration_s=0.3, point_on_wave_deg=30.0 * k) for k in range(count)]
    return [
        TestCase(id=f"{name}-{k}", title=f"{name}, 0 deg", scenario=scenario, row=name, **fields)
        for k, scenario in enumerate(scenarios, start=1)
    ]


def outcomes(profile, cases, verdicts):
    """Run rows whose connection is judged as told, by the number of the call; others pass."""
    asked = []

    def judge_one(case):
        asked.append(case)
        status = verdicts.get(len(asked), Status.PASS)
        checks = (Verdict(check="ride_through", status=status), Verdict(check="dc_ripple", status=Status.PASS))
        result = TestResult(id=case.id, status=worst(c.status for c in checks), checks=checks)
        return Judged(result, None)

    return [judged.result for _, judged in run_rows(profile, cases, judge_one)], asked


def verdict(results):
    """The one verdict on repeated runs; it stands with the last run."""
    found = [check for result in results for check in result.checks if check.check == "repeated_runs"]
    assert len(found) == 1
    assert results[-1].checks[-1] is found[0]
    return found[0]


@pytest.mark.parametrize(
    ("verdicts", "status", "ridden"),
    [({}, Status.PASS, 2), ({1: Status.FAIL}, Status.FAIL, 1), ({1: Status.FAIL, 2: Status.FAIL}, Status.FAIL, 0),
     ({2: Status.NOT_APPLICABLE}, Status.PASS, 2)],
)  # fmt: skip
def test_two_runs_one_after_the_other(profile, verdicts, status, ridden):
    """Without a second chance any run that is not ridden through fails the row."""
    results, asked = outcomes(with_rule(profile, 2), row("U5", 2), verdicts)
    check = verdict(results)
    assert (check.status, check.measured, check.limit, check.margin) == (status, ridden, 2, ridden - 2)
    assert (check.clause, check.confidence, check.unit) == ("6.1", "memory", "runs")
    assert results[-1].status is worst([status, results[-1].checks[0].status])
    assert len(asked) == 2


@pytest.mark.parametrize(
    ("verdicts", "status", "runs"),
    [
        ({}, Status.PASS, 3),
        ({2: Status.FAIL}, Status.PASS, 7),
        ({2: Status.FAIL, 7: Status.FAIL}, Status.FAIL, 7),
        ({2: Status.FAIL, 4: Status.FAIL}, Status.FAIL, 4),
        ({1: Status.FAIL, 3: Status.FAIL}, Status.FAIL, 3),
        ({3: Status.FAIL, 5: Status.NOT_EVALUATED}, Status.NOT_EVALUATED, 5),
        ({1: Status.FAIL, 2: Status.ERROR}, Status.NOT_EVALUATED, 3),
    ],
)
def test_three_runs_and_four_after_a_trip(profile, verdicts, status, runs):
    """One run of three that trips asks for four more, which must all be ridden through; two have failed the row."""
    results, asked = outcomes(with_rule(profile, 3, 4), row("1", 3), verdicts)
    assert len(asked) == len(results) == runs
    assert verdict(results).status is status
    assert [result.id for result in results] == [case.id for case in asked]


def test_a_run_that_is_let_off(profile):
    """The run that tripped no longer fails once all further runs are ridden through, and says why."""
    results, _ = outcomes(with_rule(profile, 3, 4), row("1", 3), {1: Status.FAIL})
    assert worst(result.status for result in results) is Status.PASS
    assert results[0].checks[0].status is Status.NOT_APPLICABLE
    assert "let off" in results[0].checks[0].message
    failed, _ = outcomes(with_rule(profile, 3, 4), row("1", 3), {1: Status.FAIL, 7: Status.FAIL})
    assert failed[0].status is Status.FAIL


def test_further_runs_are_at_other_points_on_wave(profile):
    """Further runs lie between the angles of the row's own and have names of their own."""
    _, asked = outcomes(with_rule(profile, 3, 4), row("1", 3), {1: Status.FAIL})
    own, further = asked[:3], asked[3:]
    angles = [case.scenario.point_on_wave_deg for case in further]
    assert len({case.id for case in asked}) == 7
    assert set(angles).isdisjoint(case.scenario.point_on_wave_deg for case in own)
    assert angles == [120, 180, 240, 300]


@pytest.mark.parametrize(
    ("own", "count", "between"),
    [([0], 1, [180]), ([0], 3, [90, 180, 270]), ([0, 180], 2, [90, 270]), ([0, 90, 180, 270], 4, [45, 135, 225, 315]),
     ([0, 0], 1, [180]), ([-90, 90], 2, [0, 180]), ([30], 0, [])],
)  # fmt: skip
def test_points_between(own, count, between):
    """Gaps are divided evenly, the widest first, around the whole cycle."""
    assert points_between(own, count) == between


def test_fewer_runs_than_the_code_wants(profile):
    """A row of which only some runs were selected is not judged as a row."""
    results, asked = outcomes(with_rule(profile, 3, 4), row("1", 2), {1: Status.FAIL})
    check = verdict(results)
    assert check.status is Status.NOT_APPLICABLE
    assert check.message == "the code wants 3 runs one after the other, 2 selected"
    assert len(asked) == 2


def test_each_row_alone(profile):
    """Rows are judged one by one, in order; a test of the user's own belongs to none."""
    own = row("x", 1)[0].model_copy(update={"row": ""})
    results, asked = outcomes(with_rule(profile, 2), [*row("1", 2), own, *row("2", 2)], {4: Status.FAIL})
    found = {result.id: result.checks[-1].status for result in results if result.checks[-1].check == "repeated_runs"}
    assert found == {"1-2": Status.PASS, "2-2": Status.FAIL}
    assert [result.id for result in results] == [case.id for case in asked]


def test_rows_that_are_not_judged_by_it(profile):
    """A row may name its checks, and a profile may have no such rule."""
    for made, fields in ((with_rule(profile, 2), {"checks": ("ride_through",)}), (profile, {})):
        results, _ = outcomes(made, row("1", 2, **fields), {})
        assert all(check.check != "repeated_runs" for result in results for check in result.checks)


def test_runs_are_handed_out_as_they_are_done(profile):
    """Results do not wait for the row to end, unless one failed that may be let off."""
    done = []

    def judge_one(case):
        done.append(case.id)
        return Judged(TestResult(id=case.id, status=Status.PASS), None)

    for (case, _), expected in zip(run_rows(with_rule(profile, 2), row("1", 3), judge_one), (1, 2, 3), strict=True):
        assert len(done) == expected, case.id


def test_a_row_of_which_only_some_checks_are_asked_for(profile):
    """The rule lets a run off all the same; its own verdict is told where it is asked for."""
    made = with_rule(profile, 3, 4)
    whole, _ = outcomes(made, row("1", 3), {1: Status.FAIL})
    for only, told in ((("dc_ripple",), False), (("repeated_runs", "ride_through"), True)):
        results, asked = outcomes(made, row("1", 3, only=only), {1: Status.FAIL})
        assert len(asked) == 7
        assert results[0].checks == whole[0].checks
        assert ("repeated_runs" in [check.check for check in results[-1].checks]) is told
