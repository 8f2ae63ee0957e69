"""What a run counts as, and the exit status that follows: one owner, one table."""

import itertools

import pytest

from pvlvrt_compliance.results import Status, TestResult, Verdict, conclude, exit_status, worst

E, N, F, P, A = Status
COMBINATIONS = [found for count in range(6) for found in itertools.combinations(Status, count)]


def _run(*tests, allow_unjudged=False):
    """A run of tests, each given by the verdicts of its checks."""
    made = [
        TestResult(
            id=str(k), status=worst(found), checks=[Verdict(check=f"c{j}", status=x) for j, x in enumerate(found)]
        )
        for k, found in enumerate(tests)
    ]
    return conclude(made, allow_unjudged=allow_unjudged)


def _expected(found, allowed):
    """The sentences, one by one."""
    if E in found or (N in found and not allowed):
        return 3
    if F in found:
        return 1
    return 0 if P in found else 3


@pytest.mark.parametrize("allowed", [False, True])
@pytest.mark.parametrize("found", COMBINATIONS, ids=lambda found: "-".join(found) or "none")
def test_every_combination_of_verdicts(found, allowed):
    """An error is 3, so is what is unjudged unless allowed; a fail is 1, and 0 needs a pass; in one test or several."""
    assert exit_status(_run(found, allow_unjudged=allowed)) == _expected(found, allowed)
    assert exit_status(_run(*([x] for x in found), allow_unjudged=allowed)) == _expected(found, allowed)


@pytest.mark.parametrize(
    ("tests", "status", "allowed", "plain"),
    [
        ([[P], [N, P]], N, 0, 3),
        ([[F], [N, P]], N, 1, 3),
        ([[F], [N]], N, 1, 3),
        ([[E], [N, P]], E, 3, 3),
        ([[N], [A]], N, 3, 3),
        ([[A], [A, A]], N, 3, 3),
        ([[P], [A]], P, 0, 0),
        ([], N, 3, 3),
    ],
)
def test_what_a_gate_sees(tests, status, allowed, plain):
    """The verdict of a run is what was found, whatever is allowed; where nothing applied it is `not_evaluated`."""
    assert _run(*tests).status is _run(*tests, allow_unjudged=True).status is status
    assert exit_status(_run(*tests)) == plain
    assert exit_status(_run(*tests, allow_unjudged=True)) == allowed


def test_a_test_without_checks_counts_with_its_own_verdict():
    """One that ended before any check neither makes a run pass nor is forgotten."""
    broken = TestResult(id="x", status=Status.ERROR)
    passed = TestResult(id="y", status=P, checks=(Verdict(check="c", status=P),))
    assert exit_status(conclude([broken, passed], allow_unjudged=True)) == 3


def test_asking_otherwise_is_the_same_run():
    """The option is kept beside the findings, and the id of the run is that of the findings."""
    plain, allowed = _run([P, N]), _run([P, N], allow_unjudged=True)
    assert (plain.allow_unjudged, allowed.allow_unjudged) == (False, True)
    assert plain.run_id == allowed.run_id


@pytest.mark.parametrize(
    ("status", "margin", "uncertainty", "marginal"),
    [
        (F, -0.003, 0.005, True),
        (P, 0.003, 0.005, True),
        (P, 0.0, 0.005, True),
        (P, 0.005, 0.005, False),
        (F, -0.006, 0.005, False),
        (F, None, 0.005, False),
        (P, 0.003, None, False),
        (A, 0.003, 0.005, False),
    ],
)
def test_marginal_is_nearer_than_the_uncertainty(status, margin, uncertainty, marginal):
    """A judged verdict whose margin is smaller, on either side; what is not known makes nothing marginal."""
    check = Verdict(check="x", status=status, margin=margin, uncertainty=uncertainty)
    assert check.is_marginal is marginal
    assert check.model_dump()["marginal"] is marginal


def test_marginal_changes_neither_status_nor_exit_status():
    """It is said, and nothing else."""
    for status, code in ((F, 1), (P, 0)):
        check = Verdict(check="x", status=status, margin=0.0, uncertainty=1.0)
        results = conclude([TestResult(id="t", status=status, checks=(check,))])
        assert (results.status, exit_status(results)) == (status, code)


KNOWN = Verdict(check="a", status=F, known=True)
LOST = Verdict(check="b", status=P, worse="margin +1 kvar, +5 kvar in the baseline")


@pytest.mark.parametrize(
    ("verdicts", "status"),
    [
        ([KNOWN], 0),
        ([KNOWN, Verdict(check="b", status=P)], 0),
        ([KNOWN, Verdict(check="b", status=F)], 1),
        ([LOST], 1),
        ([KNOWN, LOST], 1),
        ([KNOWN.model_copy(update={"worse": "margin"})], 1),
        ([KNOWN, Verdict(check="b", status=N)], 3),
        ([KNOWN.model_copy(update={"status": E})], 3),
        ([KNOWN.model_copy(update={"status": N})], 3),
    ],
)
def test_what_a_baseline_knows_is_no_failure_and_what_is_worse_is_one(verdicts, status):
    """A known failure alone ends with 0; it never hides a new one, a lost margin, an error or what is unjudged."""
    run = conclude([TestResult(id="t", status=worst(v.status for v in verdicts), checks=verdicts)])
    assert exit_status(run) == status
    assert run.status is worst(v.status for v in verdicts)


def test_a_known_failure_does_not_hide_a_test_in_which_nothing_was_judged():
    """A test of its own that is `not_evaluated` stays so, beside a known failure."""
    empty = TestResult(id="u", status=N, checks=[Verdict(check="c", status=A)])
    assert exit_status(conclude([TestResult(id="t", status=F, checks=[KNOWN]), empty])) == 3


def test_how_long_it_took_and_where_it_lies_is_the_same_run():
    """Two runs with the same findings have one id, on whichever machine and in whichever folder."""
    test = TestResult(id="t", status=P, checks=[Verdict(check="c", status=P)])
    quick = conclude([test], provenance={"files": {"controller": "a.py"}})
    slow = conclude([test.model_copy(update={"wall_time_s": 12.0})])
    assert quick.run_id == slow.run_id
