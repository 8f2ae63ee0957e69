"""What a run writes into its folder: which reports, in which language, and what stands on their title page."""

from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING
from unicodedata import category

from pvlvrt_compliance.errors import UsageError, did_you_mean, spelled_of
from pvlvrt_compliance.results import ReportDetails
from pvlvrt_compliance.results.details import FIELDS, LOGO
from pvlvrt_compliance.texts import all_printable

LONGEST_FIELD = 1000
"""Characters of a field, chosen: some fifteen lines of a title page, which a remark may fill."""

if TYPE_CHECKING:
    from pvlvrt_compliance.study.job import Spell
    from pvlvrt_compliance.study.running import Output


def output_in(
    folder: str,
    tests: int,
    *,
    csv: bool = False,
    spell: "Spell" = str,
    formats: Collection[str] = (),
    details: ReportDetails | None = None,
) -> "Output":
    """What a run of so many tests writes into a folder: waveforms, and every file that the command writes.

    Parameters
    ----------
    folder, csv
        As of `check`.
    tests : int
        How many there are.
    spell : callable
        How whoever asks writes ``output``, as of `make_job`.
    formats : collection of str
        Those besides what is always written, by name.
    details : ReportDetails, optional
        What is given for the reports.

    Raises
    ------
    UsageError
        When there is no such format, or it lacks something.
    """
    from pvlvrt_compliance.report.drawing import OF_A_TEST
    from pvlvrt_compliance.report.drawing.parts import buckets_for
    from pvlvrt_compliance.report.formats import chosen_formats
    from pvlvrt_compliance.study.named import Named
    from pvlvrt_compliance.study.running import Output

    written = chosen_formats(formats, spell("formats"))
    return Output(
        folder=folder,
        formats={each.file: each.render for each in written},
        drawing=Named(OF_A_TEST, {"buckets": buckets_for(tests)}),
        csv=csv,
        spell=spell,
        details=details or ReportDetails(),
        told=[each.file for each in written if each.takes_a_while],
        of_whole_runs=[each.file for each in written if each.of_whole_runs],
    )


def report_details(language: str, given: Mapping[str, str], *, spell: "Spell" = str) -> ReportDetails:
    """What is given for a report, once it is known to be usable.

    Raises
    ------
    UsageError
        When there is no such language or field, a text does not fit a title page, or the file of the logo is none.
    """
    from pvlvrt_compliance.report.language import check_language
    from pvlvrt_compliance.report.logo import logo_address

    for name in given:
        asked = spelled_of(spell, "report_fields", name)
        if name not in FIELDS:
            hint = did_you_mean(name, FIELDS) or f"; there are: {', '.join(FIELDS)}"
            raise UsageError(f"{asked}: no field {name!r}{hint}")
        _check_text(given[name], f"{asked} {name}")
    fields = {name: all_printable(value) for name, value in given.items() if value}
    if LOGO in fields:
        fields[LOGO] = logo_address(given[LOGO], f"{spelled_of(spell, 'report_fields', LOGO)} {LOGO}")
    return ReportDetails(language=check_language(language, spell("language")), fields=fields)


def _check_text(text: str, spelled: str) -> None:
    if len(text) > LONGEST_FIELD:
        raise UsageError(f"{spelled}: {len(text)} characters; at most {LONGEST_FIELD} stand on a title page")
    if any(category(character) == "Cc" for character in text):
        raise UsageError(f"{spelled}: has a control character; a field is one line of text")


def fields_of(words: Sequence[str], *, spell: "Spell" = str) -> dict[str, str]:
    """Fields of a report that are written ``name=value``; the last of one name counts.

    Raises
    ------
    UsageError
        When a word is without a name or an equals sign.
    """
    fields = {}
    for word in words:
        name, equals, value = word.partition("=")
        if not (name.strip() and equals):
            asked = spelled_of(spell, "report_fields", word)
            raise UsageError(f"{asked}: {word!r} is not NAME=VALUE, for instance client='Solar Ltd'")
        fields[name.strip()] = value.strip()
    return fields
