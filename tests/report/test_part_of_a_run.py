"""A run of some tests or checks says so in every format: it never looks like the whole."""

import csv
import io
import json
import xml.etree.ElementTree as ET

import lxml.html
import pytest

from pvlvrt_compliance.report import console, marked
from pvlvrt_compliance.report.document.coverage import coverage
from pvlvrt_compliance.report.document.front import front
from pvlvrt_compliance.report.formats import badge, github, gitlab, html, junit, markdown, verdicts
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.results import (
    ClauseSummary,
    ProfileSummary,
    Results,
    Status,
    TestResult,
    Verdict,
    conclude,
    exit_status,
)

CLAUSES = (
    ClauseSummary(clause="1", checks=("ride_through",), judged_tests=3),
    ClauseSummary(clause="1.1", parts=("ride_through.envelope",), judged_tests=3),
    ClauseSummary(clause="2", checks=("dc_ripple",), judged_tests=3),
    ClauseSummary(clause="3", checks=("current_limit", "dc_ripple"), judged_tests=3),
    ClauseSummary(clause="T1", tests=("one", "two")),
    ClauseSummary(clause="T3", tests=("three",)),
)


def verdict(check, status=Status.PASS, clause=""):
    """A verdict on a limit of 1 pu."""
    return Verdict(check=check, status=status, measured=0.5, limit=1.0, margin=0.5, unit="pu", clause=clause)


def run(*checks, ended_at="", interrupted=False, **aside):
    """A run of one test with these verdicts; ``aside`` is what the summary of its profile says."""
    worst = min((each.status for each in checks), key=list(Status).index)
    test = TestResult(id="one", profile="code", status=worst, checks=checks, expect="ride_through")
    profile = ProfileSummary(id="code", title="A code", digest="0", clauses=CLAUSES, **aside)
    return conclude([test], [profile], ended_at=ended_at, interrupted=interrupted)


PARTS = [
    ({"selected_checks": ("dc_ripple",)}, "only dc_ripple judged", "Only these checks were judged"),
    ({"not_selected": ("two", "three")}, "2 tests not selected", "2 of their tests were not selected"),
    ({"not_selected": ("two",)}, "1 test not selected", "1 of their tests was not selected"),
    (
        {"not_run": ("two",), "ended_at": "code.one"},
        "1 not run after one (--fail-fast)",
        "The run ended at one, the first test that was not passed (--fail-fast). 1 selected test was not run.",
    ),
    ({"not_run": ("two", "three")}, "2 not run when it was interrupted", "The run was interrupted. 2 selected tests"),
]


@pytest.mark.parametrize(("aside", "in_short", "in_words"), PARTS)
def test_every_format_says_it(aside, in_short, in_words):
    """The line of the terminal, the page for a merge request, JUnit and the first page; a whole run says nothing."""
    results, whole = run(verdict("dc_ripple"), **aside), run(verdict("dc_ripple"))
    assert console.summary_line(results) == f"{console.summary_line(whole)}; {in_short}"
    assert marked.plain(console.summary_line(results)) in markdown.render(results, {})
    suite = ET.fromstring(junit.render(results)).find("testsuite")
    assert suite.find("properties/property[@name='selection']").get("value") == in_short
    assert ET.fromstring(junit.render(whole)).find(".//property[@name='selection']") is None
    page = lxml.html.document_fromstring(html.render(results, {}))
    assert in_words in page.find(".//header").text_content()
    assert front(whole, Texts()).on_the_run == ()


def test_an_interrupted_run_is_red_in_every_format(monkeypatch):
    """All that was finished has passed, and none of what a service reads is green."""
    monkeypatch.setenv("GITHUB_ACTIONS", "true")
    results = run(verdict("dc_ripple"), not_run=("two", "three"), interrupted=True)
    said = "the run was interrupted: 1 of 3 tests were finished"
    assert exit_status(results) == 3
    tree = ET.fromstring(junit.render(results))
    assert (tree.get("tests"), tree.get("errors"), tree.get("failures")) == ("2", "1", "0")
    assert tree.find(".//error").get("message") == said
    (found,) = (entry for entry in json.loads(gitlab.render(results)) if entry["severity"] != "info")
    assert (found["severity"], said in found["description"]) == ("blocker", True)
    (line,) = github.console(results).splitlines()
    assert line.startswith(f"::error title=Grid code::{said}; ")
    for text in (github.render(results), markdown.render(results, {})):
        assert text.startswith("### ! Grid code: ERROR")
        assert said in text
    assert badge.in_words(results) == "error"


def test_an_interruption_is_no_part_of_what_was_found():
    """The id of a run is of its findings."""
    assert run(verdict("dc_ripple"), interrupted=True).run_id == run(verdict("dc_ripple")).run_id


@pytest.mark.parametrize(("aside", "in_short", "in_words"), PARTS)
def test_what_ci_reads_says_it(aside, in_short, in_words):
    """An entry for information in the code quality report, a column of the table, the title and colour of the badge."""
    del in_words
    results, whole = run(verdict("dc_ripple"), **aside), run(verdict("dc_ripple"))
    (entry,) = json.loads(gitlab.render(results))
    assert (entry["severity"], entry["check_name"]) == ("info", "selection")
    assert entry["description"].endswith(in_short)
    assert json.loads(gitlab.render(whole)) == []
    assert [row["selection"] for row in csv.DictReader(io.StringIO(verdicts.render(results)))] == [in_short]
    assert [row["selection"] for row in csv.DictReader(io.StringIO(verdicts.render(whole)))] == [""]
    part, all_of_it = (ET.fromstring(badge.render(each)) for each in (results, whole))
    assert "; a partial run: " in part.get("aria-label")
    assert all_of_it.get("aria-label") == "grid code: pass 1/1"
    assert colour(part) != colour(all_of_it)


def colour(root):
    """Of the half of a badge that has the verdict."""
    return root.findall("{http://www.w3.org/2000/svg}path")[1].get("fill")


@pytest.mark.parametrize(
    ("status", "aside", "words"),
    [
        (Status.PASS, {"not_selected": ("two", "three")}, "pass 1 of 3"),
        (Status.FAIL, {"not_selected": ("two",), "not_run": ("three",)}, "fail 1 of 3"),
        (Status.PASS, {"selected_checks": ("dc_ripple",)}, "pass 1/1, some checks"),
    ],
)
def test_a_badge_counts_all_tests_of_the_profile(status, aside, words):
    """Those too that were not selected, or that the run ended before."""
    assert badge.in_words(run(verdict("dc_ripple", status), **aside)) == words


def test_what_was_not_run_is_named():
    """The page lists the tests."""
    page = lxml.html.document_fromstring(html.render(run(verdict("dc_ripple"), not_run=("two", "three")), {}))
    (line,) = [p.text_content() for p in page.iterfind(".//p[@class='left-out']")]
    assert line == "Selected, but not run, since the run of code ended before: two, three."


def test_results_keep_it():
    """What is left aside is read back from results.json."""
    results = run(verdict("dc_ripple"), ended_at="code.one", selected_checks=("dc_ripple",), not_run=("two",))
    assert Results.model_validate_json(results.model_dump_json()) == results


def states(results):
    """What became of each clause, and why."""
    (found,) = coverage(results, Texts())
    return {row.clause: (row.state, row.reason) for row in found.rows}


NOT_SELECTED = ("not_tested", Texts()("coverage.reason.check_not_selected"))
PARTLY = ("not_tested", Texts()("coverage.reason.partly"))


def test_no_clause_is_passed_by_a_check_that_was_not_selected():
    """Passed is a clause all of whose checks were judged; of a test's procedure only some were, so it is not."""
    found = states(run(verdict("dc_ripple", clause="2"), selected_checks=("dc_ripple",)))
    assert found["2"] == ("pass", "")
    assert found["1"] == found["1.1"] == NOT_SELECTED
    assert found["3"] == found["T1"] == PARTLY
    assert found["T3"][0] == "not_tested"


def test_what_was_judged_besides_is_no_pass_of_its_clause():
    """A trip is judged whatever was selected: its failure counts, that it was permitted shows nothing of the code."""
    passed = run(verdict("dc_ripple", clause="2"), verdict("ride_through", clause="1"), selected_checks=("dc_ripple",))
    assert states(passed)["1"] == NOT_SELECTED
    failed = run(verdict("ride_through", Status.FAIL, clause="1"), selected_checks=("dc_ripple",))
    assert (states(failed)["1"][0], states(failed)["T1"][0]) == ("fail", "fail")


def test_a_failure_is_a_failure_of_all_that_it_is_of():
    """Some checks are enough to fail a clause."""
    found = states(run(verdict("dc_ripple", Status.FAIL, clause="2"), selected_checks=("dc_ripple",)))
    assert {clause: state for clause, (state, _) in found.items() if state == "fail"}.keys() == {"2", "3", "T1"}


def test_a_clause_whose_tests_the_run_ended_before():
    """It says so; where others that judge it were not selected either, nobody knows."""
    texts, judged = Texts(), verdict("current_limit")
    assert states(run(judged, not_run=("three",)))["T3"][1] == texts("coverage.reason.not_run")
    assert states(run(judged, not_run=("three",)))["1"][1] == texts("coverage.reason.not_run")
    assert states(run(judged, not_run=("three",), not_selected=("two",)))["1"][1] == texts(
        "coverage.reason.not_selected"
    )


@pytest.mark.parametrize("aside", ["not_selected", "not_run"])
def test_a_procedure_is_passed_when_all_of_its_tests_are(aside):
    """One of two runs shows the half of it; one that failed is enough to fail it."""
    partly = ("not_tested", Texts()("coverage.reason.partly_run"))
    found = states(run(verdict("dc_ripple", clause="2"), **{aside: ("two",)}))
    assert (found["T1"], found["2"]) == (partly, ("pass", ""))
    assert states(run(verdict("dc_ripple", clause="2"), **{aside: ("three",)}))["T1"] == ("pass", "")
    assert states(run(verdict("dc_ripple", Status.FAIL, clause="2"), **{aside: ("two",)}))["T1"][0] == "fail"
