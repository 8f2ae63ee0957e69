"""JUnit XML, in the dialect of Jenkins' junit-10.xsd: a suite a test, a case a check."""

import itertools
import xml.etree.ElementTree as ET
from collections.abc import Mapping, Sequence

from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.report.gate import Outcome, Told, numbers_in_words, of_the_run, told_of
from pvlvrt_compliance.report.provenance import out_of_range_in_words
from pvlvrt_compliance.report.verdicts import left_aside
from pvlvrt_compliance.report.xml_text import unique_name as _unique
from pvlvrt_compliance.report.xml_text import xml_text as _text
from pvlvrt_compliance.results import ProfileSummary, Results, Status, TestResult, Verdict
from pvlvrt_compliance.results.files import JUNIT

FILE = JUNIT

_KNOWN, _WORSE = "known_failure", "worse"
_TOTALS = {"failures": Outcome.FAILURE, "errors": Outcome.ERROR, "skipped": Outcome.SKIPPED}


def render(results: Results, drawings: Mapping[str, Drawing] | None = None) -> bytes:  # noqa: ARG001
    """Return the results as UTF-8 XML that validates against junit-10.xsd.

    A `fail` is a failure; `error` and `not_evaluated` are errors, told apart by their type; `not_applicable` is
    skipped, and so are a failure that the baseline knows and, with ``allow_unjudged``, `not_evaluated`. What is worse
    than in the baseline is a failure. What passed has its numbers as output. A run that was interrupted is an error of
    its own, and so is one in which nothing was judged where none of its cases is.

    The time of a suite is what its test took (s, wall time), in equal shares of its cases, which have one record. How
    long that is stands among the properties of the suite and in the text of its cases.
    """
    root = ET.Element("testsuites", name="pvlvrt-check")
    root.set("time", _seconds(sum(_milliseconds(test) for test in results.tests)))
    digests = {profile.id: profile for profile in results.profiles}
    taken: set[tuple[str, str]] = set()
    run = {
        "run_id": results.run_id,
        "command": str(results.provenance.get("command", "")),
        "selection": "; ".join(left_aside(results)),
        "controller_out_of_range": out_of_range_in_words(results.provenance),
    }
    cases = [told_of(test, allow_unjudged=results.allow_unjudged) for test in results.tests]
    suites = [
        _suite(test, of, digests.get(test.profile), run, taken) for test, of in zip(results.tests, cases, strict=True)
    ]
    if nothing := of_the_run(results, itertools.chain(*cases)):
        suites.append(_of_cases("run", [nothing], taken))
    for total in ("tests", "failures", "errors"):
        root.set(total, str(sum(int(suite.get(total, "0")) for suite in suites)))
    root.extend(suites)
    ET.indent(root)
    xml: bytes = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    return xml + b"\n"


def _suite(
    test: TestResult,
    cases: Sequence[Told],
    profile: ProfileSummary | None,
    run: Mapping[str, str],
    taken: set[tuple[str, str]],
) -> ET.Element:
    suite = _of_cases(".".join(filter(None, (test.profile, test.id))), cases, taken)
    suite.set("time", _seconds(_milliseconds(test)))
    for case, share in zip(suite, _shares(_milliseconds(test), len(cases)), strict=True):
        case.set("time", _seconds(share))
    suite.insert(0, _properties(test, profile, run))
    return suite


def _of_cases(classname: str, cases: Sequence[Told], taken: set[tuple[str, str]]) -> ET.Element:
    suite = ET.Element("testsuite", name=_text(classname), tests=str(len(cases)))
    found = [each.outcome for each in cases]
    for total, outcome in _TOTALS.items():
        suite.set(total, str(found.count(outcome)))
    for each in cases:
        name = _unique(_text(classname), _text(each.verdict.check), taken)
        case = ET.SubElement(suite, "testcase", classname=_text(classname), name=name)
        details = _details(each)
        if each.outcome is not Outcome.PASSED:
            attributes = {"type": _type(each.verdict), "message": _text(each.reason)}
            # GitLab shows the text where there is one, and then never the message.
            said = "\n".join(
                filter(None, [each.reason, each.verdict.message if each.verdict.is_known else "", details])
            )
            ET.SubElement(case, each.outcome, attributes).text = _text(said)
        elif details:
            ET.SubElement(case, "system-out").text = _text(details)
    return suite


def _type(verdict: Verdict) -> str:
    if verdict.is_known:
        return _KNOWN
    return _WORSE if verdict.is_worse and verdict.status is not Status.FAIL else verdict.status.value


def _properties(test: TestResult, profile: ProfileSummary | None, run: Mapping[str, str]) -> ET.Element:
    values = {
        **run,
        "status": test.status.value,
        "expect": test.expect or "",
        "marginal": ", ".join(check.check for check in test.checks if check.is_marginal),
        "known": ", ".join(check.check for check in test.checks if check.is_known),
        "worse": ", ".join(check.check for check in test.checks if check.is_worse),
        "title": test.title,
        "clause": test.clause,
        "confidence": test.confidence,
        "record_s": f"{test.duration_s:.3f}" if test.duration_s else "",
        "waveforms": test.waveforms or "",
        "profile_digest": profile.digest if profile else "",
    }
    properties = ET.Element("properties")
    for name, value in values.items():
        if value:
            ET.SubElement(properties, "property", name=name, value=_text(value))
    return properties


def _details(each: Told) -> str:
    record = f"record {spell.number(each.test.duration_s, 's')}" if each.test.duration_s else ""
    return "; ".join(filter(None, [numbers_in_words(each.verdict), record]))


def _milliseconds(test: TestResult) -> int:
    return round(1e3 * test.wall_time_s)


def _shares(whole: int, count: int) -> list[int]:
    """Equal parts of a whole number, the first of them by one larger where that does not go: they add up to it."""
    part, left = divmod(whole, count)
    return [part + (k < left) for k in range(count)]


def _seconds(milliseconds: int) -> str:
    return f"{milliseconds / 1e3:.3f}"
