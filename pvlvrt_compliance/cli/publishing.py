"""What a run tells the CI service that it is part of, besides its files."""

import os
from collections.abc import Collection
from contextlib import suppress
from pathlib import Path

from pvlvrt_compliance.cli.guarding import command_the_runner
from pvlvrt_compliance.errors import OutputError
from pvlvrt_compliance.report.formats import chosen_formats
from pvlvrt_compliance.results import Results


def publish(results: Results, formats: Collection[str]) -> None:
    """Print what the formats that were asked for have for the console, and append what a service wants appended.

    Raises
    ------
    OutputError
        When the file that the service names cannot be written.
    OSError
        When standard output cannot.
    """
    for each in chosen_formats(formats):
        if lines := each.console(results):
            with suppress(BrokenPipeError):  # whoever read stdout has gone; the verdict still stands
                command_the_runner(lines)
        if place := os.environ.get(each.appended_to, "") if each.appended_to else "":
            content = each.render(results, {})
            _append(Path(place), content.encode() if isinstance(content, str) else content, each.appended_to)


def _append(file: Path, content: bytes, asked: str) -> None:
    try:
        with file.open("ab") as opened:
            opened.write(content)
    except OSError as error:
        raise OutputError(f"{asked}: {file} cannot be written: {error.strerror or error}") from None
