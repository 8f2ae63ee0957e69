"""What is made of a record where that is, is what the reports would have made of its drawing."""

import pytest

from pvlvrt_compliance.report.drawing.of_record import FORMS, made
from pvlvrt_compliance.report.drawing.of_test import drawing
from pvlvrt_compliance.report.formats import formats, html, of_made


@pytest.fixture(scope="module")
def recorded(make_test, make_evidence, record):
    """What the common test was judged by, its result, and its drawing."""
    result = make_test()
    evidence = make_evidence(record, result)
    return evidence, result, drawing(evidence, result, buckets=100)


@pytest.mark.parametrize("language", ["en", "es"])
def test_a_page_is_the_same_of_figures_made_with_the_record(recorded, make_results, language):
    """Figures that have waited for their page are those that the page makes of a drawing, to the letter."""
    evidence, result, drawn = recorded
    results = make_results(result)
    results = results.model_copy(update={"report": results.report.model_copy(update={"language": language})})
    waiting = {result.key: made(evidence, result, buckets=100, language=language, forms=["page"])}
    (page,) = (found for found in formats() if found.file == html.FILE)
    assert of_made(page, results, waiting) == html.render(results, {result.key: drawn})


def test_only_what_is_asked_for_is_made(recorded):
    """A record is drawn in the forms that a report takes, and for none that nobody takes."""
    evidence, result, _ = recorded
    assert made(evidence, result, buckets=100, language="en", forms=[]) == {}
    assert set(made(evidence, result, buckets=100, language="en", forms=["drawing"])) == {"drawing"}


def test_every_format_takes_a_form_that_there_is():
    """What a format shows is a form of drawings, or it shows none; a report that is drawn is given something."""
    shown = {found.name: found.shows for found in formats()}
    assert {form for form in shown.values() if form} == set(FORMS)
