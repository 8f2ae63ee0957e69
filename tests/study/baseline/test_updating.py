"""A baseline brought up to date: what is added, changed, dropped, and what stays."""

import pytest

from baselines import baseline_file, case_of, run_of, verdict
from pvlvrt_compliance.results import Status
from pvlvrt_compliance.study.baseline.entries import Baseline
from pvlvrt_compliance.study.baseline.text import written
from pvlvrt_compliance.study.baseline.updating import updated


def _lines(update):
    return [" ".join(line.split()) for line in written(update.baseline).splitlines()[4:]]


def _before(*lines):
    return baseline_file(*lines).baseline


def test_a_new_baseline_has_the_failures():
    """Neither passes, nor what does not apply, nor what could not be judged."""
    checks = [verdict(status, -1.0, status) for status in Status]
    update = updated(Baseline({}), run_of(case_of("t", *checks)), reason="ticket 42")
    assert _lines(update) == ["p.t fail fail -1.00 kvar # ticket 42"]
    assert [step.kind for step in update.steps] == ["added"]
    assert [key.check for key in update.unjudged] == ["error", "not_evaluated"]


def test_with_margins_it_has_what_passed_too():
    """So that a lost margin is seen; a file that has them keeps them until it is told otherwise."""
    run = run_of(case_of("t", verdict(), verdict("pass", 2.0, "y")))
    with_margins = updated(Baseline({}), run, margins=True, reason="why")
    assert _lines(with_margins) == ["p.t x fail -1.00 kvar # why", "p.t y pass +2.00 kvar"]
    assert _lines(updated(with_margins.baseline, run)) == _lines(with_margins)
    assert _lines(updated(with_margins.baseline, run, margins=False)) == ["p.t x fail -1.00 kvar # why"]


@pytest.mark.parametrize(
    ("now", "line", "kinds"),
    [
        (verdict("fail", -1.004), "p.t x fail -1.0 kvar # why", []),
        (verdict("fail", -1.04), "p.t x fail -1.04 kvar # why", ["changed"]),
        (verdict("fail", -1.06), "p.t x fail -1.06 kvar # why", ["changed"]),
        (verdict("fail", -0.5), "p.t x fail -0.50 kvar # why", ["changed"]),
        (verdict("fail", -1.0, unit="kW"), "p.t x fail -1.00 kW # why", ["changed"]),
        (verdict("fail", None), "p.t x fail # why", ["changed"]),
        (verdict("pass", 1.0), None, ["dropped"]),
        (verdict("not_applicable", None), None, ["dropped"]),
        (verdict("not_evaluated", None), "p.t x fail -1.0 kvar # why", []),
        (verdict("error", None), "p.t x fail -1.0 kvar # why", []),
    ],
)
def test_reasons_stay_with_their_lines(now, line, kinds):
    """A line that still says what was found is not touched; what could not be judged leaves it as it is."""
    update = updated(_before("p.t x fail -1.0 kvar # why"), run_of(case_of("t", now)))
    assert _lines(update) == ([line] if line else [])
    assert [step.kind for step in update.steps] == kinds


def test_a_reason_for_a_failure_is_none_for_a_pass():
    """A verdict that is another one begins anew, with the reason for new failures where it is one."""
    before = _before("p.t x fail -1.0 kvar # why", "p.t y pass +1.0 kvar # fine")
    update = updated(before, run_of(case_of("t", verdict("pass", 1.0), verdict(check="y"))), reason="new")
    assert _lines(update) == ["p.t x pass +1.00 kvar", "p.t y fail -1.00 kvar # new"]


def test_a_reason_is_given_to_failures_that_have_none():
    """One that is there is not written over."""
    before = _before("p.t x fail -1.0 kvar", "p.t y fail -1.0 kvar # why")
    update = updated(before, run_of(case_of("t", verdict(), verdict(check="y"))), reason="new")
    assert _lines(update) == ["p.t x fail -1.0 kvar # new", "p.t y fail -1.0 kvar # why"]
    assert update.without_reason == 0


def test_entries_of_tests_that_were_not_run_stay_unless_they_are_pruned():
    """A run of some tests says nothing of the others."""
    before = _before("p.t x fail -1.0 kvar", "p.u x fail -2.0 kvar # why", "q.t x fail")
    run = run_of(case_of("t", verdict("pass", 1.0)))
    update = updated(before, run)
    assert _lines(update) == ["p.u x fail -2.0 kvar # why", "q.t x fail"]
    assert update.not_run == 2
    pruned = updated(before, run, prune=True)
    assert _lines(pruned) == []
    assert [step.in_words for step in pruned.steps] == [
        "- x in p.t: fail, -1.0 kvar; now pass, +1.00 kvar",
        "- x in p.u: fail, -2.0 kvar; now not in this run # why",
        "- x in q.t: fail; now not in this run",
    ]


def test_an_entry_of_a_check_that_there_is_no_longer_goes():
    """Unless the test broke down, or only some checks were asked for."""
    before = _before("p.t y fail -1.0 kvar")
    for prune in (False, True):
        assert _lines(updated(before, run_of(case_of("t", verdict("pass", 1.0))), prune=prune)) == []
        assert _lines(updated(before, run_of(case_of("t")), prune=prune)) == ["p.t y fail -1.0 kvar"]
        some = run_of(case_of("t", verdict("pass", 1.0)), selected_checks=("x",))
        assert _lines(updated(before, some, prune=prune)) == ["p.t y fail -1.0 kvar"]


def test_a_row_of_which_not_all_runs_were_selected_leaves_its_line():
    """There were not enough runs to judge it by."""
    few = verdict("not_applicable", None, "repeated_runs", limit=None, unit="")
    before = _before("p.t repeated_runs fail -1 runs # why")
    assert _lines(updated(before, run_of(case_of("t", few)))) == ["p.t repeated_runs fail -1 runs # why"]


def test_comments_stay_with_the_line_below_them():
    """They go with it, and those at the end stay there."""
    before = _before("# of the first", "p.t x fail -1.0 kvar", "# of the second", "p.t y fail -1.0 kvar", "# last")
    both = run_of(case_of("t", verdict("fail", -2.0), verdict(check="y")))
    assert _lines(updated(before, both))[::2] == ["# of the first", "# of the second", "# last"]
    one = run_of(case_of("t", verdict("pass", 1.0), verdict(check="y")))
    assert _lines(updated(before, one)) == ["# of the second", "p.t y fail -1.0 kvar", "# last"]


def test_an_unchanged_run_writes_the_same_bytes():
    """However often."""
    run = run_of(case_of("u", verdict("fail", -1.23456)), case_of("t", verdict(), verdict("pass", 1.0, "y")))
    first = updated(Baseline({}), run, margins=True)
    again = updated(first.baseline, run)
    assert written(again.baseline) == written(first.baseline)
    assert again.steps == ()
