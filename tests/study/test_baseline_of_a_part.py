"""A run of some checks or tests, held against the baseline of a whole one."""

import pytest

from pvlvrt_compliance.results import ProfileSummary, Status, TestResult, Verdict, conclude
from pvlvrt_compliance.study.baseline.applying import Held, held_against
from pvlvrt_compliance.study.baseline.entries import Baseline
from pvlvrt_compliance.study.baseline.reading import BaselineFile
from pvlvrt_compliance.study.baseline.updating import updated

KNOWN = ("current_limit", "dc_ripple")


def run(*failed, selected=()):
    """A run of one test in which these checks failed; with ``selected``, of these checks alone."""
    checks = tuple(Verdict(check=kind, status=Status.FAIL) for kind in failed)
    test = TestResult(id="one", profile="code", status=Status.FAIL, checks=checks)
    return conclude([test], [ProfileSummary(id="code", title="", digest="", selected_checks=selected)])


@pytest.fixture
def baseline():
    """Of a whole run: two checks failed."""
    return updated(Baseline({}), run(*KNOWN)).baseline


def held(results, baseline):
    """What the baseline says of a run."""
    return held_against(results, Held(BaselineFile("file", "0", baseline), 0.01), lambda _: False)


def test_a_check_that_was_not_selected_is_not_gone(baseline):
    """Nobody asked for it; where all were asked for, it is."""
    assert held(run("dc_ripple", selected=("dc_ripple",)), baseline).baseline.gone == ()
    (gone,) = held(run("dc_ripple"), baseline).baseline.gone
    assert gone.check == "current_limit"


def test_an_update_keeps_what_was_not_selected(baseline):
    """The line of a check that nobody asked for stays; what was asked for and is no longer there goes."""
    part = updated(baseline, run("dc_ripple", selected=("dc_ripple",)))
    assert (part.baseline, part.steps) == (baseline, ())
    assert [key.check for key in updated(baseline, run("dc_ripple")).baseline.entries] == ["dc_ripple"]
    assert [key.check for key in updated(baseline, run("dc_ripple", selected=KNOWN)).baseline.entries] == ["dc_ripple"]
