"""Whether a verdict is better or worse than an earlier one."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.results import Results, Status, TestResult, Verdict
from pvlvrt_compliance.results.changes import BEST_FIRST, Change, Earlier, Key, by_key, change_of, margin_lost


def verdict(status=Status.PASS, margin=1.0, limit=10.0, **more):
    """A verdict with a margin, in kvar."""
    return Verdict(check="x", status=status, margin=margin, limit=limit, unit="kvar", **more)


def test_the_order_names_every_status():
    """No verdict is without a place."""
    assert set(BEST_FIRST) == set(Status)


@pytest.mark.parametrize(
    ("before", "now", "change"),
    [
        (Status.PASS, Status.FAIL, Change.WORSE),
        (Status.FAIL, Status.PASS, Change.BETTER),
        (Status.PASS, Status.NOT_APPLICABLE, Change.WORSE),
        (Status.NOT_APPLICABLE, Status.FAIL, Change.WORSE),
        (Status.FAIL, Status.NOT_EVALUATED, Change.WORSE),
        (Status.NOT_EVALUATED, Status.ERROR, Change.WORSE),
        (Status.ERROR, Status.FAIL, Change.BETTER),
        (Status.FAIL, Status.FAIL, Change.SAME),
    ],
)
def test_a_verdict_decides_before_its_margin(before, now, change):
    """Another verdict is better or worse whatever the margins are."""
    assert change_of(Earlier(before, 5.0, "kvar"), verdict(now, margin=5.0), 0.0) is change


@pytest.mark.parametrize(
    ("margin", "change"), [(0.49, Change.WORSE), (0.51, Change.SAME), (1.49, Change.SAME), (1.51, Change.BETTER)]
)
def test_a_margin_counts_beyond_the_tolerance(margin, change):
    """5 % of a limit of 10 kvar are 0.5 kvar, either way."""
    assert change_of(Earlier(Status.PASS, 1.0, "kvar"), verdict(margin=margin), 0.05) is change


def test_without_a_tolerance_only_verdicts_count():
    """A margin that is lost is none where nobody asks for margins."""
    assert change_of(Earlier(Status.FAIL, -1.0, "kvar"), verdict(Status.FAIL, margin=-9.0)) is Change.SAME


@given(st.floats(-100, 100), st.floats(-100, 100), st.floats(0, 1))
def test_better_and_worse_are_each_others_opposite(one, other, tolerance):
    """Seen from the other side worse is better."""
    there = change_of(Earlier(Status.PASS, one, "kvar"), verdict(margin=other), tolerance)
    back = change_of(Earlier(Status.PASS, other, "kvar"), verdict(margin=one), tolerance)
    opposite = {Change.WORSE: Change.BETTER, Change.BETTER: Change.WORSE, Change.SAME: Change.SAME}
    assert back is opposite[there]


@pytest.mark.parametrize(
    "now", [verdict(margin=None), verdict(limit=None), verdict().model_copy(update={"unit": "kW"})]
)
def test_what_cannot_be_compared_is_not(now):
    """Without a margin, a scale or a common unit there is no loss."""
    assert margin_lost(Earlier(Status.PASS, 1.0, "kvar"), now) is None


def test_a_limit_of_nothing_is_measured_by_its_tolerance():
    """A demand of 0 kW, within 10 kW, loses by shares of 10 kW."""
    assert margin_lost(Earlier(Status.PASS, 9.0, "kvar"), verdict(margin=4.0, limit=0.0, tolerance=10.0)) == 0.5


def test_verdicts_of_one_check_are_numbered():
    """Two verdicts of one check are told apart as in junit.xml; a test without any has its own."""
    one = TestResult(id="a", profile="p", status=Status.PASS, checks=(verdict(), verdict(Status.FAIL)))
    none = TestResult(id="b", profile="p", status=Status.ERROR)
    found = by_key(Results(status=Status.ERROR, tests=(one, none)))
    assert list(found) == [Key("p.a", "x"), Key("p.a", "x (2)"), Key("p.b", "test")]
    assert found[Key("p.b", "test")].status is Status.ERROR
