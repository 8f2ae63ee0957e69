"""Run a job for the main command: show how far it is and what it found; its exit status."""

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from pvlvrt_compliance.cli.progress import progress_bar
from pvlvrt_compliance.cli.showing import log, show
from pvlvrt_compliance.cli.telling import tell
from pvlvrt_compliance.controllers.process.command import STOPS, status_of, words_of
from pvlvrt_compliance.errors import OutputError
from pvlvrt_compliance.output import fields_of, output_in, report_details
from pvlvrt_compliance.report import console
from pvlvrt_compliance.results import Results, exit_status
from pvlvrt_compliance.study.job import Job, Spell
from pvlvrt_compliance.study.running import run_job


def run(
    job: Job,
    *,
    command: Sequence[str],
    folder: str,
    csv: bool,
    formats: Sequence[str],
    language: str,
    report_fields: Sequence[str],
    allow_unjudged: bool,
    exit_zero: bool,
    quiet: bool,
    spell: Spell,
) -> int:
    """Run a job into a folder, show what it found, and return the exit status; ``spell`` names the options."""
    try:
        results = run_job(
            job,
            command=command,
            output=output_in(
                folder,
                len(job.tests),
                csv=csv,
                spell=spell,
                formats=formats,
                details=report_details(language, fields_of(report_fields, spell=spell), spell=spell),
            ),
            allow_unjudged=allow_unjudged,
            watch=progress_bar(len(job.tests), quiet),
            tell=tell,
        )
    except BaseException as end:
        said = _last_words(end)
        if said and isinstance(end, STOPS):
            log(f"{words_of(end)}; {said}")
            return status_of(end)
        if said:
            log(f"stopped by an error of the program; {said}")
        raise
    _show(results, Path(folder), quiet=quiet, own_controller=job.controller is not None)
    return 0 if exit_zero else exit_status(results)


def _last_words(end: BaseException) -> str:
    """What has become of the finished tests, taken from what ended the run: it is told once."""
    notes: list[str] = getattr(end, "__notes__", [])
    return notes.pop() if notes else ""


def _show(results: Results, folder: Path, *, quiet: bool, own_controller: bool) -> None:
    try:
        with suppress(SystemExit):  # rich ends the program when the reader of stdout has gone; the verdict still stands
            show(results, folder, quiet=quiet, own_controller=own_controller)
    except OSError as error:
        said = f"standard output cannot be written: {error.strerror or error}"
        raise OutputError(f"{said}; the reports are in {folder}: {console.summary_line(results)}") from None
