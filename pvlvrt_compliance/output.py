"""What a run writes into its folder: which reports, in which language, and what stands on their title page."""

import json
from collections.abc import Collection, Mapping, Sequence
from dataclasses import asdict
from functools import partial
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from pvlvrt_compliance.errors import UsageError, did_you_mean, spelled_of
from pvlvrt_compliance.results import ReportDetails, Results
from pvlvrt_compliance.results.details import FIELDS, LOGO
from pvlvrt_compliance.results.files import RESULTS, SHARD
from pvlvrt_compliance.texts import CONTROL

LONGEST_FIELD = 1000
"""Characters of a field, chosen: some fifteen lines of a title page, which a remark may fill."""

_HEAD, _MADE = "head.json", "made.json"
"""In the file of a part."""

_MOST_PACKED = 100  # times what is packed: figures shrink to a half
_LONG_AGO = (1980, 1, 1, 0, 0, 0)  # the earliest that such a file can say: the same part gives the same bytes

if TYPE_CHECKING:
    from pvlvrt_compliance.study.job import Spell
    from pvlvrt_compliance.study.running import Output
    from pvlvrt_compliance.study.shards.part import Head, Part


def output_in(
    folder: str,
    tests: int,
    *,
    csv: bool = False,
    spell: "Spell" = str,
    formats: Collection[str] = (),
    details: ReportDetails | None = None,
    head: "Head | None" = None,
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
    head : Head, optional
        Of a part of a run: what it keeps for the whole.

    Raises
    ------
    UsageError
        When there is no such format, or it lacks something.
    """
    from pvlvrt_compliance.report.drawing import OF_A_RECORD
    from pvlvrt_compliance.report.drawing.parts import buckets_for
    from pvlvrt_compliance.report.formats import chosen_formats, of_made
    from pvlvrt_compliance.study.named import Named
    from pvlvrt_compliance.study.running import Output, Render

    written = chosen_formats(formats, spell("formats"))
    details = details or ReportDetails()
    files: dict[str, Render] = {each.file: partial(of_made, each) for each in written}
    if head is not None:
        files[SHARD] = partial(_shard_file, head)
    shown = sorted({each.shows for each in written} - {""})
    drawing = {"buckets": buckets_for(tests), "language": details.language, "forms": shown}
    return Output(
        folder=folder,
        formats=files,
        drawing=Named(OF_A_RECORD, drawing),
        csv=csv,
        spell=spell,
        details=details,
        told=[each.file for each in written if each.takes_a_while],
        of_whole_runs=[SHARD, *(each.file for each in written if each.of_whole_runs)],
    )


def _shard_file(head: "Head", results: Results, made: Mapping[str, Any]) -> bytes:
    """What a part keeps for the whole run besides its results and records; its head is not packed, and can be read."""
    from pvlvrt_compliance.report.made_file import pack

    said = json.dumps({**asdict(head), "run_id": results.run_id}, indent=2)
    content = BytesIO()
    with ZipFile(content, "w") as file:
        file.writestr(ZipInfo(_HEAD, _LONG_AGO), said)
        file.writestr(ZipInfo(_MADE, _LONG_AGO), pack(made), ZIP_DEFLATED)
    return content.getvalue()


def parts_in(folders: Sequence[str]) -> "list[Part]":
    """The parts of a run, each in its folder, by their numbers.

    Raises
    ------
    UsageError
        When a folder has none, or a file of it cannot be read.
    """
    return sorted(map(_part_in, map(Path, folders)), key=lambda part: part.shard)


def check_figures(parts: "Sequence[Part]", formats: Collection[str], spell: "Spell" = str) -> None:
    """See that parts have the figures of formats that are asked for of the whole alone.

    Raises
    ------
    UsageError
        When there is no such format, it lacks something, or shows figures in a form that was not asked of a part.
    """
    from pvlvrt_compliance.report.formats import chosen_formats

    made = [forms for part in parts for forms in part.made.values()]
    for each in chosen_formats(formats, spell("formats")):
        if each.name in formats and each.shows and not all(each.shows in forms for forms in made):
            said = "its figures are made with the records: give it with the parts"
            raise UsageError(f"{spell('formats')} {each.name}: {said}")


def _part_in(folder: Path) -> "Part":
    from pydantic import TypeAdapter

    from pvlvrt_compliance.report.made_file import unpack
    from pvlvrt_compliance.results.reading import read_results
    from pvlvrt_compliance.study.shards.part import Head, Part

    place = folder / SHARD
    results = read_results(folder / RESULTS)
    if place.exists() and not place.is_file():  # a pipe would be waited for, a device read without end
        raise UsageError(f"{place}: cannot be read: it is no ordinary file (--shard makes parts)")
    try:
        with ZipFile(place) as file:
            head = TypeAdapter(Head).validate_json(_packed_in(file, _HEAD))
            part = Part(folder, head, results, unpack(_packed_in(file, _MADE)))
    except OSError as error:
        said = "it is no part of a run" if isinstance(error, FileNotFoundError) else error.strerror or error
        raise UsageError(f"{place}: cannot be read: {said} (--shard makes parts)") from None
    except Exception as error:  # it may be damaged anywhere, and in any layer
        raise UsageError(f"{place}: is damaged: {' '.join(str(error).split())}") from None
    if part.head.run_id != results.run_id:
        raise UsageError(f"{place}: is not of the run that {RESULTS} beside it is of")
    return part


def _packed_in(file: ZipFile, name: str) -> bytes:
    """What is packed under a name, unless it is so much more than the file that nobody has packed a part so."""
    entry = file.getinfo(name)
    if entry.file_size > _MOST_PACKED * max(entry.compress_size, 1):
        raise ValueError(f"{name} would be {entry.file_size} bytes")
    return file.read(entry)


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
    fields = {name: value for name, value in given.items() if value}
    if LOGO in fields:
        fields[LOGO] = logo_address(given[LOGO], f"{spelled_of(spell, 'report_fields', LOGO)} {LOGO}")
    return ReportDetails(language=check_language(language, spell("language")), fields=fields)


def _check_text(text: str, spelled: str) -> None:
    if len(text) > LONGEST_FIELD:
        raise UsageError(f"{spelled}: {len(text)} characters; at most {LONGEST_FIELD} stand on a title page")
    if CONTROL.search(text):
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
