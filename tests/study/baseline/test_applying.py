"""A run against its baseline: what is known, worse, better and gone, and what that does to the exit status."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from baselines import baseline_file, case_of, held, one, run_of, verdict
from pvlvrt_compliance.results import Status, Verdict, exit_status
from pvlvrt_compliance.results.changes import by_key
from pvlvrt_compliance.study.baseline.applying import Held, held_against
from pvlvrt_compliance.study.baseline.entries import Baseline, entry_of
from pvlvrt_compliance.study.baseline.reading import BaselineFile
from pvlvrt_compliance.study.baseline.updating import updated

KNOWN = "p.t x fail -1.0 kvar # ticket 42"


def _first(results):
    return results.tests[0].checks[0]


def test_a_known_failure_keeps_its_verdict_and_ends_with_0():
    """It says that it is known, and why."""
    run = held(one(verdict()), KNOWN)
    found = _first(run)
    assert (found.status, found.known, found.known_reason, found.worse) == (Status.FAIL, True, "ticket 42", "")
    assert (run.status, exit_status(run)) == (Status.FAIL, 0)


def test_what_the_baseline_does_not_know_fails():
    """A failure without an entry is as it is without a baseline."""
    run = held(one(verdict()), "p.t other fail", "q.t x fail -1.0 kvar", "p.u x fail -1.0 kvar")
    assert not _first(run).known
    assert exit_status(run) == 1


# Entry, the verdict of now, and what that is: a limit of 10 kvar, of which 1 % are 0.1 kvar; besides an entry is as
# good as its last digit, half of which are 0.0005 kvar of -1.000, but no worse than one of the program's own, -1.00.
@pytest.mark.parametrize(
    ("entry", "now", "change"),
    [
        ("fail -1.000 kvar", ("fail", -1.099), "known"),
        ("fail -1.000 kvar", ("fail", -1.102), "worse"),
        ("fail -1.0 kvar", ("fail", -1.104), "known"),
        ("fail -1.0 kvar", ("fail", -1.106), "worse"),
        ("fail -1.000 kvar", ("fail", -0.901), "known"),
        ("fail -1.000 kvar", ("fail", -0.898), "known better"),
        ("fail -1.000 kvar", ("pass", 0.001), "better"),
        ("fail -1.000 kvar", ("not_applicable", None), "better"),
        ("fail -1.000 kvar", ("not_evaluated", None), "unjudged"),
        ("fail -1.000 kvar", ("error", None), "unjudged"),
        ("fail", ("fail", -9.0), "worse"),
        ("fail", ("fail", None), "known"),
        ("fail -1.000 kvar", ("fail", None), "worse"),
        ("fail -1.000 kW", ("fail", -1.0), "worse"),
        ("pass +1.000 kvar", ("pass", 0.901), "same"),
        ("pass +1.000 kvar", ("pass", 0.898), "worse"),
        ("pass +1.000 kvar", ("pass", 1.099), "same"),
        ("pass +1.000 kvar", ("pass", 1.102), "better"),
        ("pass +1.000 kvar", ("fail", -0.001), "worse"),
        ("pass +1.000 kvar", ("not_applicable", None), "worse"),
        ("pass +1.000 kvar", ("not_evaluated", None), "unjudged"),
        ("pass +1.000 kvar", ("pass", None), "worse"),
        ("pass +1.000 kW", ("pass", 1.0), "worse"),
        ("pass", ("pass", 0.001), "worse"),
        ("pass", ("pass", None), "same"),
    ],
)
def test_every_kind_of_change(entry, now, change):
    """Just inside the tolerance nothing has changed, just outside it has."""
    run = held(one(verdict(*now)), f"p.t x {entry}")
    found = _first(run)
    assert found.is_known is ("known" in change)
    assert bool(found.worse) is (change in ("worse", "unjudged"))
    assert bool(run.baseline.better) is ("better" in change)
    assert exit_status(run) == {"worse": 1, "unjudged": 3}.get(change, 0)
    if found.worse:
        assert found.worse.startswith(f"was {entry.replace(' ', ', ', 1)}; now {now[0].replace('_', ' ')}")


@pytest.mark.parametrize(
    ("entry", "now", "why"),
    [
        ("fail", -9.0, "the line has no margin"),
        ("fail -1.000 kvar", None, "the verdict has no margin"),
        ("fail -1.000 var", -1.0, "the units differ"),
        ("pass +1.000 ms", 1.0, "the units differ"),
    ],
)
def test_what_cannot_be_compared_is_told_with_what_to_do(entry, now, why):
    """And after an update it can be."""
    made = one(verdict(entry.split()[0], now))
    assert f"cannot be compared: {why} (pvlvrt-check baseline update" in _first(held(made, f"p.t x {entry}")).worse
    anew = updated(baseline_file(f"p.t x {entry}").baseline, made)
    assert exit_status(held_against(made, Held(BaselineFile("b.txt", "", anew.baseline), 0.0), lambda _: False)) == 0


@pytest.mark.parametrize("entry", ["fail -1 kvar", "fail -1.0 kvar", "pass +1 kvar", "pass +1.0 kvar"])
@given(lost=st.floats(0.0, 0.4))
def test_a_coarse_margin_lets_no_more_pass_than_a_fine_one(entry, lost):
    """However few digits somebody has written, less than a thousandth of the limit is allowed for them."""
    status, margin, _ = entry.split()
    run = held(one(verdict(status, float(margin) - lost)), f"p.t x {entry}", tolerance=0.0)
    if lost > 0.01:
        assert exit_status(run) == 1
    if lost < 0.005:
        assert exit_status(run) == 0


@pytest.mark.parametrize(("allowed", "entry", "status"), [(False, KNOWN, 3), (True, KNOWN, 1), (True, "p.t y fail", 0)])
def test_what_is_unjudged_is_never_known(allowed, entry, status):
    """It makes 3; where it may stay unjudged, only what could not be judged before either may."""
    run = held(one(verdict("not_evaluated", None), allow_unjudged=allowed), entry)
    assert exit_status(run) == status


@pytest.mark.parametrize("status", ["error", "not_evaluated"])
def test_a_test_that_ended_before_its_checks_is_no_better_for_a_baseline(status):
    """Its entries neither hide it nor are gone."""
    broken = case_of("u").model_copy(update={"status": Status(status)})
    run = held(run_of(case_of("t", verdict()), broken), KNOWN, "p.u x fail -1.0 kvar", is_gone=lambda _: True)
    assert exit_status(run) == 3
    assert run.baseline.gone == ()


def test_the_run_stays_the_same_run():
    """Its id is that of what was found, and so are its verdicts and counts."""
    plain = one(verdict())
    run = held(plain, KNOWN)
    assert run.run_id == plain.run_id
    assert run.counts() == plain.counts()
    # ... also where the results have been concluded anew, from verdicts that know of a baseline
    assert run_of(*run.tests).run_id == plain.run_id


def test_the_second_verdict_of_a_check_has_an_entry_of_its_own():
    """It is named as in junit.xml."""
    run = held(run_of(case_of("t", verdict(), verdict(margin=-2.0))), "p.t x (2) fail -2.0 kvar")
    assert [found.known for found in run.tests[0].checks] == [False, True]


def test_an_entry_of_a_test_that_there_is_no_longer_is_told():
    """One of a test that was not selected is not; nor is one of another profile."""
    lines = ("p.t x fail -1.0 kvar", "p.old x fail -1.0 kvar", "p.other x fail", "p.t gone fail -3.0 kvar")
    run = held(one(verdict()), *lines, is_gone={"p.old"}.__contains__)
    assert [(note.test, note.check, note.was, note.now) for note in run.baseline.gone] == [
        ("p.old", "x", "fail, -1.0 kvar", "no such test"),
        ("p.t", "gone", "fail, -3.0 kvar", "no such check in it"),
    ]
    assert exit_status(run) == 0


def test_a_check_that_was_not_asked_for_is_not_gone():
    """Where only some checks are judged, entries of others wait."""
    some = run_of(case_of("t", verdict()), selected_checks=("x",))
    assert held(some, KNOWN, "p.t y fail", "p.t x (2) fail").baseline.gone[0].check == "x (2)"
    assert held(some, KNOWN, "p.t y fail").baseline.gone == ()


def test_a_row_of_which_only_some_runs_were_selected_is_neither_better_nor_worse():
    """Its verdict says that there were not enough of them, and nothing else."""
    few = verdict("not_applicable", None, "repeated_runs", limit=None, unit="")
    for entry in ("fail -1 runs", "pass +1 runs"):
        run = held(run_of(case_of("t", few, verdict("pass", 1.0))), f"p.t repeated_runs {entry}")
        assert (run.baseline.better, run.tests[0].checks[0].worse, exit_status(run)) == ((), "", 0)


def test_a_run_that_is_let_off_is_better():
    """A failure that no longer counts against it is told, and no longer known."""
    off = verdict("not_applicable", None, "ride_through", message="tripped; let off, all further runs were ridden")
    run = held(run_of(case_of("t", off, verdict("pass", 1.0))), "p.t ride_through fail -1.0 s")
    assert [note.now for note in run.baseline.better] == ["not applicable"]
    assert exit_status(run) == 0


def test_what_the_run_was_held_against_is_kept():
    """The file as it was named, its digest, and the tolerance."""
    found = held(one(verdict()), KNOWN, tolerance=0.05).baseline
    assert (found.file, found.digest, found.tolerance) == ("b.txt", "digest", 0.05)


@given(
    st.sampled_from(["pass", "fail"]),
    st.floats(-1e4, 1e4),
    st.floats(0, 1e4),
    st.floats(0, 10),
    st.sampled_from(["kvar", "pu", "s", "%", "runs", ""]),
    st.floats(-1e-9, 1e-9),
)
def test_the_same_run_is_green_on_any_machine(status, margin, limit, tolerance, unit, elsewhere):
    """Held against its own entry nothing is worse or better, even without any tolerance: rounding is allowed for."""
    made = verdict(status, margin, limit=limit, tolerance=tolerance, unit=unit)
    (key, _), _ = by_key(one(made)).items()
    source = BaselineFile("b.txt", "digest", Baseline({key: entry_of(key, made)}))
    moved = made.model_copy(update={"margin": margin + elsewhere * (limit + tolerance)})
    for now, share in ((made, 0.0), (moved, 0.01)):
        run = held_against(one(now), Held(source, share), lambda _: False)
        assert _first(run).worse == ""
        assert run.baseline.better == ()
        assert exit_status(run) == 0


def test_what_no_longer_applies_fails_where_it_passed():
    """A check that the inverter has got out of, say by letting go, is no longer shown to be kept."""
    gone = Verdict(check="x", status=Status.NOT_APPLICABLE, message="not judged after the trip at 0.837 s")
    run = held(run_of(case_of("t", gone, verdict("pass", 1.0, "y"))), "p.t x pass +1.0 kvar")
    assert _first(run).is_worse
    assert exit_status(run) == 1
