"""What is needed to make the report again: parameters, versions, digests, the command."""

from collections.abc import Iterator

from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.report.pdf.blocks import Block, Facts, Heading, Paragraph, Section
from pvlvrt_compliance.report.provenance import Group, provenance_groups
from pvlvrt_compliance.results import Results

_PARAMETERS = "parameters"


def annexes(results: Results, texts: Texts) -> tuple[Section, ...]:
    """Annex A: all parameters, by group; annex B: what the run was made with."""
    groups = provenance_groups(results.provenance, texts)
    parameters = [group for group in groups if group.title == _PARAMETERS]
    origin = [group for group in groups if group.title != _PARAMETERS]
    return (
        Section(
            texts("page.provenance_of.parameters"), tuple(_parameters(parameters, texts)), annex=True, new_page=True
        ),
        Section(texts("pdf.origin"), tuple(_origin(results, origin, texts)), annex=True, new_page=True),
    )


def _parameters(groups: list[Group], texts: Texts) -> Iterator[Block]:
    """The parameters of each part in a table of its own; a recording has none."""
    entries = [entry for group in groups for entry in group.entries]
    if not entries:
        yield Paragraph(texts("pdf.no_parameters"))
        return
    yield Paragraph(texts("pdf.parameters_are"))
    parts = dict.fromkeys(_part(name) for name, _ in entries)
    for part in parts:
        yield Heading(part)
        own = [(name.removeprefix(f"{part}."), value) for name, value in entries if _part(name) == part]
        yield Facts(tuple(own), code=True)


def _part(name: str) -> str:
    return name.partition(".")[0]


def _origin(results: Results, groups: list[Group], texts: Texts) -> Iterator[Block]:
    yield Paragraph(texts("pdf.origin_is"))
    yield Facts(((texts("front.run"), results.run_id),), code=True)
    for group in groups:
        yield Heading(texts.named("page.provenance_of", group.title))
        yield Facts(group.entries, code=True)
    if results.profiles:
        yield Heading(texts("pdf.digests"))
        yield Facts(tuple((profile.id, profile.digest) for profile in results.profiles), code=True)
