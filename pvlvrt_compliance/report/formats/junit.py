"""JUnit XML, in the dialect of Jenkins' junit-10.xsd: a suite a test, a case a check."""

import itertools
import re
import xml.etree.ElementTree as ET
from collections.abc import Mapping, Sequence

from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.report.verdicts import NOTHING_JUDGED, verdicts
from pvlvrt_compliance.results import ProfileSummary, Results, Status, TestResult, Verdict
from pvlvrt_compliance.results.files import JUNIT

FILE = JUNIT

_NOT_IN_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")

_OUTCOME = {
    Status.FAIL: "failure",
    Status.ERROR: "error",
    Status.NOT_EVALUATED: "error",
    Status.NOT_APPLICABLE: "skipped",
}


def render(results: Results, drawings: Mapping[str, Drawing] | None = None) -> bytes:  # noqa: ARG001
    """Return the results as UTF-8 XML that validates against junit-10.xsd.

    A `fail` is a failure; `error` and `not_evaluated` are errors, told apart by their type; `not_applicable` is
    skipped, and with ``allow_unjudged`` so is `not_evaluated`. What passed has its numbers as output. A run in
    which nothing was judged is an error of its own where none of its cases is. The time of a suite is the length of
    its record (s).
    """
    duration_s = sum(test.duration_s for test in results.tests)
    root = ET.Element("testsuites", name="pvlvrt-check", time=f"{duration_s:.3f}")
    digests = {profile.id: profile for profile in results.profiles}
    taken: set[tuple[str, str]] = set()
    run = {"run_id": results.run_id, "command": str(results.provenance.get("command", ""))}
    outcomes = _OUTCOME | ({Status.NOT_EVALUATED: "skipped"} if results.allow_unjudged else {})
    suites = [_suite(test, digests.get(test.profile), run, outcomes, taken) for test in results.tests]
    if results.nothing_judged and not any(int(suite.get(x, "0")) for suite in suites for x in ("failures", "errors")):
        suites.append(_suite_of_the_run(taken))
    for total in ("tests", "failures", "errors"):
        root.set(total, str(sum(int(suite.get(total, "0")) for suite in suites)))
    root.extend(suites)
    ET.indent(root)
    xml: bytes = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    return xml + b"\n"


def _suite(
    test: TestResult,
    profile: ProfileSummary | None,
    run: Mapping[str, str],
    outcomes: Mapping[Status, str],
    taken: set[tuple[str, str]],
) -> ET.Element:
    classname = ".".join(filter(None, (test.profile, test.id)))
    suite = _of_cases(classname, verdicts(test), outcomes, taken)
    suite.set("time", f"{test.duration_s:.3f}")
    suite.insert(0, _properties(test, profile, run))
    return suite


def _suite_of_the_run(taken: set[tuple[str, str]]) -> ET.Element:
    verdict = Verdict(check="judged", status=Status.NOT_EVALUATED, message=NOTHING_JUDGED)
    return _of_cases("run", [verdict], _OUTCOME, taken)


def _of_cases(
    classname: str, checks: Sequence[Verdict], outcomes: Mapping[Status, str], taken: set[tuple[str, str]]
) -> ET.Element:
    found = [outcomes.get(check.status) for check in checks]
    suite = ET.Element("testsuite", name=_text(classname), tests=str(len(checks)))
    for total, kind in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
        suite.set(total, str(found.count(kind)))
    for check, outcome in zip(checks, found, strict=True):
        name = _unique(_text(classname), _text(check.check), taken)
        case = ET.SubElement(suite, "testcase", classname=_text(classname), name=name)
        if outcome:
            attributes = {"type": check.status.value, "message": _text(check.message)}
            ET.SubElement(case, outcome, attributes).text = _text(_details(check))
        elif details := _details(check):
            ET.SubElement(case, "system-out").text = _text(details)
    return suite


def _properties(test: TestResult, profile: ProfileSummary | None, run: Mapping[str, str]) -> ET.Element:
    values = {
        **run,
        "status": test.status.value,
        "expect": test.expect or "",
        "marginal": ", ".join(check.check for check in test.checks if check.is_marginal),
        "title": test.title,
        "clause": test.clause,
        "confidence": test.confidence,
        "waveforms": test.waveforms or "",
        "profile_digest": profile.digest if profile else "",
    }
    properties = ET.Element("properties")
    for name, value in values.items():
        if value:
            ET.SubElement(properties, "property", name=name, value=_text(value))
    return properties


def _details(check: Verdict) -> str:
    numbers = spell.row(check)
    parts = {
        "measured": numbers.measured,
        "limit": spell.limit_in_words(check),
        "margin": numbers.margin,
        "uncertainty": numbers.uncertainty,
        "at": spell.number(check.at_s, "s"),
        "stretch": check.stretch,
        "clause": check.clause,
        "confidence": check.confidence,
    }
    marginal = ["marginal"] if check.is_marginal else []
    return "; ".join([*marginal, *(f"{name} {value}" for name, value in parts.items() if value)])


def _unique(classname: str, name: str, taken: set[tuple[str, str]]) -> str:
    candidates = itertools.chain([name], (f"{name} ({n})" for n in itertools.count(2)))
    free = next(c for c in candidates if (classname, c) not in taken)
    taken.add((classname, free))
    return free


def _text(value: str) -> str:
    return _NOT_IN_XML.sub("\ufffd", value)
