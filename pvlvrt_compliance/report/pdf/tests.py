"""A part of the document for each test: what happened, how it was judged, what was measured, and its figures."""

from collections.abc import Iterator, Mapping

from pvlvrt_compliance.report import cursor_table
from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report.document.scenario import imposed_rows, scenario_words
from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.report.measurement_table import beliefs_in_words, measured_rows, window_headings
from pvlvrt_compliance.report.pdf.blocks import Block, Cell, Column, Heading, Paragraph, Section, Table
from pvlvrt_compliance.report.pdf.figures import pictures
from pvlvrt_compliance.report.verdicts import name_of, verdicts
from pvlvrt_compliance.results import Results, TestResult, Verdict


def tests_section(results: Results, drawings: Mapping[str, Drawing], texts: Texts) -> Section:
    """Every test in its order."""
    blocks = (
        block
        for number, test in enumerate(results.tests, start=1)
        for block in _test(number, test, name_of(test, results), drawings.get(test.key), texts)
    )
    note = Paragraph(texts("plot.caption"), small=True)
    return Section(texts("pdf.tests"), (note, *blocks) if drawings else tuple(blocks), new_page=True)


def _test(number: int, test: TestResult, name: str, drawing: Drawing | None, texts: Texts) -> Iterator[Block]:
    verdict = texts.named("status", test.status)
    yield Heading(texts("pdf.test_heading", test=name, verdict=verdict), test=number)
    if test.title:
        yield Paragraph(test.title, strong=True, english=True)
    yield from _scenario(test, texts)
    yield _verdict_table(test, texts)
    yield from pictures(drawing, texts)
    yield from _imposed(test, texts)
    yield from _measurements(test, texts)
    yield from _cursors(test, texts)


def _scenario(test: TestResult, texts: Texts) -> Iterator[Block]:
    """What happens, under which conditions, what is demanded, and where the procedure comes from."""
    told = scenario_words(test, texts)
    for sentences in (told.happens, told.conditions, told.demanded):
        if sentences:
            yield Paragraph(" ".join(sentences))
    if test.clause:
        yield Paragraph(texts("pdf.procedure", basis=_basis(test.clause, test.confidence, texts)), small=True)


def _imposed(test: TestResult, texts: Texts) -> Iterator[Block]:
    """The voltage that was asked for beside the one that the record has."""
    rows = imposed_rows(test, texts)
    if not rows:
        return
    names = ("asked_positive", "measured_positive", "difference", "asked_negative", "measured_negative", "difference")
    columns = (
        Column(texts("scenario.column.window"), 1.0),
        Column(texts("scenario.column.span"), 1.3),
        *(Column(texts(f"scenario.column.{name}"), "18mm", "right") for name in names),
    )
    yield Heading(texts("scenario.imposed.title"), level=3)
    yield Table(columns, tuple(tuple(Cell(text or "–") for text in row) for row in rows), dense=True)
    yield Paragraph(texts("scenario.imposed.note"), small=True)


def _basis(clause: str, confidence: str, texts: Texts) -> str:
    """A clause with the mark of its numbers; what there is of both."""
    if clause and confidence:
        return texts("pdf.basis", clause=clause, mark=texts.named("coverage.mark", confidence))
    return clause or (texts.named("coverage.mark", confidence) if confidence else "")


def _verdict_table(test: TestResult, texts: Texts) -> Table:
    columns = (
        Column(texts("section.heading.check"), "37mm"),
        Column(texts("section.heading.verdict"), "23mm"),
        Column(texts("section.heading.measured"), "auto", "right"),
        Column(texts("section.heading.limit"), 1.0),
        Column(texts("section.heading.margin"), "auto", "right"),
        Column(texts("section.heading.uncertainty"), "auto", "right"),
        Column(texts("section.heading.at"), "auto", "right"),
    )
    return Table(columns, tuple(row for check in verdicts(test) for row in _verdict_rows(check, texts)))


def _verdict_rows(check: Verdict, texts: Texts) -> Iterator[tuple[Cell, ...]]:
    """The numbers of a verdict, and below them what they rest on and what was found."""
    numbers = spell.row(check, texts)
    word = spell.state_in_words(check, texts)
    yield (
        Cell(texts.named("check", check.check), strong=True),
        Cell(spell.marked(word, check, texts), status=check.status),
        Cell(numbers.measured),
        Cell(spell.limit_in_words(check, texts)),
        Cell(numbers.margin),
        Cell(numbers.uncertainty),
        Cell(spell.number(check.at_s, "s", texts=texts)),
    )
    basis = _basis(check.clause, check.confidence, texts)
    message = ": ".join(part for part in (spell.stretch_unless_told(check), check.message) if part)
    if basis or message:
        yield (
            Cell(basis, span=2, joined=True, small=True),
            Cell(message, span=5, joined=True, small=True, english=True),
        )
    if beside := spell.baseline_in_words(check, texts):
        yield Cell("", span=2, joined=True), Cell(beside, span=5, joined=True, small=True)


def _measurements(test: TestResult, texts: Texts) -> Iterator[Block]:
    rows = measured_rows(test.measurements, texts)
    if not rows:
        return
    windows = window_headings(test.measurements, texts)
    heads = [Column(f"{name}\n{span}", "30mm", "right") for name, span in windows]
    columns = (Column(texts("section.heading.quantity")), Column(texts("section.heading.unit"), "14mm"), *heads)
    cells = [(Cell(row.name), Cell(row.unit), *(Cell(value or "–") for value in row.values)) for row in rows]
    yield Heading(texts("section.measurements"), level=3)
    yield Table(columns, tuple(cells))
    beliefs = beliefs_in_words(test.measurements.controller, texts)
    notes = [texts("section.peak_note"), *([texts("section.beliefs", values=beliefs)] if beliefs else [])]
    yield Paragraph(" ".join(notes), small=True)


def _cursors(test: TestResult, texts: Texts) -> Iterator[Block]:
    """Extremes, mean and response times of each stretch."""
    parts = cursor_table.cursor_parts(test, texts)
    if not parts:
        return
    quantity, *numbers = (f"{name} ({unit})" if unit else name for name, unit in cursor_table.headings(texts))
    widths = (*["13mm"] * 3, "25mm", *["15.5mm"] * 5)
    columns = (Column(quantity, 1.0), *(Column(*of, "right") for of in zip(numbers, widths, strict=True)))
    rows = [
        row
        for part in parts
        for row in (
            (Cell(". ".join(text for text in part[:2] if text), span=len(columns), strong=True),),
            *((Cell(f"{of.name} ({of.unit})"), *map(Cell, of.cells)) for of in part.rows),
        )
    ]
    yield Heading(texts("cursor.title"), level=3)
    yield Table(columns, tuple(rows), dense=True)
    yield Paragraph(cursor_table.note(test, texts), small=True)
