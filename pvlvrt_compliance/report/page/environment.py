"""Templates of pages, with what all of them call."""

import re
from collections.abc import Iterable
from functools import cache, partial
from pathlib import Path

from jinja2 import Environment
from markupsafe import Markup

from pvlvrt_compliance.report import cursor_table, measurement_table, templates
from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report.document.baseline import said_of
from pvlvrt_compliance.report.document.front import margin_in_words
from pvlvrt_compliance.report.document.scenario import imposed_rows, scenario_words
from pvlvrt_compliance.report.language import BASE, Texts
from pvlvrt_compliance.report.verdicts import is_verified, verdicts
from pvlvrt_compliance.results import JUDGED, Status, TestResult, Verdict

_INDENTATION = re.compile(r"\n\s+")
_LEFT_TO_READERS = re.compile(r"</t[dhr]>\s*(?=</?t[bdhr])")

_CHECK_COLUMNS = ("check", "measured", "limit", "margin", "uncertainty", "at", "verdict", "clause", "confidence")
_CLAUSE_COLUMNS = ("clause", "about", "state", "judged", "margin", "where", "confidence")
_IMPOSED_COLUMNS = (
    *("window", "span", "asked_positive", "measured_positive", "difference"),
    *("asked_negative", "measured_negative", "difference"),
)


@cache
def environment(folder: Path, language: str) -> Environment:
    """Templates with what all of them call, compiled once a language."""
    texts = Texts(language)
    made = templates.environment(folder, __file__, lstrip_blocks=True)
    made.filters.update(css_string=_css_string, lean=lean)
    made.globals.update(
        texts=texts,
        english="" if texts.language == BASE else Markup(f' lang="{BASE}"'),
        folded=_folded(texts),
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


def read(folder: Path, *names: str) -> Markup:
    """Files of ours one after the other, as they stand."""
    return Markup("\n".join((folder / name).read_text(encoding="utf-8") for name in names))


def lean(markup: str) -> Markup:
    """Markup without indentation and the end tags that HTML leaves to the reader: of 494 tests they are 2 MB."""
    return Markup(_LEFT_TO_READERS.sub("", _INDENTATION.sub("\n", markup)))


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
