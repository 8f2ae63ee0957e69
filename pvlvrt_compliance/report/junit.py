"""JUnit XML, in the dialect of Jenkins' junit-10.xsd: a suite a test, a case a check."""

import itertools
import re
import xml.etree.ElementTree as ET
from collections.abc import Mapping

from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report.verdicts import verdicts
from pvlvrt_compliance.results import ProfileSummary, Results, Status, TestResult, Verdict

_NOT_IN_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")

_OUTCOME = {
    Status.FAIL: "failure",
    Status.ERROR: "error",
    Status.NOT_EVALUATED: "error",
    Status.NOT_APPLICABLE: "skipped",
}


def render(results: Results) -> bytes:
    """Return the results as UTF-8 XML that validates against junit-10.xsd.

    A `fail` is a failure; `error` and `not_evaluated` are errors, told apart by their type; `not_applicable` is
    skipped. The time of a suite is the length of its record (s).
    """
    duration_s = sum(test.duration_s for test in results.tests)
    root = ET.Element("testsuites", name="pvlvrt-check", time=f"{duration_s:.3f}")
    digests = {profile.id: profile for profile in results.profiles}
    taken: set[tuple[str, str]] = set()
    run = {"run_id": results.run_id, "command": str(results.provenance.get("command", ""))}
    suites = [_suite(test, digests.get(test.profile), run, taken) for test in results.tests]
    for total in ("tests", "failures", "errors"):
        root.set(total, str(sum(int(suite.get(total, "0")) for suite in suites)))
    root.extend(suites)
    ET.indent(root)
    xml: bytes = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    return xml + b"\n"


def _suite(
    test: TestResult, profile: ProfileSummary | None, run: Mapping[str, str], taken: set[tuple[str, str]]
) -> ET.Element:
    classname = ".".join(filter(None, (test.profile, test.id)))
    checks = verdicts(test)
    outcomes = [_OUTCOME.get(check.status) for check in checks]
    suite = ET.Element("testsuite", name=_text(classname), tests=str(len(checks)), time=f"{test.duration_s:.3f}")
    for total, kind in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
        suite.set(total, str(outcomes.count(kind)))
    suite.append(_properties(test, profile, run))
    for check in checks:
        name = _unique(_text(classname), _text(check.check), taken)
        case = ET.SubElement(suite, "testcase", classname=_text(classname), name=name)
        if outcome := _OUTCOME.get(check.status):
            verdict = ET.SubElement(case, outcome, type=check.status.value, message=_text(check.message))
            verdict.text = _text(_details(check))
    return suite


def _properties(test: TestResult, profile: ProfileSummary | None, run: Mapping[str, str]) -> ET.Element:
    values = {
        **run,
        "status": test.status.value,
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
    parts = {**numbers._asdict(), "at": spell.number(check.at_s, "s"), "clause": check.clause}
    parts["confidence"] = check.confidence
    return "; ".join(f"{name} {value}" for name, value in parts.items() if value)


def _unique(classname: str, name: str, taken: set[tuple[str, str]]) -> str:
    candidates = itertools.chain([name], (f"{name} ({n})" for n in itertools.count(2)))
    free = next(c for c in candidates if (classname, c) not in taken)
    taken.add((classname, free))
    return free


def _text(value: str) -> str:
    return _NOT_IN_XML.sub("\ufffd", value)
