"""What the reports show of a judged record, made where that is, in the forms that they have asked for."""

from collections.abc import Callable, Collection, Mapping
from functools import cache
from typing import Any

from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.report.drawing.of_test import drawing
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.report.page.section import section_of
from pvlvrt_compliance.results import TestResult


def _as_drawn(drawn: Drawing, _result: TestResult, _texts: Texts) -> Drawing:
    return drawn


FORMS: Mapping[str, Callable[[Drawing, TestResult, Texts], Any]] = {"drawing": _as_drawn, "page": section_of}
"""What a drawing may become: itself, for a report that draws it as no other does, or the section of a page."""


def made(
    evidence: Evidence, result: TestResult, *, buckets: int, language: str, forms: Collection[str]
) -> dict[str, Any]:
    """A record in each of some `FORMS`; it is drawn once, and not at all where none is asked for.

    Parameters
    ----------
    evidence : Evidence
        What the test was judged by.
    result : TestResult
    buckets : int
        Of a curve, see `of_test.drawing`.
    language : str
        Of the words in it.
    forms : collection of str
        Names of `FORMS`.
    """
    if not forms:
        return {}
    drawn = drawing(evidence, result, buckets=buckets)
    return {form: FORMS[form](drawn, result, _texts(language)) for form in forms}


@cache
def _texts(language: str) -> Texts:
    return Texts(language)
