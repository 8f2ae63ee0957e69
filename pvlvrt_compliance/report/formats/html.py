"""`report.html`: one file that needs no network."""

import re
from collections.abc import Iterable, Mapping, Sequence
from functools import cache, partial
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

from jinja2 import Environment
from markupsafe import Markup

from pvlvrt_compliance.report import cursor_table, measurement_table, templates
from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report.document.baseline import against_baseline, said_of
from pvlvrt_compliance.report.document.coverage import coverage
from pvlvrt_compliance.report.document.front import Front, front, margin_in_words
from pvlvrt_compliance.report.document.matrix import matrices
from pvlvrt_compliance.report.document.scenario import imposed_rows, scenario_words
from pvlvrt_compliance.report.drawing import colours
from pvlvrt_compliance.report.drawing.in_page import Figures, figures_of, styled
from pvlvrt_compliance.report.drawing.looks import Looks
from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.report.drawing.plotly_js import plotly_packed
from pvlvrt_compliance.report.language import BASE, Texts
from pvlvrt_compliance.report.provenance import provenance_groups
from pvlvrt_compliance.report.verdicts import findings, is_verified, may_decide, name_of, verdicts
from pvlvrt_compliance.resources import resource_folder
from pvlvrt_compliance.results import JUDGED, Results, Status, TestResult, Verdict
from pvlvrt_compliance.results.files import REPORT

FILE = REPORT
OF_WHOLE_RUNS = True
SHOWS = "page"

_WORST = 5  # margins that the first page shows at once; the others are folded below them

_INDENTATION = re.compile(r"\n\s+")
_LEFT_TO_READERS = re.compile(r"</t[dhr]>\s*(?=</?t[bdhr])")

_CHECK_COLUMNS = ("check", "measured", "limit", "margin", "uncertainty", "at", "verdict", "clause", "confidence")
_CLAUSE_COLUMNS = ("clause", "about", "state", "judged", "margin", "where", "confidence")
_IMPOSED_COLUMNS = (
    *("window", "span", "asked_positive", "measured_positive", "difference"),
    *("asked_negative", "measured_negative", "difference"),
)


class _Way(NamedTuple):
    """From a failed test to the one before and the one after it; 0 where there is none."""

    before: int
    after: int


def render(results: Results, drawings: Mapping[str, Drawing | Figures]) -> str:
    """Return the report as one HTML document, in the language of ``results.report``.

    Parameters
    ----------
    results : Results
    drawings : mapping
        Drawings of tests, or what has been made of them for a page, by their key; a test without one says so.

    Raises
    ------
    UsageError
        When there is no such language.
    PvlvrtError
        When the templates or plotly's JavaScript are missing from the installation.
    """
    folder = resource_folder("reports")
    texts = Texts(results.report.language)
    used = {test.key: drawings[test.key] for test in results.tests if test.key in drawings}
    looks = Looks()
    figures = {name: styled(_figures(drawn, texts), looks) for name, drawn in used.items()}
    return (
        environment(folder, texts.language)
        .get_template("report.html.j2")
        .render(
            _of_run(results, texts),
            name=partial(name_of, results=results),
            figures=figures,
            plotly_packed=plotly_packed() if used else "",
            css=read(folder, "report.css", "figures.css", "cursors.css") + Markup(colours.style() + looks.style()),
            js=read(folder, "page.js"),
            figures_js=read(folder, "figures.js"),
        )
    )


def _figures(drawn: Drawing | Figures, texts: Texts) -> Figures:
    return drawn if isinstance(drawn, Figures) else figures_of(drawn, texts)


def read(folder: Path, *names: str) -> Markup:
    """Files of ours one after the other, as they stand."""
    return Markup("\n".join((folder / name).read_text(encoding="utf-8") for name in names))


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
        "folded": _folded(texts),
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


def _folded(texts: Texts) -> dict[str, tuple[str, ...]]:
    """Headings of the tables whose cells stand below each other on a narrow screen."""
    columns = {
        "checks": ("section.heading", _CHECK_COLUMNS),
        "imposed": ("scenario.column", _IMPOSED_COLUMNS),
        "clauses": ("coverage.column", _CLAUSE_COLUMNS),
        "profiles": ("page.column", ("profile", "title", "digest")),
    }
    told = {table: tuple(texts(f"{of}.{name}") for name in names) for table, (of, names) in columns.items()}
    cursors = tuple(f"{name}, {unit}" if unit else name for name, unit in cursor_table.headings(texts))
    return {**told, "cursors": cursors}


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


@cache
def environment(folder: Path, language: str) -> Environment:
    """Templates with what all of them call, compiled once a language."""
    texts = Texts(language)
    made = templates.environment(folder, __file__, lstrip_blocks=True)
    made.filters.update(css_string=_css_string, lean=_lean)
    made.globals.update(
        texts=texts,
        english="" if texts.language == BASE else Markup(f' lang="{BASE}"'),
        verdicts=verdicts,
        row=partial(spell.row, texts=texts),
        is_bare=_is_bare,
        limit_in_words=partial(spell.limit_in_words, texts=texts),
        marginal_in_words=partial(spell.marginal_in_words, texts=texts),
        said_of=partial(said_of, texts=texts),
        baseline_in_words=partial(spell.baseline_in_words, texts=texts),
        marks_of=spell.marks_of,
        marks_in_words=partial(spell.marks_in_words, texts=texts),
        mark_symbol=spell.MARK_SYMBOL,
        why=partial(_why, texts),
        margin_in_words=partial(margin_in_words, texts=texts),
        stretch_unless_told=spell.stretch_unless_told,
        number=spell.number,
        label=partial(texts.named, "check"),
        names=partial(_names, texts),
        word=lambda status: texts(f"status.{status}"),
        symbol=lambda status: spell.STATUS_SYMBOL[Status(status)],
        is_verified=is_verified,
        window_headings=measurement_table.window_headings,
        measured_rows=measurement_table.measured_rows,
        beliefs=partial(_beliefs, texts),
        scenario_words=scenario_words,
        imposed_rows=imposed_rows,
        cursor_headings=cursor_table.headings,
        cursor_note=cursor_table.note,
        cursor_parts=cursor_table.cursor_parts,
    )
    return made


def _lean(markup: str) -> Markup:
    """Markup without indentation and the end tags that HTML leaves to the reader: of 494 tests they are 2 MB."""
    return Markup(_LEFT_TO_READERS.sub("", _INDENTATION.sub("\n", markup)))


def _css_string(text: str) -> Markup:
    """A text as CSS shows it: all but plain letters and digits is escaped, so that nothing ends string or sheet."""
    plain = (letter if letter.isascii() and letter.isalnum() else f"\\{ord(letter):x} " for letter in text)
    return Markup(f'"{"".join(plain)}"')


def _is_bare(check: Verdict) -> bool:
    """Whether a verdict has no number, so that its reason may stand where the numbers would."""
    return check.status not in JUDGED and check.measured is check.limit is check.margin is check.at_s is None


def _why(texts: Texts, check: Verdict) -> Markup:
    """Why a verdict has no number: what is not judged for a trip in the page's own words, else the check's message."""
    if texts.language == BASE:
        return Markup.escape(check.message)
    if check.after_trip_s is not None:
        return Markup.escape(spell.state_in_words(check, texts))
    return Markup('<span lang="{}">{}</span>').format(BASE, check.message)


def _names(texts: Texts, checks: Iterable[str]) -> str:
    return ", ".join(texts.named("check", name) for name in checks)


def _beliefs(texts: Texts, test: TestResult) -> str:
    return measurement_table.beliefs_in_words(test.measurements.controller, texts)


def _marks(results: Results) -> list[str]:
    """Marks that occur beside the verdicts, in the order of the legend."""
    used = {check.confidence for test in results.tests for check in test.checks}
    used |= {test.confidence for test in results.tests}
    return [mark for mark in spell.CONFIDENCE_MEANING if mark in used]
