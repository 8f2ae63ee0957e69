"""One result feeds all: a verdict that is another, or that a baseline knows, is another in every format."""

import io
import json
import re
import xml.etree.ElementTree as ET
from collections.abc import Callable
from typing import NamedTuple

import lxml.html
import pytest
from rich.console import Console

from pvlvrt_compliance.report import console
from pvlvrt_compliance.report.formats import formats, github, names
from pvlvrt_compliance.results import Status, exit_status
from runner import commands
from told import FAILED, IDLE, KNOWN, PASSED, UNJUDGED, WORSE, run_of

NEIGHBOUR = PASSED.model_copy(update={"check": "neighbour"})
MET = FAILED.model_copy(update={"status": Status.PASS, "measured": 60.0, "margin": 10.0, "message": ""})

STATES = {
    "pass": MET,
    "fail": FAILED,
    "known": KNOWN,
    "worse": MET.model_copy(update={"worse": WORSE.worse}),
    "known, worse": KNOWN.model_copy(update={"worse": WORSE.worse}),
    "not evaluated": UNJUDGED.model_copy(update={"check": FAILED.check}),
    "not applicable": IDLE.model_copy(update={"check": FAILED.check}),
}
RUNS = {state: run_of((NEIGHBOUR, verdict)) for state, verdict in STATES.items()}
RED = {"fail": 1, "worse": 1, "known, worse": 1, "not evaluated": 1}
KNOWN_IN = {"known": 1}


class Count(NamedTuple):
    """How many verdicts fail the run, and how many are known failures, where a format tells them apart."""

    red: int
    known: int | None


def _terminal(results) -> str:
    out = io.StringIO()
    Console(file=out, width=80).print(console.render(results))
    return out.getvalue()


def _in_words(text) -> Count:
    """By the line of summary, the last: what failed, less what is known of it, and what is worse."""
    text = " ".join(text[text.rindex(" test; checks: ") :].split())
    number = {
        name: int((re.search(rf"(\d+) {name}\b", text) or [0, 0])[1]) for name in ("fail", "not evaluated", "known")
    }
    worse_alone = "1 worse" in text and not number["fail"]
    return Count(number["fail"] + number["not evaluated"] + worse_alone - number["known"], number["known"])


def _junit(content) -> Count:
    root = ET.fromstring(content)
    known = [each for each in root.iter("skipped") if each.get("message").startswith("known failure")]
    return Count(int(root.get("failures")) + int(root.get("errors")), len(known))


def _json(content) -> Count:
    checks = [check for test in json.loads(content)["tests"] for check in test["checks"]]
    known = [check["known"] and not check["worse"] for check in checks]
    bad = [bool(check["worse"]) or check["status"] in ("fail", "error", "not_evaluated") for check in checks]
    return Count(sum(bad) - sum(known), sum(known))


def _gitlab(content) -> Count:
    severities = [entry["severity"] for entry in json.loads(content)]
    return Count(len(severities) - severities.count("info"), severities.count("info"))


def _verdicts(content) -> Count:
    red = len(re.findall(r",(failure|error),(?:yes|no),", content))
    return Count(red, content.count(f",{KNOWN.known_reason},,"))


def _badge(content) -> Count:
    words = ET.fromstring(content).get("aria-label")
    red = re.search(r"(?:fail|error|not judged) (\d+)/", words)
    known = re.search(r"(\d+) known", words)
    return Count(int(red[1]) if red else 0, int(known[1]) if known else 0)


def _page(content) -> Count:
    """Of the HTML report: badges of verdicts, and of what a baseline says of them."""
    row = lxml.html.document_fromstring(content).xpath("//tr[@data-check='reactive_support']")[0]
    badges = " ".join(badge.text_content() for badge in row.xpath(".//span[contains(@class, 'badge')]"))
    known, worse = "known" in badges, "worse" in badges
    bad = worse or any(word in badges for word in ("fail", "not evaluated"))
    return Count(int(bad and not known), int(known))


def _markdown(content) -> Count:
    red = re.search(r"\*\*(\d+) verdicts? fails? the run", content)
    known = re.search(r"<summary>(\d+) known failure", content)
    return Count(int(red[1]) if red else 0, int(known[1]) if known else 0)


READERS: dict[str, Callable[..., Count]] = {
    "badge": _badge,
    "github": _markdown,
    "gitlab": _gitlab,
    "html": _page,
    "json": _json,
    "junit": _junit,
    "markdown": _markdown,
    "verdicts": _verdicts,
}
BY_EYE = {"pdf"}
"""Laid out by a program of its own: tests/report/formats/test_pdf.py."""

READABLE = [pytest.param(form, id=form.name) for form in formats() if form.name in READERS]
every_state = pytest.mark.parametrize("state", STATES)


def test_no_format_is_forgotten():
    """Whatever is put into the folder has a reader here."""
    assert set(READERS) | BY_EYE == set(names())


@every_state
@pytest.mark.parametrize("form", READABLE)
def test_each_says_the_same(form, state):
    """By its own words every format has as many verdicts that fail the run, and as many known ones, as there are."""
    assert READERS[form.name](form.render(RUNS[state], {})) == (RED.get(state, 0), KNOWN_IN.get(state, 0))


@pytest.mark.parametrize("form", READABLE)
def test_each_changes_with_the_verdict(form):
    """Passed, failed, known and worse than before are four different files."""
    made = {form.render(RUNS[state], {}) for state in ("pass", "fail", "known", "worse")}
    assert len(made) == 4


@every_state
def test_terminal_annotations_and_exit_status_agree(state):
    """What is printed counts the same, and the status is 0 where nothing is red."""
    results = RUNS[state]
    expected = Count(RED.get(state, 0), KNOWN_IN.get(state, 0))
    assert _in_words(_terminal(results)) == expected
    told = [
        each for each in commands("\n".join(github.annotations(results))) if each.properties["title"] != "Grid code"
    ]
    assert Count(*([each.name for each in told].count(kind) for kind in ("error", "notice"))) == expected
    assert (exit_status(results) == 0) is (expected.red == 0)
