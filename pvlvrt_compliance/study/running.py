"""A whole run: from a job to its results, and to its files where a folder is named."""

from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import AbstractContextManager, closing, nullcontext, suppress
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pvlvrt_compliance.controllers.debugging import NOTE
from pvlvrt_compliance.errors import OutputError, UnfinishedError, UsageError
from pvlvrt_compliance.results import ReportDetails, Results
from pvlvrt_compliance.results.files import RESULTS
from pvlvrt_compliance.study.account import Account
from pvlvrt_compliance.study.executors.choosing import choose_executor
from pvlvrt_compliance.study.executors.executor import Executor
from pvlvrt_compliance.study.executors.units import units_of
from pvlvrt_compliance.study.idle import idle_in_files
from pvlvrt_compliance.study.job import KEEP_NONE, Job, Spell
from pvlvrt_compliance.study.named import Named
from pvlvrt_compliance.study.opening import open_controller
from pvlvrt_compliance.study.provenance import created_at
from pvlvrt_compliance.study.repository import files_of
from pvlvrt_compliance.study.reuse.opening import reuse_notes
from pvlvrt_compliance.study.reuse.telling import reuse_in_words
from pvlvrt_compliance.study.session import Progress, session
from pvlvrt_compliance.study.settling import settling_notes
from pvlvrt_compliance.study.store import OutputFolder
from pvlvrt_compliance.study.work import Keeping, Tested, Work

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator
    from pvlvrt_compliance.study.shards.merging import Whole

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
    whole: "Whole | None" = None,
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
    whole : Whole, optional
        Parts in which the job has been run: what they have found is taken, and nothing is simulated.

    Raises
    ------
    UsageError
        When the controller or the output folder cannot be used.
    OutputError
        When something cannot be written; says what has become of the finished tests.
    LostError
        When what runs the tests is gone; says so, too.
    BaseException
        Whatever else ends the run early, Ctrl-C among it, with a note (`__notes__`) that says so, too: finished tests
        are kept apart from the files of the last whole run.
    """
    if job.debug and not whole:
        tell(f"debug: {NOTE}")  # before the controller is opened, which may be where it stops
    controller: Any = whole.controller if whole else open_controller(job)
    on_files = idle_in_files(output.csv, job.waveforms != KEEP_NONE, output.spell) if output else ()
    of_settling = () if whole else settling_notes(job, controller)
    for note in (*job.notes, *on_files, *reuse_notes(job, controller), *of_settling):
        tell(note)
    told = _tell_new(controller, 0, tell)
    run = _Run(job, controller, command, output, allow_unjudged, settings, kept)
    executor = whole.executor if whole else None
    try:
        run.tell_of_folder(tell)
        with watch or nullcontext() as progress:
            run.simulate(progress, tell, executor)
        results = run.deliver(tell)
    except UnfinishedError as error:
        raise type(error)(f"{error}; {run.keep_unfinished()}") from error
    except UsageError as error:
        if run.has_finished:
            error.add_note(run.keep_unfinished())
        raise
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
        created = created_at()
        self._controller = controller
        self._kept = kept
        self._output = output
        self._finished: list[Tested] = []
        self._made: dict[str, Any] = {}
        self._folder = OutputFolder(output.folder, output.spell) if output else None
        self._work = Work(
            job=job,
            each=output.drawing if output else None,
            keeping=self._keeping(created, output.csv) if output else None,
            allow_unjudged=allow_unjudged,
        )
        self._account = Account(
            work=self._work,
            controller=controller,
            command=command,
            settings=settings,
            created=created,
            details=output.details if output else None,
            files=files_of(job.controller, job.profile_files),
        )

    def _keeping(self, created: datetime, csv: bool) -> Keeping:
        assert self._folder is not None
        return Keeping(staging=self._folder.staging, folder=self._folder.folder, created=created, csv=csv)

    @property
    def has_finished(self) -> bool:
        """Whether any test is finished."""
        return bool(self._finished)

    def tell_of_folder(self, tell: Callable[[str], None]) -> None:
        """Say what was found in the output folder."""
        for note in self._folder.notes if self._folder else ():
            tell(note)

    def simulate(
        self, progress: Progress | None, tell: Callable[[str], None], executor: Executor | None = None
    ) -> None:
        """Run every test; waveforms are written and drawn at once, so that they need not be kept."""
        work, controller = self._work, self._controller
        if executor is None:
            executor, note = choose_executor(work, units_of(work.job.tests, work.job.first), controller, tell)
            if note:
                tell(note)

        def begins(name: str, done: int, total: int) -> None:
            self._account.load()  # where processes are at work, this one has the time for it
            if progress:
                progress(name, done, total)

        with closing(session(work, progress=begins, controller=controller, executor=executor)) as stream:
            for tested in stream:
                if tested.made is not None:
                    self._made[tested.result.key] = tested.made
                self._finished.append(tested._replace(made=None))

    def deliver(self, tell: Callable[[str], None]) -> Results:
        """The results; with an output folder, all reports are put in their places."""
        for line in reuse_in_words(self._work.job, self._finished):
            tell(line)
        results = self._account.results(self._finished)
        if self._output and self._folder:
            self._folder.drop_all_but(self._kept_records())  # of what came to no result where it was run
            for name, render in self._output.formats.items():
                if name in self._output.told:
                    tell(f"writing {name}")
                self._folder.write(name, render(results, self._made))
            self._folder.finish()
        return results

    def keep_unfinished(self) -> str:
        """Keep the finished tests apart from the reports of the last whole run; what has become of them, in words."""
        count = f"{len(self._finished)} of {len(self._work.job.tests)} tests were finished"
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

    def _kept_records(self) -> set[str]:
        """Names of the records that the finished tests refer to."""
        return {Path(tested.result.waveforms).stem for tested in self._finished if tested.result.waveforms}

    def discard(self) -> None:
        """Leave no trace of what is not in its place."""
        if self._folder:
            self._folder.discard()

    def _keep_interrupted(self, folder: OutputFolder) -> Path:
        """Keep records and results, and what a CI job that came to its time limit is looked at by."""
        assert self._output is not None
        folder.drop_all_but(self._kept_records())
        results = self._account.results(self._finished, interrupted=True)
        folder.write(RESULTS, self._output.formats[RESULTS](results, self._made))
        for name in self._output.formats.keys() - {RESULTS, *self._output.of_whole_runs}:
            with suppress(Exception):  # what ended the run may be in the way here, too; the tests are kept without it
                folder.write_if_possible(name, self._output.formats[name](results, {}))
        place = folder.keep_interrupted()
        self._kept(results)
        return place
