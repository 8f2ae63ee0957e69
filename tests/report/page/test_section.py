"""The section of a test that was made with its record is the one that the page would have made."""

import pytest

from pvlvrt_compliance.report.drawing.of_record import made
from pvlvrt_compliance.report.drawing.of_test import drawing
from pvlvrt_compliance.report.formats import html
from pvlvrt_compliance.report.made_file import pack, unpack
from pvlvrt_compliance.results import Status


@pytest.fixture(scope="module")
def failed(make_test, make_evidence, record):
    """A test that failed, its drawing, and its section."""
    result = make_test(reactive=Status.FAIL)
    evidence = make_evidence(record, result)
    section = made(evidence, result, buckets=100, language="en", forms=["page"])["page"]
    return result, drawing(evidence, result, buckets=100), section


def test_what_a_baseline_has_marked_is_told_anew(failed, make_results):
    """Marks come once all is judged: a section from before is not shown, whatever it says."""
    result, drawn, section = failed
    checks = tuple(
        check.model_copy(update={"known": True, "known_reason": "ticket 42"}) if check.status is Status.FAIL else check
        for check in result.checks
    )
    results = make_results(result.model_copy(update={"checks": checks}))
    page = html.render(results, {result.key: section})
    assert "ticket 42" not in section.judged
    assert page.count("ticket 42") >= 2  # among the findings, and in the section
    assert page == html.render(results, {result.key: drawn})


def test_words_of_a_part_are_not_kept(failed, make_results):
    """A part keeps figures alone: what is said of a test the page says itself, whatever stands in the part's file."""
    result, _, section = failed
    kept = unpack(pack({result.key: {"page": section}}))[result.key]["page"]
    assert (kept.judged, kept.measured, kept.checks) == ("", "", None)
    assert kept.figures == section.figures
    results = make_results(result)
    assert html.render(results, {result.key: kept}) == html.render(results, {result.key: section})
