"""A comparison as JUnit XML, in the dialect of junit-10.xsd: a suite a test, a case a verdict of either run."""

import xml.etree.ElementTree as ET
from collections.abc import Sequence

from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report.comparison.words import cells_of, profiles_in_words, summary
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.report.xml_text import unique_name, xml_text
from pvlvrt_compliance.results.comparison import Changed, Comparison
from pvlvrt_compliance.results.verdict import Verdict

_TOTALS = {"failures": "failure", "errors": "error", "skipped": "skipped"}


def render(comparison: Comparison) -> bytes:
    """Return the comparison as UTF-8 XML that validates against junit-10.xsd.

    A regression is a failure, what can no longer be judged an error; a verdict that is gone without being a regression
    is skipped. Whatever else has changed has the change as output. Where nothing is in both runs, that is an error.
    """
    root = ET.Element("testsuites", name="pvlvrt-check compare", time="0.000")
    taken: set[tuple[str, str]] = set()
    by_test: dict[str, list[Changed]] = {}
    for change in comparison.changes:
        by_test.setdefault(change.test, []).append(change)
    tests = dict.fromkeys([*comparison.unchanged, *by_test])
    root.extend(
        _suite(test, by_test.get(test, ()), comparison.unchanged.get(test, ()), comparison, taken) for test in tests
    )
    if not comparison.in_both:
        root.append(_nothing_in_both(comparison))
    for total in ("tests", "failures", "errors"):
        root.set(total, str(sum(int(suite.get(total, "0")) for suite in root)))
    ET.indent(root)
    xml: bytes = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    return xml + b"\n"


def _suite(
    test: str, changes: Sequence[Changed], unchanged: Sequence[str], comparison: Comparison, taken: set[tuple[str, str]]
) -> ET.Element:
    suite = ET.Element("testsuite", name=xml_text(test), time="0.000")
    suite.append(_properties(comparison))
    for change in changes:
        case = _case(suite, test, change.check, taken)
        kind = outcome_of(change)
        if kind:
            attributes = {"type": change.what, "message": xml_text(in_words(change))}
            ET.SubElement(case, kind, attributes).text = xml_text(_details(change))
        else:
            ET.SubElement(case, "system-out").text = xml_text(f"{in_words(change)}; {_details(change)}")
    for check in unchanged:
        _case(suite, test, check, taken)
    suite.set("tests", str(len(changes) + len(unchanged)))
    kinds = [outcome_of(change) for change in changes]
    for total, kind in _TOTALS.items():
        suite.set(total, str(kinds.count(kind)))
    return suite


def outcome_of(change: Changed) -> str:
    """What a change is in JUnit: `failure`, `error`, `skipped`, or nothing of one that passes."""
    if change.is_newly_unjudged:
        return "error"
    if change.regression:
        return "failure"
    return "skipped" if change.what == "gone" else ""


def in_words(change: Changed) -> str:
    """``pass before, fail now``, and what has become of the margin."""
    was, now = (_status(one) for one in (change.old, change.new))
    cells = cells_of(change)
    margins = " -> ".join(filter(None, (cells.old_margin, cells.new_margin)))
    lost = f" ({cells.lost} of the limit)" if cells.lost else ""
    return f"{was} before, {now} now{f'; margin {margins}{lost}' if margins else ''}"


def _status(verdict: Verdict | None) -> str:
    return "not there" if verdict is None else spell.verdict_in_words(verdict)


def _details(change: Changed) -> str:
    """What both runs say of it."""
    return "\n".join(
        f"{word}: {spell.state_in_words(one)}; {one.message or spell.limit_in_words(one)}"
        for word, one in (("old", change.old), ("new", change.new))
        if one is not None
    )


def _case(suite: ET.Element, test: str, check: str, taken: set[tuple[str, str]]) -> ET.Element:
    name = unique_name(xml_text(test), xml_text(check), taken)
    return ET.SubElement(suite, "testcase", classname=xml_text(test), name=name)


def _properties(comparison: Comparison) -> ET.Element:
    texts = Texts()
    values = {
        "old": comparison.old.name,
        "old_run_id": comparison.old.run_id,
        "new": comparison.new.name,
        "new_run_id": comparison.new.run_id,
        "fail_on": comparison.fail_on,
        "profiles": "; ".join(profiles_in_words(comparison.profiles, texts)),
        "summary": summary(comparison, texts),
    }
    properties = ET.Element("properties")
    for name, value in values.items():
        if value:
            ET.SubElement(properties, "property", name=name, value=xml_text(value))
    return properties


def _nothing_in_both(comparison: Comparison) -> ET.Element:
    suite = ET.Element("testsuite", name="comparison", tests="1", failures="0", errors="1", skipped="0", time="0.000")
    case = ET.SubElement(suite, "testcase", classname="comparison", name="in both runs")
    said = summary(comparison, Texts())
    ET.SubElement(case, "error", {"type": "nothing", "message": xml_text(said)}).text = xml_text(said)
    return suite
