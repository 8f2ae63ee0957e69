"""How what is reported came about: scope, conditions, method of measurement."""

from collections.abc import Iterator

from pvlvrt_compliance.report.document.front import Front
from pvlvrt_compliance.report.document.scenario import scenario_words
from pvlvrt_compliance.report.language import BASE, Texts
from pvlvrt_compliance.report.pdf.blocks import Block, Cell, Facts, Heading, Items, Paragraph, Section
from pvlvrt_compliance.results import Results

_METHOD = ("method.causal", "method.phasors", "method.bases", "method.windows", "method.times", "limit.note")


def scope_section(results: Results, texts: Texts) -> Section:
    """What the report is and is not."""
    return Section(texts("pdf.scope"), tuple(map(Paragraph, _scope(results, texts))))


def _scope(results: Results, texts: Texts) -> Iterator[str]:
    yield texts("scope.pre_study")
    yield texts("scope.judged", coverage=texts("pdf.coverage"), results=texts("pdf.results"))
    simulation = results.provenance.get("parameters", {}).get("simulation")
    if simulation:
        yield texts("scope.switched" if simulation.get("fidelity") == "switched" else "scope.averaged")
        yield texts("scope.bundled" if results.provenance.get("controller") == "bundled" else "scope.own")
    else:
        yield texts("scope.recording")
    yield texts("scope.uncertainty")
    notes = sum(len(profile.notes) for profile in results.profiles)
    if notes:
        yield texts("scope.marks", count=notes, code=texts("pdf.code"))
    if texts.language != BASE:
        yield texts("scope.english")


def conditions_section(results: Results, first: Front, texts: Texts) -> Section:
    """On what plant, at what grid: what all tests have in common."""
    return Section(texts("pdf.conditions"), tuple(_conditions(results, first, texts)))


def _conditions(results: Results, first: Front, texts: Texts) -> Iterator[Block]:
    yield Heading(texts("pdf.plant"))
    yield Facts(tuple((fact.name, fact.text) for fact in first.tested))
    common = _common_conditions(results, texts)
    if common:
        yield Heading(texts("pdf.grid"))
        yield Paragraph(texts("pdf.grid_is"))
        yield Items(tuple(map(Cell, common)))
    yield Paragraph(texts("pdf.parameters_in_annex"))


def _common_conditions(results: Results, texts: Texts) -> tuple[str, ...]:
    """The conditions that all tests have alike, a sentence each."""
    of_tests = [scenario_words(test, texts).conditions for test in results.tests]
    first = of_tests[0] if of_tests else ()
    return tuple(sentence for sentence in first if all(sentence in conditions for conditions in of_tests))


def method_section(results: Results, texts: Texts) -> Section:
    """How it was measured, in short, and where all of it is written."""
    version = results.provenance.get("versions", {}).get("pvlvrt-compliance", "")
    sentences = [*map(texts, _METHOD), texts("method.where", version=version)]
    return Section(texts("pdf.method"), tuple(map(Paragraph, sentences)))
