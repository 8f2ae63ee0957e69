"""`report.html`: one file that needs no network."""

from collections.abc import Mapping, Sequence
from functools import partial
from itertools import pairwise
from typing import Any, NamedTuple

from markupsafe import Markup

from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report.document.baseline import against_baseline
from pvlvrt_compliance.report.document.coverage import coverage
from pvlvrt_compliance.report.document.front import Front, front
from pvlvrt_compliance.report.document.matrix import matrices
from pvlvrt_compliance.report.drawing import colours
from pvlvrt_compliance.report.drawing.looks import Looks
from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.report.drawing.plotly_js import plotly_packed
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.report.page.environment import environment, read
from pvlvrt_compliance.report.page.section import Section, section_of, told
from pvlvrt_compliance.report.provenance import provenance_groups
from pvlvrt_compliance.report.verdicts import findings, may_decide, name_of
from pvlvrt_compliance.resources import resource_folder
from pvlvrt_compliance.results import Results, Status, TestResult
from pvlvrt_compliance.results.files import REPORT

FILE = REPORT
OF_WHOLE_RUNS = True
SHOWS = "page"

_WORST = 5  # margins that the first page shows at once; the others are folded below them


class _Way(NamedTuple):
    """From a failed test to the one before and the one after it; 0 where there is none."""

    before: int
    after: int


def render(results: Results, drawings: Mapping[str, Drawing | Section]) -> str:
    """Return the report as one HTML document, in the language of ``results.report``.

    Parameters
    ----------
    results : Results
    drawings : mapping
        Drawings of tests, or the sections that have been made of them, by their key; a test without one says so.

    Raises
    ------
    UsageError
        When there is no such language.
    PvlvrtError
        When the templates or plotly's JavaScript are missing from the installation.
    """
    folder = resource_folder("reports")
    texts = Texts(results.report.language)
    sections = [_section(drawings.get(test.key), test, texts) for test in results.tests]
    has_figures = any(section.figures for section in sections)
    looks = Looks(look for section in sections for look in section.looks)
    return (
        environment(folder, texts.language)
        .get_template("report.html.j2")
        .render(
            _of_run(results, texts),
            name=partial(name_of, results=results),
            sections=sections,
            has_figures=has_figures,
            plotly_packed=plotly_packed() if has_figures else "",
            css=read(folder, "report.css", "figures.css", "cursors.css") + Markup(colours.style() + looks.style()),
            js=read(folder, "page.js"),
            figures_js=read(folder, "figures.js"),
        )
    )


def _section(made: Drawing | Section | None, test: TestResult, texts: Texts) -> Section:
    """The section of a test, of what has been made of its record; what a baseline has marked is told anew."""
    if made is None or isinstance(made, Section):
        return told(made or Section(), test, texts)
    return section_of(made, test, texts)


def _of_run(results: Results, texts: Texts) -> dict[str, Any]:
    """What the page says of the run as a whole, and how its parts lead to each other."""
    first, tables = front(results, texts), matrices(results)
    verdict = texts(f"status.{results.status}").upper()
    return {
        "results": results,
        "title": texts("page.title", verdict=verdict),
        "running_title": _running_title(results, first, texts),
        "front": first,
        "worst_shown": _WORST,
        "counts": results.counts(),
        "may_decide": bool(may_decide(results)),
        "tables": tables,
        "coverage": coverage(results, texts),
        "statuses": [status for status in Status if any(status in {t.status, *t.statuses} for t in results.tests)],
        "check_names": sorted({name for table in tables for name in table.checks}),
        "row_of": {
            run.number: group.runs[0].number for table in tables for group in table.groups for run in group.runs
        },
        "ways": _ways(first.failures),
        "marked": _marked(results),
        "baseline": against_baseline(results),
        "findings": findings(results),
        "number_of": {name_of(test, results): n for n, test in enumerate(results.tests, start=1)},
        "marks": _marks(results),
        "provenance": provenance_groups(results.provenance, texts),
    }


def _marked(results: Results) -> dict[str, int]:
    """How many verdicts have each mark, those that occur."""
    found = [mark for finding in results.verdicts() for mark in spell.marks_of(finding.verdict)]
    return {mark: found.count(mark) for mark in spell.MARK_SYMBOL if mark in found}


def _running_title(results: Results, first: Front, texts: Texts) -> str:
    """What stands above every printed page: the number of the document where one was given, and what it is."""
    number, tested = results.report.fields.get("number", ""), results.report.fields.get("object", "")
    codes = ", ".join(code.title for code in first.against[:1])
    return " · ".join(part for part in (number, texts("front.kind"), tested or codes) if part)


def _ways(failed: Sequence[int]) -> dict[int, _Way]:
    """For every failed test the one before and after it."""
    befores = {after: before for before, after in pairwise(failed)}
    afters = dict(pairwise(failed))
    return {number: _Way(befores.get(number, 0), afters.get(number, 0)) for number in failed}


def _marks(results: Results) -> list[str]:
    """Marks that occur beside the verdicts, in the order of the legend."""
    used = {check.confidence for test in results.tests for check in test.checks}
    used |= {test.confidence for test in results.tests}
    return [mark for mark in spell.CONFIDENCE_MEANING if mark in used]
