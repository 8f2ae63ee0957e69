"""What a baseline makes of a run, in every report: in words and by a sign, never by a colour alone."""

import io
import re
import xml.etree.ElementTree as ET

import lxml.html
import pytest
from rich.console import Console

from baselines import case_of, held, run_of, verdict
from pvlvrt_compliance.report import console
from pvlvrt_compliance.report.document.baseline import against_baseline
from pvlvrt_compliance.report.document.front import front
from pvlvrt_compliance.report.formats import html, junit, markdown
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.report.pdf.found import summary_section
from pvlvrt_compliance.results import ReportDetails

ENTRIES = (
    "p.known x fail -1.0 kvar # ticket 42 <b>",
    "p.grown x fail -1.0 kvar # ticket 43",
    "p.lost x pass +5.0 kvar",
    "p.better x fail -1.0 kvar # ticket 44",
    "p.gone x fail -1.0 kvar # ticket 45",
)


@pytest.fixture(scope="module")
def run():
    """A test of each kind, and a new failure among them."""
    found = {
        "known": verdict(message="as ever"),
        "grown": verdict(margin=-2.0, message="more than ever"),
        "lost": verdict("pass", 1.0, message="hardly"),
        "better": verdict("pass", 1.0),
        "new": verdict(message="never before"),
    }
    tests = [case_of(name, made) for name, made in found.items()]
    return held(run_of(*tests), *ENTRIES, is_gone=lambda _: True)


def _text(results, width=80):
    file = io.StringIO()
    Console(width=width, file=file).print(console.render(results))
    return " ".join(file.getvalue().split())


def _in_spanish(results):
    return results.model_copy(update={"report": ReportDetails(language="es")})


def test_the_terminal_tells_what_is_new_before_what_is_known(run):
    """New and worse verdicts with their reasons, then how many are known, what is better, what is gone."""
    text = _text(run)
    told = [
        "fail: x in grown: more than ever; worse than in the baseline: was fail, -1.0 kvar; now fail, -2.00 kvar",
        "fail: x in new: never before",
        "pass: x in lost: hardly; worse than in the baseline: was pass, +5.0 kvar; now pass, +1.00 kvar",
        "known: 1 failure that b.txt knows",
        "better: x in p.better: was fail, -1.0 kvar; now pass, +1.00 kvar",
        "gone: x in p.gone: was fail, -1.0 kvar; now no such test",
        "FAIL: 5 tests; checks: 3 fail (1 known), 2 pass; 2 worse",
    ]
    places = [text.find(line) for line in told]
    assert -1 not in places
    assert places == sorted(places)
    assert "fail: x in known" not in text
    assert text.count("fail (known)") == 1
    assert [text.count(f"{word} (worse)") for word in ("fail", "pass")] == [1, 1]


def test_what_the_run_counts_as_is_told_with_the_file():
    """A run whose failures are all known counts as a pass."""
    known = held(run_of(case_of("known", verdict())), *ENTRIES)
    assert console.summary_line(known) == "PASS by --baseline b.txt: 1 test; checks: 1 fail (1 known)"
    assert front(known, Texts()).on_the_run == ("Counts as pass (--baseline b.txt).",)
    lost = held(run_of(case_of("lost", verdict("pass", 1.0))), *ENTRIES)
    assert console.summary_line(lost) == "FAIL by --baseline b.txt: 1 test; checks: 1 pass; 1 worse"


@pytest.mark.parametrize(
    ("share", "made", "head"),
    [
        (1.0, verdict(), "PASS by --baseline b.txt, tolerance 100 %: 1 test; checks: 1 fail (1 known)"),
        (0.0, verdict(), "PASS by --baseline b.txt, tolerance 0 %: 1 test; checks: 1 fail (1 known)"),
        (0.01, verdict("pass", 4.0), "PASS: 1 test; checks: 1 pass"),
        (0.2, verdict("pass", 4.0), "PASS: 1 test; checks: 1 pass; held against b.txt, tolerance 20 %"),
    ],
)
def test_another_tolerance_than_the_usual_is_told(share, made, head):
    """Whether it lets a known failure go, or a margin that was lost."""
    run = held(run_of(case_of("known", made)), *ENTRIES, tolerance=share)
    assert console.summary_line(run) == head
    if " by " in head:
        assert front(run, Texts()).on_the_run == (f"Counts as pass ({head.partition(' by ')[2].partition(':')[0]}).",)


def test_of_many_tests_only_what_is_not_known_is_listed(run):
    """The overview names the tests that somebody has to look into."""
    many = run.model_copy(update={"tests": run.tests * 13})
    text = _text(many)
    assert re.search(r"fail: x in p: grown, new, ", text)
    assert re.search(r"pass: x in p: lost, ", text)
    assert "known: 13 failures that b.txt knows" in text
    assert " known," not in text


def test_junit_skips_what_is_known_and_fails_what_is_worse(run):
    """A known failure says why; one that has grown and a lost margin say what has become of them."""
    root = ET.fromstring(junit.render(run))
    cases = {case.get("classname"): [(child.tag, child.attrib) for child in case] for case in root.iter("testcase")}
    assert cases["p.known"] == [("skipped", {"type": "known_failure", "message": "known failure: ticket 42 <b>"})]
    ((grown, said),) = cases["p.grown"]
    assert (grown, said["type"]) == ("failure", "fail")
    assert said["message"].startswith("more than ever; worse than in the baseline: was fail, -1.0 kvar")
    ((lost, said),) = cases["p.lost"]
    assert (lost, said["type"]) == ("failure", "worse")
    assert cases["p.new"][0][0] == "failure"
    assert {key: root.get(key) for key in ("tests", "failures", "errors")} == {
        "tests": "5",
        "failures": "3",
        "errors": "0",
    }


@pytest.mark.parametrize(
    ("status", "allowed", "outcome"),
    [
        ("not_evaluated", False, "error"),
        ("not_evaluated", True, "failure"),
        ("error", True, "error"),
        ("not_applicable", True, "failure"),
    ],
)
def test_junit_never_skips_what_was_judged_before(status, allowed, outcome):
    """What passed and can no longer be judged, or no longer applies, is red, whatever may stay unjudged."""
    made = run_of(case_of("t", verdict(status, None), verdict("pass", 1.0, "y")), allow_unjudged=allowed)
    (case,) = ET.fromstring(junit.render(held(made, "p.t x pass +1.0 kvar"))).findall(".//testcase[@name='x']")
    assert [child.tag for child in case] == [outcome]


def test_the_page_marks_each_verdict_in_words_and_by_a_sign(run):
    """In the matrix, beside the verdict, and in a part of its own; texts of the file are no markup."""
    page = lxml.html.fromstring(html.render(run, {}))
    signs = {sign.get("aria-label"): sign.text for sign in page.xpath("//table[@class='signs']//td/span")}
    assert signs == {"fail, known": "✗=", "fail, worse": "✗↓", "pass, worse": "✓↓", "pass": "✓", "fail": "✗"}
    badges = [" ".join(cell.text_content().split()) for cell in page.xpath("//td[@class='of-verdict']")]
    assert badges[0] == "✗ fail = known: known failure: ticket 42 <b>"
    assert badges[2].startswith("✓ pass ↓ worse: worse than in the baseline: was pass, +5.0 kvar; now pass")
    (part,) = page.xpath("//section[@aria-labelledby='baseline']")
    said = " ".join(part.text_content().split())
    assert "b.txt" in said
    assert "1 %" in said
    for words in ("2 verdicts worse", "1 known failure", "ticket 42 <b>", "1 verdict better", "1 entry of what"):
        assert words in said
    front_page = " ".join(page.xpath("//header")[0].text_content().split())
    assert "among them 1 = known" in front_page
    assert "among them 2 ↓ worse" in front_page
    assert page.xpath("//input[@value='news']")


KNOWN, NEW, LOST, GOOD = (verdict(margin=-1.0), verdict(margin=-2.0), verdict("pass", 1.0), verdict("pass", 5.0))


@pytest.mark.parametrize(
    ("made", "first"),
    [
        ([GOOD, KNOWN, KNOWN, NEW], 4),
        ([GOOD, KNOWN, LOST, NEW], 3),
        ([GOOD, KNOWN, verdict("not_evaluated", None), NEW], 4),
        ([GOOD, GOOD, KNOWN, KNOWN], 3),
        ([GOOD, GOOD, LOST, GOOD], 3),
        ([GOOD, GOOD, GOOD, GOOD], None),
    ],
)
def test_the_way_to_the_first_failure_leads_to_what_makes_the_run_red(made, first):
    """Past what is known, wherever that stands; only where nothing else is, to that."""
    entries = [f"p.t{n} x {'fail -1.0' if each in (KNOWN, NEW) else 'pass +5.0'} kvar" for n, each in enumerate(made)]
    run = held(run_of(*(case_of(f"t{n}", each) for n, each in enumerate(made))), *entries)
    page = lxml.html.fromstring(html.render(run, {}))
    links = [link.get("href") for link in page.xpath("//a[text()='To the first failure' or text()='First failure']")]
    assert links == ([] if first is None else [f"#test-{first}"] * 2)


def test_without_a_baseline_the_page_says_nothing_of_one():
    """Neither a part nor a filter."""
    page = lxml.html.fromstring(html.render(run_of(case_of("t", verdict())), {}))
    assert not page.xpath("//section[@aria-labelledby='baseline'] | //input[@value='news']")
    assert against_baseline(run_of()) is None


def test_a_row_of_runs_is_known_where_all_of_its_failures_are():
    """One sign stands for them on a phone."""
    at = [{"scenario": {"point_on_wave_deg": angle}} for angle in (0.0, 90.0)]
    runs = [case_of(f"t-{n}", verdict(), **fields) for n, fields in enumerate(at, start=1)]
    both = ("p.t-1 x fail -1.0 kvar", "p.t-2 x fail -1.0 kvar")
    for entries, sign in ((both, "✗="), (both[:1], "✗")):
        page = lxml.html.fromstring(html.render(held(run_of(*runs), *entries), {}))
        assert {one.text for one in page.xpath("//span[@class='one']/span")} == {sign}


def test_the_document_says_the_same(run):
    """Marks in the tables of the PDF, and a part of its own, in both languages."""
    for results, word, title in (
        (run, "fail (known)", "Against the baseline"),
        (_in_spanish(run), "no conforme (conocido)", "Frente a la línea base"),
    ):
        texts = Texts(results.report.language)
        blocks = repr(summary_section(results, front(results, texts), texts))
        for said in (word, title, "b.txt", "ticket 42 <b>", "was pass, +5.0 kvar; now pass, +1.00 kvar"):
            assert said in blocks


def test_a_comment_says_how_much_of_the_file_is_out_of_date(run):
    """With the command that brings it up to date."""
    said = markdown.render(run)
    assert "1 better, 1 gone; <code>pvlvrt-check baseline update b.txt</code>" in said
    assert "Out of date" not in markdown.render(held(run_of(case_of("known", verdict())), ENTRIES[0]))
