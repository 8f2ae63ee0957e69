"""Two runs beside each other: what has changed, and whether it is a regression."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.results import ProfileSummary, Results, Status, TestResult, Verdict, conclude, worst
from pvlvrt_compliance.results.changes import Change
from pvlvrt_compliance.results.comparison import Comparison, compare, comparison_status, parse_fail_on

LIMIT, TOLERANCE = 90.0, 10.0  # one per cent of which is 1 kvar


def verdict(check="support", status=Status.PASS, margin=5.0, **more):
    """A verdict in kvar."""
    given = {"limit": LIMIT, "tolerance": TOLERANCE, "unit": "kvar", "bound": "at_least"} | more
    return Verdict(check=check, status=status, margin=margin, **given)


def made_of(*checks, name="VD1", **more):
    """A test with these verdicts."""
    return TestResult(id=name, profile="code", status=worst(c.status for c in checks), checks=checks, **more)


def run(*tests, **more):
    """A run of these tests."""
    return conclude(tests, **more)


def of_one(old, new, fail_on="verdict"):
    """The comparison of two runs with a verdict each."""
    return compare(run(made_of(old)), run(made_of(new)), fail_on)


statuses = st.sampled_from(Status)
margins = st.none() | st.floats(-50, 50)
verdicts = st.builds(verdict, st.sampled_from(["support", "limit"]), statuses, margins)
tests = st.builds(lambda name, checks: made_of(*checks, name=name), st.text(max_size=3), st.lists(verdicts, max_size=3))
runs = st.builds(lambda found: run(*found), st.lists(tests, max_size=3, unique_by=lambda test: test.id))


@given(runs)
def test_a_run_beside_itself_has_no_changes(found):
    """Nothing differs, and nothing is a regression where anything was judged."""
    comparison = compare(found, found, "margin:0%")
    assert (comparison.changes, comparison.differences, comparison.profiles) == ((), (), ())
    assert comparison_status(comparison) == (0 if found.tests else 3)


@given(st.lists(st.tuples(statuses, margins, statuses, margins), min_size=1, max_size=4))
def test_swapping_the_runs_swaps_better_and_worse(pairs):
    """What one run has lost the other has gained, share by share, where both have the verdict."""
    old = run(made_of(*(verdict(str(n), was, before) for n, (was, before, _, _) in enumerate(pairs))))
    new = run(made_of(*(verdict(str(n), now, after) for n, (_, _, now, after) in enumerate(pairs))))
    there, back = ({c.key: c for c in compare(*both).changes} for both in ((old, new), (new, old)))
    assert there.keys() == back.keys()
    opposite = {Change.WORSE: Change.BETTER, Change.BETTER: Change.WORSE}
    for key, change in there.items():
        assert back[key].change is opposite[change.change]
        assert back[key].margin_lost == (None if change.margin_lost is None else pytest.approx(-change.margin_lost))


@given(runs, runs)
def test_a_comparison_comes_back_from_its_file(old, new):
    """JSON has all of it."""
    comparison = compare(old, new)
    assert Comparison.model_validate_json(comparison.model_dump_json()) == comparison


@given(runs, runs)
def test_every_verdict_is_told_once(old, new):
    """Each of either run is changed or unchanged, never both."""
    comparison = compare(old, new)
    told = [(c.test, c.check) for c in comparison.changes]
    told += [(test, check) for test, checks in comparison.unchanged.items() for check in checks]
    assert len(told) == len(set(told))
    assert {test for test, _ in told} == {test.key for test in (*old.tests, *new.tests)}


@pytest.mark.parametrize(
    ("was", "now", "status"),
    [
        (Status.PASS, Status.FAIL, 1),
        (Status.PASS, Status.NOT_APPLICABLE, 1),
        (Status.FAIL, Status.PASS, 0),
        (Status.FAIL, Status.FAIL, 0),
        (Status.PASS, Status.ERROR, 3),
        (Status.FAIL, Status.NOT_EVALUATED, 3),
        (Status.ERROR, Status.ERROR, 0),
        (Status.ERROR, Status.FAIL, 0),
    ],
)
def test_a_verdict_that_is_worse_is_a_regression(was, now, status):
    """1 where it is judged still, 3 where it can no longer be; what was no better before is none."""
    comparison = of_one(verdict(status=was), verdict(status=now))
    assert comparison_status(comparison) == status
    assert comparison.regression is bool(status)


@pytest.mark.parametrize(
    ("margin", "fail_on", "regressions"),
    [
        (0.01, "margin:5%", 0),
        (-0.01, "margin:5%", 1),
        (-40.0, "verdict", 0),
        (4.9, "margin:0%", 1),
        (9.0, "margin:0%", 0),
    ],
)
def test_a_margin_counts_beyond_the_share_asked_for(margin, fail_on, regressions):
    """5 % of 90 and 10 kvar are 5 kvar, of a margin of 5 kvar; by verdicts alone it is only told."""
    comparison = of_one(verdict(), verdict(margin=margin), fail_on)
    assert len(comparison.regressions) == regressions
    assert len(comparison.of("margin")) == 1


def test_what_nobody_sees_of_a_margin_is_no_change():
    """A hundredth of a per cent is noise, even where any loss is a regression."""
    comparison = of_one(verdict(), verdict(margin=4.995), "margin:0%")
    assert comparison.changes == ()
    assert comparison.unchanged == {"code.VD1": ("support",)}


def test_margins_come_largest_first():
    """What has lost most stands first, in its share of the limit."""
    old = run(made_of(*(verdict(name) for name in "abc")))
    new = run(made_of(verdict("a", margin=4), verdict("b", margin=1), verdict("c", margin=9)))
    lost = compare(old, new).changes
    assert [(c.check, round(c.margin_lost, 3)) for c in lost] == [("b", 0.04), ("a", 0.01), ("c", -0.04)]


@pytest.mark.parametrize("status", [Status.PASS, Status.FAIL, Status.ERROR, Status.NOT_EVALUATED])
def test_evidence_that_is_gone_is_a_regression(status):
    """To leave a test out must not look like a repair, whatever it said; what did not apply had shown nothing."""
    kept = made_of(verdict())
    gone = compare(run(kept, made_of(verdict(status=status), name="VD2")), run(kept))
    assert gone.tests_gone == ("code.VD2",)
    assert comparison_status(gone) == 1
    let_off = made_of(verdict(status=Status.PASS), verdict("x", Status.NOT_APPLICABLE))
    assert comparison_status(compare(run(let_off), run(made_of(verdict())))) == 0


@pytest.mark.parametrize(
    ("status", "ends"), [(Status.PASS, 0), (Status.NOT_APPLICABLE, 0), (Status.FAIL, 1), (Status.ERROR, 3)]
)
def test_a_new_test_must_be_settled(status, ends):
    """What is added and fails is a regression, what cannot be judged is 3."""
    kept = made_of(verdict())
    added = compare(run(kept), run(kept, made_of(verdict(status=status), name="VD2")))
    assert added.tests_added == ("code.VD2",)
    assert comparison_status(added) == ends


def test_a_check_that_is_added_leaves_its_test_in_both():
    """A test of which both runs have a verdict is neither gone nor added."""
    comparison = compare(run(made_of(verdict("a"))), run(made_of(verdict("a"), verdict("b"))))
    assert [change.what for change in comparison.changes] == ["added"]
    assert comparison.tests_added == ()


def test_runs_without_anything_in_common_are_no_comparison():
    """That nothing is worse where nothing could be compared must not pass."""
    comparison = compare(run(made_of(verdict())), run(made_of(verdict(), name="VD2")))
    assert comparison.in_both == 0
    assert comparison.regression
    assert comparison_status(comparison) == 3


def test_a_failure_that_a_baseline_knows_is_a_failure():
    """A comparison is of two runs, whatever is lived with."""
    comparison = of_one(verdict(), verdict(status=Status.FAIL, margin=-1.0, known=True))
    assert comparison_status(comparison) == 1


def test_a_limit_that_has_moved_is_told():
    """Two margins of different limits are not of the same thing."""
    (change,) = of_one(verdict(), verdict(limit=120.0, margin=1.0)).changes
    assert change.limit_moved
    (change,) = of_one(verdict(), verdict(margin=1.0)).changes
    assert not change.limit_moved


def test_parameters_that_differ_are_told_path_by_path():
    """What is the same is left out, and so is when the runs were."""
    old = {"created": "1", "controller": "bundled", "parameters": {"plant": {"a": 1.0, "b": None}, "c": [1, 2]}}
    new = {"created": "2", "controller": "x.so", "parameters": {"plant": {"a": 1.5, "b": None}, "c": (1, 2), "d": 3}}
    found = compare(run(made_of(verdict()), provenance=old), run(made_of(verdict()), provenance=new)).differences
    assert [(d.path, d.there, d.old, d.new) for d in found] == [
        ("controller", "both", "bundled", "x.so"),
        ("parameters.plant.a", "both", 1.0, 1.5),
        ("parameters.d", "new", None, 3),
    ]


def test_a_profile_of_the_same_id_and_another_content_is_told():
    """Its limits may have moved; one that is the same is not told."""
    old, new = (
        run(made_of(verdict()), profiles=[ProfileSummary(id=name, title="", digest=d) for name, d in digests.items()])
        for digests in ({"a": "1", "b": "1", "c": "1"}, {"a": "1", "b": "2", "d": "1"})
    )
    found = {(p.id, p.there, p.old_digest, p.new_digest) for p in compare(old, new).profiles}
    assert found == {("b", "both", "1", "2"), ("c", "old", "1", ""), ("d", "new", "", "1")}


def test_a_test_that_was_asked_otherwise_is_told():
    """Tests whose scenarios differ alike are told once, with their names."""
    old, new = (
        run(*(made_of(verdict(), name=name, scenario={"scr": scr, "sag": {"depth": 0.5}}) for name in ("VD1", "VD2")))
        for scr in (None, 10.0)
    )
    (found,) = compare(old, new).differences
    assert (found.path, found.old, found.new) == ("scenario.scr", None, 10.0)
    assert found.tests == ("code.VD1", "code.VD2")


@pytest.mark.parametrize("text", ["", "margins", "margin:", "margin:x", "margin:200%", "verdict:5%"])
def test_what_else_a_regression_may_be_is_refused(text):
    """The message says what is allowed."""
    with pytest.raises(UsageError, match=r"^--fail-on.*(margin:SHARE|write 90%|outside)"):
        parse_fail_on(text, "--fail-on")


def test_results_of_the_first_version_are_compared(pytestconfig):
    """A file of 0.1.0 beside itself has no changes."""
    file = pytestconfig.rootpath / "tests" / "golden" / "results-0.1.0" / "results.json"
    old = Results.model_validate_json(file.read_bytes())
    comparison = compare(old, old)
    assert (comparison.changes, comparison.in_both) == ((), comparison.unchanged_count)
