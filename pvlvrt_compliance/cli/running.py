"""Run a job for the main command: show how far it is and what it found; its exit status."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pvlvrt_compliance.cli.progress import progress_bar
from pvlvrt_compliance.cli.publishing import publish
from pvlvrt_compliance.cli.showing import log, show
from pvlvrt_compliance.cli.telling import tell
from pvlvrt_compliance.controllers.process.command import status_of, words_of
from pvlvrt_compliance.errors import OutputError, stop_behind
from pvlvrt_compliance.output import fields_of, output_in, report_details
from pvlvrt_compliance.report import console
from pvlvrt_compliance.results import Results, exit_status
from pvlvrt_compliance.results.files import FOLDER
from pvlvrt_compliance.study.job import Job, Spell
from pvlvrt_compliance.study.running import run_job
from pvlvrt_compliance.study.shards.part import head_of

if TYPE_CHECKING:
    from pvlvrt_compliance.study.shards.merging import Whole


def run(
    job: Job,
    *,
    command: Sequence[str],
    spell: Spell,
    settings: Mapping[str, Any] | None = None,
    given: Mapping[str, Any] | None = None,
    whole: "Whole | None" = None,
    output: str = FOLDER,
    csv: bool = False,
    formats: Sequence[str] = (),
    language: str = "en",
    report_fields: Sequence[str] = (),
    allow_unjudged: bool = False,
    exit_zero: bool = False,
    quiet: bool = False,
    verbose: bool = False,
) -> int:
    """Run a job into the folder ``output``, show what it found, return the exit status; ``spell`` names the options.

    ``given`` is what was given, by field, which a part of a run keeps; ``whole`` are the parts that are to be one run.
    """
    kept: list[Results] = []
    try:
        results = run_job(
            job,
            command=command,
            output=output_in(
                output,
                job.size,
                head=head_of(job, given or {}, command, settings),
                csv=csv,
                spell=spell,
                formats=formats,
                details=report_details(language, fields_of(report_fields, spell=spell), spell=spell),
            ),
            allow_unjudged=allow_unjudged,
            watch=progress_bar(len(job.tests), quiet or job.debug),  # it would draw over a debugger's lines
            tell=tell,
            settings=settings,
            kept=kept.append,
            whole=whole,
        )
    except BaseException as end:
        for part in kept:
            _publish_part(part, formats)
        if (status := stopped(end)) is None:
            raise
        return status
    own = job.controller is not None
    _show(results, Path(output), formats, quiet=quiet, verbose=verbose, own_controller=own, exit_zero=exit_zero)
    return 0 if exit_zero else exit_status(results)


def stopped(end: BaseException) -> int | None:
    """Say what has become of the finished tests of a run that something has ended early.

    Returns
    -------
    int or None
        The exit status where it was stopped; None of an error, which goes on its way.
    """
    said = _last_words(end)
    if said and (stop := stop_behind(end)):
        log(f"{words_of(stop)}; {said}")
        return status_of(stop)
    if said:
        log(f"stopped by an error of the program; {said}")
    return None


def _publish_part(results: Results, formats: Sequence[str]) -> None:
    """Tell a CI service of what was finished; that this does not go changes no exit status."""
    try:
        publish(results, formats)
    except (OSError, OutputError) as error:
        log(str(error))


def _last_words(end: BaseException) -> str:
    """What has become of the finished tests, taken from what ended the run: it is told once."""
    notes: list[str] = getattr(end, "__notes__", [])
    return notes.pop() if notes else ""


def _show(results: Results, folder: Path, formats: Sequence[str], **how: bool) -> None:
    try:
        with suppress(SystemExit):  # rich ends the program when the reader of stdout has gone; the verdict still stands
            show(results, folder, formats, **how)
        publish(results, formats)
    except OSError as error:
        said = f"standard output cannot be written: {error.strerror or error}"
        raise OutputError(f"{said}; the reports are in {folder}: {console.summary_line(results)}") from None
