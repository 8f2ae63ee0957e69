import io
import json
import xml.etree.ElementTree as ET

import lxml.html
import pytest
from rich.console import Console

from pvlvrt_compliance.report import console
from pvlvrt_compliance.report.formats import html, junit, results_json
from pvlvrt_compliance.report.verdicts import findings
from pvlvrt_compliance.results import Status, Verdict

JUNIT_OUTCOME = {"failure": {"fail"}, "error": {"error", "not_evaluated"}, "skipped": {"not_applicable"}}


def _terminal(results, width=80):
    out = io.StringIO()
    Console(file=out, width=width).print(console.render(results))
    return out.getvalue()


def _in_junit(results):
    case = ET.fromstring(junit.render(results)).find(".//testcase[@name='reactive_support']")
    outcome = next((child for child in case if child.tag != "system-out"), None)
    if outcome is None:
        return "pass"
    assert outcome.get("type") in JUNIT_OUTCOME[outcome.tag]
    return outcome.get("type")


def _in_html(results):
    page = lxml.html.document_fromstring(html.render(results, {}))
    row = page.xpath("//tr[@data-check='reactive_support']")[0]
    word = row.xpath(".//span[contains(@class, 'badge')]")[0].text_content()
    assert row.get("data-status").replace("_", " ") in word
    return row.get("data-status"), page.get_element_by_id("verdict").get("data-status")


def _in_json(results):
    found = json.loads(results_json.render(results))
    checks = {check["check"]: check["status"] for check in found["tests"][0]["checks"]}
    return checks["reactive_support"], found["status"]


def _in_terminal(results):
    line = next(x for x in _terminal(results).splitlines() if x.startswith("reactive_support"))
    words = {status: status.replace("_", " ") for status in Status}
    return next(status for status, word in words.items() if f" {word} " in line)


@pytest.mark.parametrize("status", list(Status))
def test_one_flipped_verdict_flips_everywhere(make_test, make_results, status):
    """Terminal, HTML, JUnit and JSON all follow the one verdict, whichever it is."""
    checks = tuple(
        check.model_copy(update={"status": status}) if check.check == "reactive_support" else check
        for check in make_test().checks
    )
    results = make_results(make_test(checks=checks))
    overall = Status.PASS if status is Status.NOT_APPLICABLE else status
    assert results.status is overall
    assert _in_terminal(results) == status
    assert _in_junit(results) == status
    assert _in_html(results) == (status, overall)
    assert _in_json(results) == (status, overall)
    assert console.summary_line(results).startswith(overall.replace("_", " ").upper())


@pytest.mark.parametrize("status", [Status.ERROR, Status.NOT_EVALUATED])
def test_a_test_without_checks_still_shows_its_verdict(make_test, make_results, status):
    """A test that ended before any check is not silently left out of any format."""
    results = make_results(make_test(), make_test("broken", checks=(), status=status))
    suites = ET.fromstring(junit.render(results)).findall("testsuite")
    assert [suite.get("errors") for suite in suites] == ["0", "1"]
    assert results.counts()[status] == 1
    assert "broken: no check was evaluated" in " ".join(_terminal(results).split())
    assert "no check was evaluated" in html.render(results, {})


def test_findings_join_what_has_one_reason(make_test, make_results):
    """Tests and checks that share verdict and reason are read once, worst first; a pass is no finding."""
    tripped = tuple(Verdict(check=name, status=Status.NOT_APPLICABLE, message="tripped") for name in ("x", "y"))
    failed = (Verdict(check="ride_through", status=Status.FAIL, message="opened"), *tripped)
    found = findings(make_results(make_test("one", checks=failed), make_test("two", checks=failed)))
    assert [(item.tests, item.checks, item.message) for item in found] == [
        (("one", "two"), ("ride_through",), "opened"),
        (("one", "two"), ("x", "y"), "tripped"),
    ]


@pytest.mark.parametrize("several", [False, True])
def test_terminal_reads_at_80_columns_without_colour(make_test, make_results, several):
    """No line is longer than 80 columns, no number is cut, and brackets are not taken for markup."""
    tests = [make_test("VD3-partial-2", Status.FAIL), make_test("VD6-full-1")][: 2 if several else 1]
    text = _terminal(make_results(*tests))
    assert max(map(len, text.splitlines())) <= 80
    assert "…" not in text
    assert "\x1b" not in text
    for piece in (
        "156.5 kvar",
        "160.7",
        "-4.2",
        "not applicable",
        "confirmed",
        "[& a half]",
        "4.2 kvar below the curve",
    ):
        assert piece in " ".join(text.split())


def test_terminal_without_tests(make_results):
    """A run without tests prints a summary and no error."""
    assert "0 tests" in _terminal(make_results())


def test_a_run_in_which_nothing_was_judged(make_test, make_results):
    """Where nothing applied the run is not evaluated, and terminal and page say why."""
    checks = (Verdict(check="x", status=Status.NOT_APPLICABLE, message="demands nothing at 0.100 pu"),)
    results = make_results(make_test(checks=checks, status=Status.NOT_APPLICABLE))
    assert results.status is Status.NOT_EVALUATED
    told = "1 not applicable; nothing was judged: no requirement passed or failed"
    assert console.summary_line(results) == f"NOT EVALUATED: 1 test; checks: {told}"
    page = lxml.html.document_fromstring(html.render(results, {}))
    assert page.get_element_by_id("verdict").get("data-status") == "not_evaluated"
    assert "Nothing was judged: no requirement passed or failed." in page.find(".//header").text_content()


def test_an_exit_status_that_is_let_off_is_told(make_test, make_results):
    """Only where it would have been another one."""
    good, bad = make_results(make_test()), make_results(make_test(checks=()))
    assert "exit-zero" not in console.summary_line(good, exit_zero=True) + console.summary_line(bad)
    assert console.summary_line(bad, exit_zero=True).endswith("; exit status 0 by --exit-zero")


def test_what_is_allowed_is_told(make_test, make_results):
    """With --allow-unjudged the headline is what the run counts as, with the counts of what was found beside it."""
    checks = (*make_test().checks, Verdict(check="x", status=Status.NOT_EVALUATED, message="no voltage"))
    plain = make_results(make_test(checks=checks))
    allowed = plain.model_copy(update={"allow_unjudged": True})
    assert console.summary_line(plain) == "NOT EVALUATED: 1 test; checks: 1 not evaluated, 3 pass, 1 not applicable"
    told = "1 test; checks: 1 not evaluated, 3 pass, 1 not applicable"
    assert console.summary_line(allowed) == f"PASS by --allow-unjudged: {told}"
    assert "Counts as pass (--allow-unjudged)." in html.render(allowed, {})
    assert _in_json(allowed)[1] == _in_json(plain)[1] == "not_evaluated"
