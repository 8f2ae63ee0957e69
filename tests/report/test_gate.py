"""What a verdict is to a gate, by one rule for the exit status and for every file that CI reads."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.report import gate
from pvlvrt_compliance.report.gate import Outcome
from pvlvrt_compliance.results import Status, Verdict, exit_status
from told import BROKEN, FAILED, IDLE, KNOWN, PASSED, UNJUDGED, WORSE, run_of, test_of

verdicts = st.builds(
    Verdict,
    check=st.sampled_from(["a", "b"]),
    status=st.sampled_from(Status),
    known=st.booleans(),
    worse=st.sampled_from(["", "less"]),
)


@given(tests=st.lists(st.lists(verdicts, min_size=1, max_size=3), max_size=3), allowed=st.booleans())
def test_a_run_is_red_in_every_file_or_ends_with_zero(tests, allowed):
    """The exit status is 0 exactly where nothing of the run stops a gate, whatever baseline and options say."""
    results = run_of(*map(tuple, tests), allow_unjudged=allowed)
    found = gate.told(results)
    red = any(each.outcome in gate.STOPS for each in found) or gate.of_the_run(results, found) is not None
    assert red is (exit_status(results) != 0)


@pytest.mark.parametrize(
    ("verdict", "outcome", "reason"),
    [
        (PASSED, Outcome.PASSED, ""),
        (FAILED, Outcome.FAILURE, FAILED.message),
        (KNOWN, Outcome.SKIPPED, "known failure: waits for the new filter"),
        (KNOWN.model_copy(update={"known_reason": ""}), Outcome.SKIPPED, "known failure"),
        (WORSE, Outcome.FAILURE, "worse than in the baseline: margin +0.050 s, +0.300 s in the baseline"),
        (
            KNOWN.model_copy(update={"worse": "margin"}),
            Outcome.FAILURE,
            f"{FAILED.message}; worse than in the baseline: margin",
        ),
        (UNJUDGED, Outcome.ERROR, UNJUDGED.message),
        (BROKEN, Outcome.ERROR, BROKEN.message),
        (IDLE, Outcome.SKIPPED, IDLE.message),
    ],
)
def test_outcome_and_reason(verdict, outcome, reason):
    """Each verdict with what the baseline says of it is one thing to a gate, for one reason."""
    (told,) = gate.told(run_of((verdict,)))
    assert (told.outcome, told.reason) == (outcome, reason)


def test_worst_comes_first():
    """Errors before failures, of these what is furthest from passing by its share of the limit."""
    near = FAILED.model_copy(update={"check": "near", "measured": 49.0, "margin": -1.0})
    found = gate.worst_first(gate.told(run_of((near, FAILED), (UNJUDGED,), (BROKEN,))))
    assert [each.name for each in found] == ["oscillation", "oscillation", "reactive_support", "near"]
    assert [each.verdict.status for each in found[:2]] == [Status.ERROR, Status.NOT_EVALUATED]


def test_every_test_is_counted_once():
    """A test counts by the worst that it has."""
    counted = gate.tests(run_of((PASSED, IDLE), (PASSED, KNOWN), (KNOWN, FAILED), (UNJUDGED, PASSED)))
    assert counted == (2, 1, 0, 1)
    assert gate.tests(run_of((UNJUDGED, PASSED), allow_unjudged=True)) == (0, 0, 1, 0)
    assert counted.all == 4


def test_names_of_verdicts_are_different():
    """The second verdict of one check has a name of its own."""
    assert [each.name for each in gate.told(run_of((PASSED, PASSED)))] == ["ride_through", "ride_through (2)"]


@pytest.mark.parametrize(
    ("files", "place"),
    [
        ({"controller": "src/ctrl.py", "profiles": {"my-code": "codes/my.toml"}}, "src/ctrl.py"),
        ({"profiles": {"my-code": "codes/my.toml"}}, "codes/my.toml"),
        ({"profiles": {"another": "codes/my.toml"}}, None),
        ({}, None),
    ],
)
def test_where_a_verdict_is_looked_for(files, place):
    """In the controller's file, else in the profile's, as far as they lie in the repository."""
    test = test_of("t", FAILED)
    assert gate.place_of(test, run_of(test, files=files)) == place
