"""A whole run: from a job to its results, and to its files where a folder is named."""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from contextlib import AbstractContextManager, closing, nullcontext, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pvlvrt_compliance.checks.summary import summarise
from pvlvrt_compliance.errors import OutputError
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.results import (
    UNSETTLED,
    ProfileSummary,
    ReportDetails,
    Results,
    TestResult,
    conclude,
    counts_for,
)
from pvlvrt_compliance.results.files import RESULTS
from pvlvrt_compliance.study.baseline.applying import held_against, with_baseline
from pvlvrt_compliance.study.baseline.catalogue import Catalogue
from pvlvrt_compliance.study.job import Job, Spell
from pvlvrt_compliance.study.named import Named
from pvlvrt_compliance.study.opening import open_controller
from pvlvrt_compliance.study.ordering import in_order
from pvlvrt_compliance.study.provenance import created_at, provenance
from pvlvrt_compliance.study.records import Records
from pvlvrt_compliance.study.repository import files_of
from pvlvrt_compliance.study.selection import Assignment, kinds_judged
from pvlvrt_compliance.study.session import Progress, Tested, session
from pvlvrt_compliance.study.store import OutputFolder

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator

Render = Callable[[Results, Mapping[str, Any]], str | bytes]
"""Writes results, with what was made of the records by the key of the test, as one file."""


@dataclass(frozen=True, kw_only=True)
class Output:
    """Where the files of a run go, and what they are besides the waveforms.

    Parameters
    ----------
    folder : str
        As the user named it.
    formats : mapping
        What renders each file, by its name, in the order in which they are staged; `RESULTS` among them.
    drawing : Named
        Makes of each record what they show of it.
    csv : bool
        Whether waveforms are written as CSV, too.
    spell : callable
        How whoever asks writes ``output``, as of `make_job`.
    details : ReportDetails
        What is given for the reports: language, fields of a title page.
    told : collection of str
        Files whose writing is told before it begins, since it may take a while.
    of_whole_runs : collection of str
        Files that are not written of an interrupted run, which cannot wait for them.
    """

    folder: str
    formats: Mapping[str, Render]
    drawing: Named
    csv: bool = False
    spell: Spell = str
    details: ReportDetails = field(default_factory=ReportDetails)
    told: Collection[str] = ()
    of_whole_runs: Collection[str] = ()


def run_job(
    job: Job,
    *,
    command: Sequence[str] | str,
    output: Output | None = None,
    allow_unjudged: bool = False,
    watch: AbstractContextManager[Progress | None] | None = None,
    tell: Callable[[str], None] = lambda _: None,
    settings: Mapping[str, Any] | None = None,
    kept: Callable[[Results], None] = lambda _: None,
) -> Results:
    """Run a job.

    Parameters
    ----------
    job : Job
        What is to be run.
    command : sequence of str or str
        What makes the run again: words of a command line, or a text.
    output : Output, optional
        Where its files go; without, nothing is written.
    allow_unjudged : bool
        Kept with the results, for their exit status.
    watch : context manager, optional
        Entered while tests are run; gives what is told of each before it is (`session.Progress`).
    tell : callable, optional
        Is given what there is to know besides: of the output folder, and what a controller of the user's own has said.
    settings : mapping, optional
        What was written down in a file or the environment, as the provenance keeps it.
    kept : callable, optional
        Is given what a run that ended early has kept, once it is in its place; it must not raise.

    Raises
    ------
    UsageError
        When the controller or the output folder cannot be used.
    OutputError
        When something cannot be written; says what has become of the finished tests.
    BaseException
        Whatever else ends the run early, Ctrl-C among it, with a note (`__notes__`) that says so, too: finished tests
        are kept apart from the files of the last whole run.
    """
    controller = open_controller(job)
    for note in job.notes:
        tell(note)
    told = _tell_new(controller, 0, tell)
    run = _Run(job, controller, command, output, allow_unjudged, settings, kept)
    try:
        run.tell_of_folder(tell)
        with watch or nullcontext() as progress:
            run.simulate(progress)
        results = run.deliver(tell)
    except OutputError as error:
        raise OutputError(f"{error}; {run.keep_unfinished()}") from error
    except OSError as error:
        named = f"{error.filename}: {error.strerror}" if error.filename else str(error)
        raise OutputError(f"{named}; {run.keep_unfinished()}") from error
    except BaseException as error:
        error.add_note(run.keep_unfinished())
        raise
    finally:
        run.discard()  # a signal may have come while what was finished was kept
    _tell_new(controller, told, tell)
    return results


def _tell_new(controller: "ForeignSimulator | None", told: int, tell: Callable[[str], None]) -> int:
    """Say what there is to know of the user's own controller, or what it has said itself; how much that is so far."""
    if controller is None:
        return 0
    for note in controller.notes[told:]:
        tell(f"{controller.spec}: {note}")
    return len(controller.notes)


class _Run:
    """One run: the tests that are finished, what was made of them, and where its files go."""

    def __init__(
        self,
        job: Job,
        controller: "ForeignSimulator | None",
        command: Sequence[str] | str,
        output: Output | None,
        allow_unjudged: bool,
        settings: Mapping[str, Any] | None,
        kept: Callable[[Results], None],
    ) -> None:
        self._job = job
        self._controller = controller
        self._command = command
        self._settings = settings
        self._kept = kept
        self._output = output
        self._allow_unjudged = allow_unjudged
        self._created = created_at()
        self._files = files_of(job.controller, job.profile_files)
        self._finished: list[Tested] = []
        self._made: dict[str, Any] = {}
        self._folder = OutputFolder(output.folder, output.spell) if output else None
        self._records = Records(self._folder, job, self._created, csv=output.csv) if output and self._folder else None

    def tell_of_folder(self, tell: Callable[[str], None]) -> None:
        """Say what was found in the output folder."""
        for note in self._folder.notes if self._folder else ():
            tell(note)

    def simulate(self, progress: Progress | None) -> None:
        """Run every test; waveforms are written and drawn at once, so that they need not be kept."""
        stream = session(
            self._job,
            each=self._output.drawing if self._output else None,
            keep=self._records.keep if self._records else None,
            progress=progress,
            controller=self._controller,
            ends=self._is_a_failure if self._job.fail_fast else None,
        )
        with closing(stream):
            for tested in stream:
                if tested.made is not None:
                    self._made[tested.result.key] = tested.made
                self._finished.append(tested._replace(made=None))

    def deliver(self, tell: Callable[[str], None]) -> Results:
        """The results; with an output folder, all reports are put in their places."""
        results = self._results()
        if self._output and self._folder:
            for name, render in self._output.formats.items():
                if name in self._output.told:
                    tell(f"writing {name}")
                self._folder.write(name, render(results, self._made))
            self._folder.finish()
        return results

    def keep_unfinished(self) -> str:
        """Keep the finished tests apart from the reports of the last whole run; what has become of them, in words."""
        count = f"{len(self._finished)} of {len(self._job.tests)} tests were finished"
        if self._folder is None:
            return count
        said = "nothing was written"
        if self._folder.is_placed:
            said = f"all files are in {self._folder.folder}"
        elif self._folder.is_stuck:
            said = "they wait there"
        elif self._finished:
            try:
                return f"{count} and are kept in {self._keep_interrupted(self._folder)}"
            except (OutputError, OSError) as error:
                said = f"they could not be kept: {error}"
        self._folder.discard()
        return f"{count}, {said}"

    def discard(self) -> None:
        """Leave no trace of what is not in its place."""
        if self._folder:
            self._folder.discard()

    def _keep_interrupted(self, folder: OutputFolder) -> Path:
        """Keep records and results, and what a CI job that came to its time limit is looked at by."""
        assert self._output is not None
        assert self._records is not None
        folder.drop_all_but(self._records.names)
        results = self._results(interrupted=True)
        folder.write(RESULTS, self._output.formats[RESULTS](results, self._made))
        for name in self._output.formats.keys() - {RESULTS, *self._output.of_whole_runs}:
            with suppress(Exception):  # what ended the run may be in the way here, too; the tests are kept without it
                folder.write_if_possible(name, self._output.formats[name](results, {}))
        place = folder.keep_interrupted()
        self._kept(results)
        return place

    def _is_a_failure(self, result: TestResult) -> bool:
        """Whether a test keeps the run from ending with status 0."""
        if self._job.baseline is not None:
            result = with_baseline(result, self._job.baseline)
        return counts_for(result, allow_unjudged=self._allow_unjudged) in UNSETTLED

    def _summary(self, profile: Profile, run: Collection[str]) -> ProfileSummary:
        """A profile as the reports show it; ``run`` are the keys of what is finished."""
        job = self._job
        return summarise(
            profile,
            _of(profile, (item for item in job.tests if item.key in run)),
            left_out=_of(profile, job.left_out),
            not_selected=_of(profile, job.not_selected),
            not_run=_of(profile, (item for item in job.tests if item.key not in run)),
            selected_checks=kinds_judged(profile, job.checks),
        )

    def _ended_at(self) -> str:
        """Key of the test that has ended the run; nothing where all are run, or something else has ended it."""
        if not self._job.fail_fast:
            return ""
        return next((tested.result.key for tested in self._finished if self._is_a_failure(tested.result)), "")

    def _results(self, *, interrupted: bool = False) -> Results:
        """What is finished, as one result object, in the order of the profiles."""
        job = self._job
        finished = in_order(self._finished, job)
        own = self._controller.provenance(job.parameters) if self._controller else {}
        origin = provenance(
            job.profiles, job.parameters, self._command, self._created, own, self._files, self._settings
        )
        summaries = [self._summary(profile, {tested.result.key for tested in finished}) for profile in job.profiles]
        details = self._output.details if self._output else None
        results = conclude(
            [tested.result for tested in finished],
            summaries,
            origin,
            allow_unjudged=self._allow_unjudged,
            report=details,
            ended_at=self._ended_at(),
            interrupted=interrupted,
        )
        if job.baseline is None:
            return results
        return held_against(results, job.baseline, Catalogue(job.profiles, [x.key for x in results.tests]).is_gone)


def _of(profile: Profile, items: Iterable[Assignment]) -> list[TestCase]:
    return [item.test for item in items if item.profile is profile]
