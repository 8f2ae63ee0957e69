"""Coverage: each clause of a profile once, with what became of it and why."""

import re

import pytest

from pvlvrt_compliance.disturbance.model import Disturbance, NormalVoltage, Step, Stretch, Voltage
from pvlvrt_compliance.report.document.coverage import coverage
from pvlvrt_compliance.report.formats import html
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.results import (
    ClauseSummary,
    NotCoveredSummary,
    ProfileSummary,
    ReportDetails,
    Status,
    TestResult,
    Verdict,
    conclude,
)

CLAUSES = (
    ClauseSummary(clause="1", checks=("ride_through",), judged_tests=3, confidence="chosen"),
    ClauseSummary(clause="1.1", parts=("ride_through.envelope",), judged_tests=3, confidence="code"),
    ClauseSummary(clause="1.2", parts=("ride_through.regions",), judged_tests=3),
    ClauseSummary(clause="2", checks=("current_limit", "dc_ripple"), judged_tests=3),
    ClauseSummary(clause="T1", tests=("one-1", "one-2")),
    ClauseSummary(clause="T2", tests=("two",)),
)
PROFILE = ProfileSummary(id="code", title="A <code>", digest="0", clauses=CLAUSES)


def verdict(check, status=Status.PASS, margin=0.5, clause="1", **fields):
    """A verdict on a limit of 1 pu."""
    numbers = {} if margin is None else {"measured": 1 + margin, "limit": 1.0, "margin": margin, "unit": "pu"}
    return Verdict(check=check, status=status, clause=clause, **numbers, **fields)


def result(name, *verdicts, expect="ride_through", **fields):
    """A test of a row; without ``expect`` it is the user's own."""
    worst = min((each.status for each in verdicts), key=list(Status).index, default=Status.PASS)
    return TestResult(id=name, profile="code", status=worst, checks=verdicts, expect=expect, **fields)


def rows(*tests, profile=PROFILE, language="en"):
    """Rows of the coverage by their clause."""
    (found,) = coverage(conclude(tests, [profile]), Texts(language))
    assert [row.clause for row in found.rows] == [each.clause for each in profile.clauses]
    return {row.clause: row for row in found.rows}


def test_a_clause_of_several_checks_is_one_row():
    """The worst verdict of any of them decides; the tests that failed are listed, the worst first."""
    found = rows(
        result("one-1", verdict("current_limit", margin=0.1, clause="2"), verdict("dc_ripple", margin=0.2, clause="2")),
        result("one-2", verdict("dc_ripple", Status.FAIL, margin=-0.1, clause="2")),
        result("two", verdict("dc_ripple", Status.FAIL, margin=-0.3, clause="2"), verdict("current_limit", clause="2")),
    )["2"]
    assert (found.state, found.judged, found.run) == ("fail", 3, 3)
    assert found.tests == ((3, "two"), (2, "one-2"))
    assert (found.worst.test.id, found.margin) == ("two", "-0.300 pu")
    assert found.about == ("Current limit", "Ripple of the DC voltage")


def test_of_what_passed_the_nearest_to_failing_is_told():
    """One link is enough: the test with the least margin."""
    found = rows(
        result("one-1", verdict("ride_through", margin=0.3)), result("one-2", verdict("ride_through", margin=0.2))
    )["1"]
    assert (found.state, found.tests, found.margin, found.reason) == ("pass", ((2, "one-2"),), "+0.200 pu", "")


def test_what_is_counted_is_never_the_nearest():
    """Two runs of two are met by zero runs of margin: a measured value says more."""
    runs = Verdict(check="repeated_runs", status=Status.PASS, measured=2, limit=2, margin=0, unit="runs", clause="3")
    found = rows(result("one-1", runs, verdict("ride_through", margin=0.3)))["T1"]
    assert (found.worst.verdict.check, found.margin) == ("ride_through", "+0.300 pu")


def test_the_part_that_decided_is_judged():
    """A verdict that names the envelope says nothing of the regions; one of the whole requirement is of both."""
    found = rows(result("one-1", verdict("ride_through", clause="1.1")))
    assert [found[clause].state for clause in ("1", "1.1", "1.2")] == ["pass", "pass", "not_tested"]
    assert found["1.2"].reason == (
        "Its requirement was judged, but in no test by this part: another part or the row of the test table decided, or"
        " the voltage never moved."
    )
    found = rows(result("one-1", verdict("ride_through", clause="1")))
    assert [found[clause].state for clause in ("1", "1.1", "1.2")] == ["pass", "pass", "pass"]


def test_a_part_shows_no_margin_of_another_part():
    """Where the requirement as a whole decided, its parts passed, too, without a margin of their own."""
    whole = result("one-1", verdict("ride_through", margin=0.1, clause="1"))
    assert (rows(whole)["1.1"].state, rows(whole)["1.1"].margin, rows(whole)["1"].margin) == ("pass", "", "+0.100 pu")
    by_envelope = result("one-2", verdict("ride_through", margin=0.3, clause="1.1"))
    found = rows(whole, by_envelope)
    assert [found[clause].margin for clause in ("1", "1.1", "1.2")] == ["+0.100 pu", "+0.300 pu", ""]
    assert found["1.1"].tests == ((2, "one-2"),)


def test_what_the_row_alone_demanded_is_of_no_other_clause():
    """A trip that the envelope permits and the row does not is a failure of the row's clause, not of the envelope's."""
    failed = verdict("ride_through", Status.FAIL, margin=-0.1, clause="T1")
    found = rows(result("one-1", failed, clause="T1"))
    assert [found[clause].state for clause in ("1", "1.1", "T1")] == ["not_tested", "not_tested", "fail"]
    # Where the row and the envelope stand under one clause, it is the envelope's, too.
    failed = verdict("ride_through", Status.FAIL, margin=-0.1, clause="1.1")
    assert rows(result("one-1", failed, clause="1.1"))["1.1"].state == "fail"


@pytest.mark.parametrize(
    ("moved", "status", "state"),
    [
        ("frequency", Status.PASS, "not_tested"),
        ("angle", Status.PASS, "not_tested"),
        ("voltage", Status.PASS, "pass"),
        ("frequency", Status.FAIL, "fail"),
    ],
)
def test_a_voltage_that_never_moved_passed_no_limit_of_the_voltage(moved, status, state):
    """A step of the frequency is no evidence for an envelope; a trip during it fails all the same."""
    still = Stretch(begin_s=0, end_s=1, kind="normal", voltage=Voltage(positive_pu=1, negative_pu=0, zero_pu=0))
    normal = NormalVoltage(low_pu=0.9, high_pu=1.1, negative_pu=0.1)
    steps = (Step(at_s=0.3, moved=(moved,)),)
    grid = Disturbance(start_s=0.3, clear_s=0.5, end_s=0.5, normal=normal, steps=steps, stretches=(still,))
    found = rows(result("one-1", verdict("ride_through", status, clause="1.1"), disturbance=grid))
    assert (found["1.1"].state, found["1"].state) == (state, state)


def test_a_row_of_the_test_table_is_as_good_as_its_tests():
    """Its clause has the worst of all that its runs were judged by, whatever clause that names."""
    found = rows(
        result("one-1", verdict("ride_through")),
        result("one-2", verdict("ride_through"), verdict("current_limit", Status.FAIL, margin=-0.2, clause="2")),
    )
    assert (found["T1"].state, found["T1"].judged, found["T1"].tests) == ("fail", 2, ((2, "one-2"),))
    assert found["T2"].state == "not_tested"


@pytest.mark.parametrize("status", [Status.ERROR, Status.NOT_EVALUATED])
def test_what_could_not_be_judged_is_no_pass(status):
    """One record without a verdict outweighs a pass; the commonest reason is told, whatever numbers are in it."""
    lost = [
        result(name, verdict("ride_through", status, None, message=message))
        for name, message in (("one-1", "no voltage at 0.1 s"), ("one-2", "crashed"), ("two", "no voltage at 0.25 s"))
    ]
    found = rows(result("zero", verdict("ride_through")), *lost)["1"]
    assert (found.state, found.judged, found.run) == (status.value, 1, 4)
    assert found.reason == "It could not be judged in 3 tests, most often for the reason quoted."
    assert found.detail == "“no voltage at 0.1 s”"
    assert [name for _, name in found.tests] == ["one-1", "one-2", "two"]


def test_what_applied_nowhere_is_not_tested():
    """It is said in how many tests it was let off, and why."""
    let_off = verdict("ride_through", Status.NOT_APPLICABLE, None, message="not judged after the trip at 0.837 s")
    found = rows(*(result(name, let_off) for name in ("one-1", "one-2", "two")))["1"]
    assert (found.state, found.run, found.judged, found.tests) == ("not_tested", 3, 0, ())
    assert found.reason == "It applied in none of 3 tests, most often for the reason quoted."
    assert found.detail == "“not judged after the trip at 0.837 s”"
    some = rows(result("one-1", let_off), result("one-2", let_off))["1"]
    assert some.reason == (
        "It applied in none of the 2 tests that were run, most often for the reason quoted; others that judge it were"
        " not run."
    )


@pytest.mark.parametrize(
    ("clause", "left_out", "tests", "reason"),
    [
        ({"judged_tests": 3}, (), ("one-1",), "The tests that judge it were not selected for this run."),
        ({"tests": ("long",)}, ("long",), ("one-1",), "The tests that judge it are long and were not asked for"),
        (
            {"judged_tests": 2, "judged_long": 2},
            (),
            ("one-1",),
            "The tests that judge it are long and were not asked for",
        ),
        ({"tests": ("long", "b")}, ("long",), ("one-1",), "The tests that judge it were not selected for this run."),
        ({}, (), ("one-1",), "No test of the profile is judged by it."),
        ({"tests": ("a",)}, (), (), "The tests that judge it were not selected for this run."),
    ],
)
def test_why_nothing_was_judged(clause, left_out, tests, reason):
    """Not selected, long, or of no test at all."""
    profile = PROFILE.model_copy(
        update={"clauses": (ClauseSummary(clause="9", checks=("harmonics",), **clause),), "left_out": left_out}
    )
    found = rows(*(result(name, verdict("ride_through")) for name in tests), profile=profile)["9"]
    assert found.state == "not_tested"
    assert found.reason.startswith(reason)


def test_a_sag_of_the_users_own_runs_no_test_of_the_table():
    """Requirements are judged by it, the rows of the table are not run, and that is the reason told."""
    found = rows(result("sag-90pct-abc", verdict("ride_through"), expect=None))
    assert found["1"].state == "pass"
    assert found["T1"].reason.startswith("A sag of the user's own or a recording was judged")


def test_what_the_profile_leaves_out_ends_the_table():
    """What the text demands and the profile does not judge is said with the profile's own reason."""
    profile = PROFILE.model_copy(
        update={
            "clauses": (),
            "not_covered": (NotCoveredSummary(what="flicker", clause="7", why="no scenario has it"),),
        }
    )
    (found,) = coverage(conclude([], [profile]), Texts("es"))
    (row,) = found.rows
    assert (row.clause, row.about, row.state, row.detail) == ("7", ("flicker",), "not_covered", "no scenario has it")
    assert row.state_word == "fuera de este perfil"
    assert found.tally == (("not_covered", "fuera de este perfil", 1),)


def test_results_of_an_earlier_version_have_no_coverage():
    """They told no clauses: nothing is shown rather than something made up."""
    bare = PROFILE.model_copy(update={"clauses": ()})
    assert coverage(conclude([result("one-1", verdict("ride_through"))], [bare]), Texts()) == ()


def test_the_page_links_each_failure_and_marks_what_is_data():
    """Links lead to the sections of the tests; in a Spanish page what the profile says itself is marked as English."""
    results = conclude(
        [
            result("one-1", verdict("ride_through", Status.FAIL, margin=-0.1)),
            result("two", verdict("ride_through", Status.FAIL, margin=-0.2)),
        ],
        [PROFILE],
        report=ReportDetails(language="es"),
    )
    page = html.render(results, {})
    table = re.search(r'<section class="coverage".*?</section>', page, re.DOTALL)[0]
    targets = re.findall(r'href="#(test-\d+)"', table)
    assert targets[:2] == ["test-2", "test-1"]
    assert all(f'id="{target}"' in page for target in targets)
    assert '<h3 id="coverage-1" lang="en">A &lt;code&gt;</h3>' in table
    assert "<caption>Apartados de code" in table
    assert table.count('scope="col"') == 7
    assert table.count('scope="row"') == len(CLAUSES)
