"""Run the tests, show them, write the reports."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, SpinnerColumn, TextColumn

from pvlvrt_compliance.checks.evaluate import summarise
from pvlvrt_compliance.cli.request import KEEP_ALL, KEEP_FAILED, Job, Request
from pvlvrt_compliance.cli.telling import tell
from pvlvrt_compliance.data.marks import CHOSEN
from pvlvrt_compliance.errors import OutputError
from pvlvrt_compliance.processes import STOPS, status_of, words_of
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.report import console, html, junit, results_json
from pvlvrt_compliance.report.decimation import buckets_for
from pvlvrt_compliance.report.figure import test_figure
from pvlvrt_compliance.results import UNSETTLED, Results, TestResult, conclude, exit_status
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.study.provenance import created_at, provenance
from pvlvrt_compliance.study.selection import Assignment
from pvlvrt_compliance.study.store import JUNIT, REPORT, RESULTS, WAVEFORMS, OutputFolder
from pvlvrt_compliance.texts import printable
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms import Waveforms
from pvlvrt_compliance.waveforms.comtrade import write_comtrade
from pvlvrt_compliance.waveforms.csv import write_csv

if TYPE_CHECKING:
    from pvlvrt_compliance.simulation.foreign_simulate import ForeignSimulator
    from pvlvrt_compliance.study.run import Judged


def execute(request: Request, job: Job) -> int:
    """Run what was asked for and return the exit status."""
    controller = _own_controller(request, job)
    told = len(controller.notes) if controller else 0
    run = _Run(request, job, created_at(), OutputFolder(request.output), controller)
    try:
        for note in run.output.notes:
            tell(note)
        run.simulate()
        results = run.write_reports()
        run.output.finish()
    except STOPS as end:
        _log(f"{words_of(end)}; {run.keep_unfinished()}")
        return status_of(end)
    except OutputError as error:
        raise OutputError(f"{error}; {run.keep_unfinished()}") from error
    except OSError as error:
        named = f"{error.filename}: {error.strerror}" if error.filename else str(error)
        raise OutputError(f"{named}; {run.keep_unfinished()}") from error
    except BaseException:
        _log(f"stopped by an error of the program; {run.keep_unfinished()}")
        raise
    finally:
        run.output.discard()  # a signal may have come while what was finished was kept
    _tell(controller.notes[told:] if controller else (), request)
    try:
        with suppress(SystemExit):  # rich ends the program when the reader of stdout has gone; the verdict still stands
            _show(results, request)
    except OSError as error:
        said = f"standard output cannot be written: {error.strerror or error}"
        raise OutputError(f"{said}; the reports are in {run.output.folder}: {console.summary_line(results)}") from None
    return 0 if request.exit_zero else exit_status(results)


def _own_controller(request: Request, job: Job) -> "ForeignSimulator | None":
    """Open the user's own controller, if there is one.

    Raises
    ------
    UsageError
        When it cannot be opened, does not command all phases, or its sample time does not fit.
    """
    if request.controller is None:
        return None
    from pvlvrt_compliance.simulation.foreign_simulate import ForeignSimulator

    controller = ForeignSimulator(request.controller, job.given, request.mapping)
    controller.check_commands()
    controller.provenance(job.parameters)
    _tell(controller.notes, request)
    return controller


def _tell(notes: Iterable[str], request: Request) -> None:
    """Say what there is to know of the user's own controller, or what it has said itself."""
    for note in notes:
        tell(f"{request.controller}: {note}")


def _log(text: str) -> None:
    """Say on stderr why a run has ended early; in a file a line stays one line."""
    log = Console(stderr=True, highlight=False, markup=False, emoji=False)
    with suppress(OSError):
        log.print(printable(text), soft_wrap=not log.is_terminal)


class _Run:
    """One run: the tests that are finished, their figures, and where its files go."""

    def __init__(
        self, request: Request, job: Job, created: datetime, output: OutputFolder, controller: "ForeignSimulator | None"
    ) -> None:
        self.request = request
        self.job = job
        self.created = created
        self.output = output
        self.controller = controller
        self.finished: list[TestResult] = []
        self.figures: dict[str, dict[str, Any]] = {}
        self.files: dict[Scenario, str] = {}  # names of the waveforms that are written

    def simulate(self) -> None:
        """Run every test; waveforms are written and drawn at once, so that they need not be kept."""
        with _progress(len(self.job.tests), self.request.quiet) as advance:
            # The simulator is compiled, or read from its cache, on this import and on the first run.
            from pvlvrt_compliance.simulation.scratch import clear_abandoned
            from pvlvrt_compliance.simulation.simulate import simulate
            from pvlvrt_compliance.study.rows import run_rows
            from pvlvrt_compliance.study.run import run_test
            from pvlvrt_compliance.study.sharing import SharedSimulator, rows_of, shared_together

            clear_abandoned()
            rows = shared_together(rows_of(self.job.tests))
            in_order = [item for row in rows for item in row]
            with SharedSimulator(self.controller or simulate, in_order, self.job.parameters) as simulator:

                def judge_one(profile: Profile, test: TestCase) -> "Judged":
                    advance(f"{profile.id} {test.id}", len(self.finished))
                    return run_test(profile, test, self.job.parameters, simulator)

                for row in rows:
                    profile = row[0].profile
                    for test, judged in run_rows(profile, [item.test for item in row], partial(judge_one, profile)):
                        self._finish(Assignment(profile, test), judged)

    def _finish(self, item: Assignment, judged: "Judged") -> None:
        """Write and draw the record of a test that has run."""
        from pvlvrt_compliance.simulation.translate import nominal_of

        result, waveforms = judged
        if waveforms is not None:
            result = self._keep(result, waveforms, item, nominal_of(self.job.parameters, item.test.scenario))
        self.finished.append(result)

    def results(self) -> Results:
        """What is finished, as one result object, in the order of the profiles."""
        job = self.job
        own = self.controller.provenance(job.parameters) if self.controller else {}
        origin = provenance(job.profiles, job.parameters, self.request.command, self.created, own)
        summaries = [
            summarise(profile, *(_of(profile, items) for items in (job.tests, job.left_out)))
            for profile in job.profiles
        ]
        order = [profile.id for profile in job.profiles]
        finished = sorted(self.finished, key=lambda test: order.index(test.profile))
        return conclude(finished, summaries, origin, allow_unjudged=self.request.allow_unjudged)

    def write_reports(self) -> Results:
        """Stage all reports."""
        results = self.results()
        self.output.write(RESULTS, results_json.render(results))
        self.output.write(JUNIT, junit.render(results))
        self.output.write(REPORT, html.render(results, self.figures))
        return results

    def keep_unfinished(self) -> str:
        """Keep the finished tests apart from the reports of the last whole run; what has become of them, in words."""
        count = f"{len(self.finished)} of {len(self.job.tests)} tests were finished"
        said = "nothing was written"
        if self.output.is_placed:
            said = f"all files are in {self.output.folder}"
        elif self.output.is_stuck:
            said = "they wait there"
        elif self.finished:
            try:
                self.output.drop_all_but(set(self.files.values()))
                self.output.write(RESULTS, results_json.render(self.results()))
                return f"{count} and are kept in {self.output.keep_interrupted()}"
            except (OutputError, OSError) as error:
                said = f"they could not be kept: {error}"
        self.output.discard()
        return f"{count}, {said}"

    def _keep(self, result: TestResult, waveforms: Waveforms, item: Assignment, nominal: Nominal) -> TestResult:
        buckets = buckets_for(len(self.job.tests))
        if self._wants_waveforms(result):
            result = result.model_copy(update={"waveforms": self._file_of(waveforms, result, item, nominal)})
        self.figures[result.key] = test_figure(waveforms, result, nominal, buckets)
        return result

    def _wants_waveforms(self, result: TestResult) -> bool:
        kept = self.request.waveforms
        return kept == KEEP_ALL or (kept == KEEP_FAILED and result.status in UNSETTLED)

    def _file_of(self, waveforms: Waveforms, result: TestResult, item: Assignment, nominal: Nominal) -> str:
        """Path of the record in the output folder; it is written once for all tests of its scenario."""
        scenario = item.test.scenario
        if scenario not in self.files:
            name = result.key if len(self.job.profiles) > 1 else result.id
            self._write(waveforms, name, item, nominal)
            self.files[scenario] = name
        return f"{WAVEFORMS}/{self.files[scenario]}.cfg"

    def _write(self, waveforms: Waveforms, name: str, item: Assignment, nominal: Nominal) -> None:
        waveforms = waveforms.with_settling
        stem = self.output.waveforms / name
        with self.output.writing(stem.with_name(f"{name}.dat")):
            write_comtrade(
                waveforms,
                stem,
                station=item.profile.id,
                device="pvlvrt-check",
                frequency_hz=nominal.frequency_hz,
                start=self.created,
                trigger_s=item.test.scenario.start_s,
            )
        if self.request.csv:
            table = stem.with_name(f"{name}.csv")
            with self.output.writing(table):
                write_csv(waveforms, table)


def _of(profile: Profile, items: Iterable[Assignment]) -> list[TestCase]:
    return [item.test for item in items if item.profile is profile]


@contextmanager
def _progress(total: int, quiet: bool) -> Iterator[Callable[[str, int], None]]:
    """Bar on stderr in a terminal; elsewhere silent. Calls name the test that begins and how many are done."""
    log = Console(stderr=True)
    columns = (SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    with Progress(*columns, console=log, transient=True, disable=quiet or not log.is_terminal) as progress:
        task = progress.add_task("preparing the simulator (once after an update: about 15 s)", total=total)
        begun = False

        def advance(name: str, done: int) -> None:
            nonlocal begun
            if begun:
                progress.update(task, description=name, completed=done)
            begun = True

        yield advance


def _show(results: Results, request: Request) -> None:
    screen = Console(highlight=False, markup=False, emoji=False)  # a profile's texts are shown as they are
    if request.quiet:
        screen.print(console.summary_line(results), soft_wrap=True)
        return
    screen.print(console.render(results))
    if request.controller is not None:
        screen.print(_rates(results.provenance), soft_wrap=not screen.is_terminal)
    for profile in results.profiles:
        _show_doubts(screen, profile.notes)
        if profile.left_out:
            left_out = f"Left out: {', '.join(profile.left_out)} of {profile.id} (long; --include-long runs them)"
            screen.print(left_out, soft_wrap=not screen.is_terminal)
    screen.print(f"Report: {Path(request.output) / REPORT}", soft_wrap=True)


def _rates(origin: Mapping[str, Any]) -> str:
    """How a controller of the user's own was run."""
    sample_us, steps = 1e6 * origin["controller_sample_time_s"], origin["plant_steps_per_sample"]
    return (
        f"Controller: {origin['controller']} ({origin['controller_kind']}), called every {sample_us:g} us;"
        f" plant step {origin['plant_step_us']:g} us ({steps} in a sample time);"
        f" computation delay {origin['computation_delay_samples']}"
    )


def _show_doubts(screen: Console, notes: tuple[str, ...]) -> None:
    """Name what is not verified; what the project itself has chosen is only counted, the report lists it."""
    chosen = [note for note in notes if f": {CHOSEN} (" in note]
    for note in notes:
        if note not in chosen:
            # In a file a note stays one line; a terminal would cut it in the middle of a word.
            screen.print(f"Not verified: {note}", soft_wrap=not screen.is_terminal)
    if chosen:
        screen.print(f"Not verified: {len(chosen)} numbers that this project has chosen (the report lists them)")
