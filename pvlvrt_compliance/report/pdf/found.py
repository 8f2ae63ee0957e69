"""What was found: the summary, and the matrix of tests and checks."""

from collections.abc import Iterator

from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report.document.baseline import against_baseline, said_of
from pvlvrt_compliance.report.document.front import Front, Place
from pvlvrt_compliance.report.document.matrix import Matrix, Run, matrices
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.report.pdf.blocks import Block, Cell, Column, Heading, Legend, Paragraph, Section, Table
from pvlvrt_compliance.report.pdf.codes import some_of
from pvlvrt_compliance.report.verdicts import Finding, findings, name_of
from pvlvrt_compliance.results import Results, Status, Verdict


def summary_section(results: Results, first: Front, texts: Texts) -> Section:
    """What somebody reads who reads one page only."""
    return Section(texts("pdf.summary"), tuple(_summary(results, first, texts)))


def _summary(results: Results, first: Front, texts: Texts) -> Iterator[Block]:
    yield from _overview(results, texts)
    yield Heading(texts("pdf.worst"))
    if first.worst:
        yield Paragraph(texts("pdf.worst_are"))
        yield _margins(first.worst, texts)
    else:
        yield Paragraph(texts("pdf.no_margin"))
    yield Heading(texts("pdf.marginal"))
    yield Paragraph(texts("pdf.marginal_are" if first.marginal else "pdf.no_marginal"))
    if first.marginal:
        yield _margins(first.marginal, texts)
    yield from _findings(results, texts)
    yield from _baseline(results, texts)


def _overview(results: Results, texts: Texts) -> Iterator[Block]:
    """Tests by profile and verdict."""
    tables = matrices(results)
    counts = results.counts()
    statuses = [status for status in Status if status in counts or any(table.count(status) for table in tables)]
    heads = (Column(texts("matrix.profile"), 2.0), Column(texts("matrix.tests"), 1.0, "right"))
    columns = (*heads, *(Column(texts.named("status", status), 1.0, "right") for status in statuses))
    rows = [
        (
            Cell(table.profile),
            Cell(str(len(table.runs))),
            *(Cell(str(table.count(status) or "–")) for status in statuses),
        )
        for table in tables
    ]
    if rows:
        yield Table(columns, tuple(rows))


def _margins(places: tuple[Place, ...], texts: Texts) -> Table:
    columns = (
        Column(texts("section.heading.check"), 1.2),
        Column(texts("matrix.test"), 1.2),
        Column(texts("section.heading.verdict"), "26mm"),
        Column(texts("section.heading.margin"), "auto", "right"),
        Column(texts("section.heading.uncertainty"), "auto", "right"),
        Column(texts("pdf.share"), "22mm", "right"),
    )
    return Table(columns, tuple(_margin(place, texts) for place in places))


def _margin(place: Place, texts: Texts) -> tuple[Cell, ...]:
    numbers, share = spell.row(place.verdict, texts), place.verdict.relative_margin
    return (
        Cell(texts.named("check", place.verdict.check)),
        Cell(place.test, to=place.number),
        Cell(_state(place.verdict, texts), status=place.verdict.status),
        Cell(numbers.margin),
        Cell(numbers.uncertainty),
        Cell("" if share is None else spell.number(100 * share, "%", 1, sign=True)),
    )


def _state(verdict: Verdict, texts: Texts) -> str:
    """The verdict, and whether the baseline knows it; how near it is to the limit its row tells."""
    return spell.marked(spell.state_in_words(verdict, texts), verdict, texts, without="marginal")


def _findings(results: Results, texts: Texts) -> Iterator[Block]:
    yield Heading(texts("page.findings"))
    found = [finding for finding in findings(results) if finding.is_to_do]
    if not found:
        yield Paragraph(texts("pdf.no_findings"))
        return
    columns = (
        Column(texts("section.heading.verdict"), "24mm"),
        Column(texts("matrix.test"), 1.0),
        Column(texts("section.heading.check"), 1.0),
        Column(texts("pdf.reason"), 2.4),
    )
    numbers = {name_of(test, results): number for number, test in enumerate(results.tests, start=1)}
    rows = [
        (
            Cell(_word(finding, texts), status=finding.status),
            Cell(some_of(finding.tests, texts), to=numbers[finding.tests[0]]),
            Cell(", ".join(texts.named("check", check) for check in finding.checks)),
            Cell(finding.message, english=True),
        )
        for finding in found
    ]
    yield Table(columns, tuple(rows))


def _word(finding: Finding, texts: Texts) -> str:
    """The verdict of a finding, and whether it is known or worse than before."""
    word = texts.named("status", finding.status)
    mark = "known" if finding.is_known else "worse" if finding.worse else ""
    return texts("limit.marked_verdict", verdict=word, marks=texts.named("status", mark)) if mark else word


def _baseline(results: Results, texts: Texts) -> Iterator[Block]:
    """What the baseline of the run makes of it."""
    against = against_baseline(results)
    if against is None:
        return
    yield Heading(texts("baseline.title"))
    yield Paragraph(texts("baseline.means", file=against.file, share=against.share))
    for name, each in against.parts.items():
        yield Heading(texts(f"baseline.{name}", count=len(each)), level=3)
        columns = (
            Column(texts("matrix.test"), 1.0),
            Column(texts("section.heading.check"), 1.0),
            Column(texts("pdf.reason"), 2.4),
        )
        rows = [
            (
                Cell(said.test, to=said.number or None),
                Cell(texts.named("check", said.check)),
                Cell(said_of(said, texts), english=bool(said.text)),
            )
            for said in each
        ]
        yield Table(columns, tuple(rows))
    if against.is_out_of_date:
        yield Paragraph(texts("baseline.up_to_date"), small=True)


def results_section(results: Results, texts: Texts) -> Section:
    """Every test and every check that applied, symbols with a legend; a table a profile."""
    return Section(texts("pdf.results"), tuple(_results(results, texts)), new_page=True)


def _results(results: Results, texts: Texts) -> Iterator[Block]:
    yield Paragraph(texts("pdf.results_are"))
    yield Legend(tuple(Cell(texts.named("status", status), status=status) for status in (*Status, *spell.MARK_SYMBOL)))
    for table in matrices(results):
        yield Heading(texts("pdf.code_of", title=table.title, profile=table.profile) if table.title else table.profile)
        yield _matrix(table, texts)
        if table.idle:
            checks = ", ".join(texts.named("check", check) for check in table.idle)
            yield Paragraph(texts("matrix.idle", checks=checks), small=True)
    for profile in results.profiles:
        if profile.left_out:
            left_out = ", ".join(profile.left_out)
            yield Paragraph(texts("matrix.left_out", profile=profile.id, tests=left_out), small=True)
        if profile.not_run:
            not_run = ", ".join(profile.not_run)
            yield Paragraph(texts("matrix.not_run", profile=profile.id, tests=not_run), small=True)


def _matrix(table: Matrix, texts: Texts) -> Table:
    checks = (Column(texts.named("check", check), "auto", "center") for check in table.checks)
    columns = (
        Column(texts("matrix.test"), "36mm"),
        Column(texts("matrix.verdict"), "7mm", "center"),
        *checks,
        Column(texts("pdf.begins_on"), "7mm", "right"),
        Column(texts("matrix.what"), 1.0),
    )
    return Table(columns, tuple(_run(run) for run in table.runs), upright=True)


def _run(run: Run) -> tuple[Cell, ...]:
    def symbol(status: Status | None, marks: tuple[str, ...]) -> Cell:
        if status is None:
            return Cell("")
        return Cell("".join(spell.MARK_SYMBOL[mark] for mark in marks), status=status)

    return (
        Cell(run.test.id, to=run.number),
        symbol(run.test.status, run.marks),
        *(symbol(cell.status, cell.marks) for cell in run.cells),
        Cell("", page=run.number),
        Cell(run.test.title, small=True, english=True),
    )
