"""The codes that were judged against, clause by clause, and what of them was not read in an official text."""

from collections.abc import Iterator, Sequence

from pvlvrt_compliance.report.document.coverage import Coverage, CoverageRow, State, coverage
from pvlvrt_compliance.report.document.front import Code, front
from pvlvrt_compliance.report.format import CONFIDENCE_MEANING
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.report.pdf.blocks import Block, Cell, Column, Facts, Heading, Items, Paragraph, Section, Table
from pvlvrt_compliance.results import ClauseSummary, ProfileSummary, Results, Status

_MOST_TESTS = 6
"""Tests that are named beside a clause or a finding; the matrix has all of them."""

_STATUS_OF: dict[State, Status] = {
    "error": Status.ERROR,
    "not_evaluated": Status.NOT_EVALUATED,
    "fail": Status.FAIL,
    "pass": Status.PASS,
    "not_tested": Status.NOT_APPLICABLE,
    "not_covered": Status.NOT_APPLICABLE,
}
"""The colour of a state."""


def codes_section(results: Results, texts: Texts) -> Section:
    """Each code, its clauses with their marks, the numbers to be checked first, and what the marks mean."""
    codes = front(results, texts).against
    blocks = [
        block for profile, code in zip(results.profiles, codes, strict=True) for block in _code(profile, code, texts)
    ]
    return Section(texts("pdf.code"), (*blocks, *_marks(texts)), new_page=True)


def _code(profile: ProfileSummary, code: Code, texts: Texts) -> Iterator[Block]:
    yield Heading(texts("pdf.code_of", title=code.title, profile=profile.id))
    yield Facts(tuple((fact.name, fact.text) for fact in code.facts))
    if profile.clauses:
        yield Heading(texts("pdf.clauses"), level=3)
        yield Paragraph(texts("pdf.clauses_are"))
        columns = (
            Column(texts("coverage.column.clause"), "60mm"),
            Column(texts("coverage.column.about")),
            Column(texts("pdf.mark"), "24mm"),
        )
        yield Table(columns, tuple(_clause(clause, texts) for clause in profile.clauses))
    yield Heading(texts("pdf.unverified"), level=3)
    if profile.notes:
        yield Paragraph(texts("pdf.unverified_are"))
        yield Items(tuple(Cell(note, english=True) for note in profile.notes))
    else:
        yield Paragraph(texts("pdf.none_unverified"))


def _clause(clause: ClauseSummary, texts: Texts) -> tuple[Cell, ...]:
    checks = dict.fromkeys((*clause.checks, *(part.partition(".")[0] for part in clause.parts)))
    named = [texts.named("check", check) for check in checks]
    return (
        Cell(clause.clause),
        Cell("; ".join((*named, *([", ".join(clause.tests)] if clause.tests else [])))),
        Cell(texts.named("coverage.mark", clause.confidence) if clause.confidence else ""),
    )


def _marks(texts: Texts) -> Iterator[Block]:
    yield Heading(texts("page.marks"))
    yield Paragraph(texts("pdf.marks_are"))
    columns = (Column(texts("pdf.mark"), "34mm"), Column(texts("pdf.meaning")))
    rows = [
        (Cell(texts.named("coverage.mark", mark), strong=True), Cell(texts.named("page.mark_means", mark)))
        for mark in CONFIDENCE_MEANING
    ]
    yield Table(columns, tuple(rows))


def coverage_section(results: Results, texts: Texts) -> Section:
    """What became of every clause, and why one was not tested."""
    blocks = [block for table in coverage(results, texts) for block in _coverage(table, texts)]
    if not blocks:
        return Section(texts("pdf.coverage"), (Paragraph(texts("pdf.no_clauses")),))
    return Section(texts("pdf.coverage"), (Paragraph(texts("coverage.intro")), *blocks), new_page=True)


def _coverage(table: Coverage, texts: Texts) -> Iterator[Block]:
    yield Heading(texts("pdf.code_of", title=table.profile.title, profile=table.profile.id))
    tally = (texts("pdf.counted", count=count, verdict=word) for _, word, count in table.tally)
    yield Paragraph(", ".join(tally))
    heads = (
        Column(texts("coverage.column.clause"), 1.1),
        Column(texts("coverage.column.state"), "27mm"),
        Column(texts("coverage.column.judged"), "17mm", "right"),
        Column(texts("coverage.column.margin"), "auto", "right"),
        Column(texts("coverage.column.where"), 1.9),
    )
    yield Table(heads, tuple(_covered(row, texts) for row in table.rows))


def some_of(tests: Sequence[str], texts: Texts) -> str:
    """The first of some tests by name, and how many more there are."""
    more = len(tests) - _MOST_TESTS
    return ", ".join([*tests[:_MOST_TESTS], *([texts("coverage.further", count=more)] if more > 0 else [])])


def _covered(row: CoverageRow, texts: Texts) -> tuple[Cell, ...]:
    """A clause; what is in no profile is told by what it demands."""
    told = " ".join(part for part in (row.reason, row.detail) if part)
    what = "; ".join(row.about)
    if row.state == "not_covered" and row.clause:
        told = " ".join(part for part in (f"{what}:", told) if part)
    places = some_of([name for _, name in row.tests], texts)
    return (
        Cell(row.clause or what, english=not row.clause),
        Cell(row.state_word, status=_STATUS_OF[row.state]),
        Cell(texts("coverage.judged_in", judged=row.judged, run=row.run) if row.run else ""),
        Cell(row.margin),
        Cell(" ".join(part for part in (places, told) if part), to=row.tests[0][0] if row.tests else None),
    )
