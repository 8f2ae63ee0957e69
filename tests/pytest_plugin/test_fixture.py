"""The fixture that judges controllers within a test."""

import pytest

from pvlvrt_compliance import api
from pvlvrt_compliance.pytest_plugin import fixture
from pvlvrt_compliance.results import Status, TestResult, Verdict, conclude

pytest_plugins = ["pytester"]

TEST = """
def test_code(grid_code):
    results = grid_code("iec61400-21", sag="50%", {options})
    assert results.tests
"""


@pytest.fixture
def finding(monkeypatch):
    """What a run comes to: ``finding(*verdicts) -> calls``."""

    def finding(*verdicts):
        calls = []
        test = TestResult(id="a", profile="p", status=max(v.status for v in verdicts), checks=verdicts)

        def check(*profiles, **options):
            calls.append((profiles, options))
            return conclude([test])

        monkeypatch.setattr(fixture, "check", check)
        return calls

    return finding


def test_it_is_check(project, finding):
    """Profiles and options go to the function of the package, and its results come back."""
    assert fixture.check is api.check
    calls = finding(Verdict(check="ride_through", status=Status.PASS))
    project(None, test_code=TEST.format(options="tests='x', scr=20")).assert_outcomes(passed=1)
    assert calls == [(("iec61400-21",), {"sag": "50%", "tests": "x", "scr": 20})]


def test_it_fails_the_test(project, finding):
    """By itself, with the verdicts, at the line of the test: nobody has to remember an assertion."""
    finding(Verdict(check="ride_through", status=Status.FAIL, message="opened at 0.6 s", margin=-0.2, unit="s"))
    ended = project(None, test_code=TEST.format(options=""))
    ended.assert_outcomes(failed=1)
    ended.stdout.fnmatch_lines(
        [
            '>   *results = grid_code("iec61400-21", sag="50%"*',
            "E * ride_through fail",
            "E * p.a, ride_through: opened at 0.6 s",
        ]
    )
    assert "fixture.py" not in ended.stdout.str()


@pytest.mark.parametrize("status", [Status.NOT_EVALUATED, Status.ERROR, Status.NOT_APPLICABLE])
def test_what_was_not_judged_is_not_passed(project, finding, status):
    """Nothing shown is nothing passed, as with the command."""
    finding(Verdict(check="ride_through", status=status))
    project(None, test_code=TEST.format(options="")).assert_outcomes(failed=1)


def test_it_may_only_look(project, finding):
    """With must_pass=False a test looks at the results itself, for instance at what is to fail."""
    finding(Verdict(check="ride_through", status=Status.FAIL))
    project(None, test_code=TEST.format(options="must_pass=False")).assert_outcomes(passed=1)
