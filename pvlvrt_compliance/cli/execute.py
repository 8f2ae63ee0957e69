"""Run the tests, show them, write the reports."""

import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, SpinnerColumn, TextColumn

from pvlvrt_compliance.checks.evaluate import summarise
from pvlvrt_compliance.checks.results import EXIT_STATUS, Results, TestResult, conclude
from pvlvrt_compliance.cli.output import RESULTS, WAVEFORMS, OutputFolder
from pvlvrt_compliance.cli.request import Job, Request
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.profile.provenance import CHOSEN
from pvlvrt_compliance.report import console, html, junit, results_json
from pvlvrt_compliance.report.decimation import buckets_for
from pvlvrt_compliance.report.figure import test_figure
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.study.provenance import created_at, provenance
from pvlvrt_compliance.study.selection import Assignment
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms import Waveforms
from pvlvrt_compliance.waveforms.comtrade import write_comtrade
from pvlvrt_compliance.waveforms.csv import write_csv

if TYPE_CHECKING:
    from pvlvrt_compliance.simulation.foreign_simulate import ForeignSimulator

_INTERRUPTED_STATUS = 130


def execute(request: Request, job: Job) -> int:
    """Run what was asked for and return the exit status."""
    controller = _own_controller(request, job)
    told = len(controller.notes) if controller else 0
    run = _Run(request, job, created_at(), OutputFolder(request.output), controller)
    try:
        run.simulate()
        results = run.write_reports()
        run.output.finish()
    except KeyboardInterrupt:
        run.keep_interrupted()
        return _INTERRUPTED_STATUS
    except BaseException:
        run.output.discard()
        raise
    _tell(controller.notes[told:] if controller else (), request)
    with suppress(SystemExit):  # rich ends the program when the reader of stdout has gone; the verdict still stands
        _show(results, request)
    return 0 if request.exit_zero else EXIT_STATUS[results.status]


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
        print(f"pvlvrt-check: {request.controller}: {note}", file=sys.stderr)


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
            from pvlvrt_compliance.simulation.simulate import simulate
            from pvlvrt_compliance.simulation.translate import nominal_of
            from pvlvrt_compliance.study.rows import run_rows
            from pvlvrt_compliance.study.run import Judged, run_test
            from pvlvrt_compliance.study.sharing import SharedSimulator, rows_of, shared_together

            simulator = SharedSimulator(self.controller or simulate, self.job.tests)

            def judge_one(profile: Profile, test: TestCase) -> Judged:
                advance(f"{profile.id} {test.id}", len(self.finished))
                return run_test(profile, test, self.job.parameters, simulator)

            for row in shared_together(rows_of(self.job.tests)):
                profile = row[0].profile
                for test, judged in run_rows(profile, [item.test for item in row], partial(judge_one, profile)):
                    result, waveforms = judged
                    if waveforms is not None:
                        nominal = nominal_of(self.job.parameters, test.scenario)
                        result = self._keep(result, waveforms, Assignment(profile, test), nominal)
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
        return conclude(finished, summaries, origin)

    def write_reports(self) -> Results:
        """Stage all reports."""
        results = self.results()
        self.output.write(RESULTS, results_json.render(results))
        self.output.write("junit.xml", junit.render(results))
        self.output.write("report.html", html.render(results, self.figures))
        return results

    def keep_interrupted(self) -> None:
        """Keep the finished tests apart from the reports of the last whole run, and say where."""
        log = Console(stderr=True, highlight=False)
        count = f"{len(self.finished)} of {len(self.job.tests)} tests"
        if not self.finished:
            self.output.discard()
            log.print(f"interrupted; {count} were finished, nothing was written")
            return
        self.output.write(RESULTS, results_json.render(self.results()))
        place = self.output.keep_interrupted()
        log.print(f"interrupted; {count} were finished and are kept in {place}", soft_wrap=not log.is_terminal)

    def _keep(self, result: TestResult, waveforms: Waveforms, item: Assignment, nominal: Nominal) -> TestResult:
        profile, scenario = item.profile, item.test.scenario
        if scenario not in self.files:
            self.files[scenario] = result.key if len(self.job.profiles) > 1 else result.id
            self._write(waveforms, self.files[scenario], item, nominal)
        envelope = profile.envelope
        points = envelope.points if envelope and envelope.voltage_quantity == "positive_sequence" else None
        buckets = buckets_for(len(self.job.tests))
        self.figures[result.key] = test_figure(waveforms, result, nominal, points, _limits(profile), buckets)
        return result.model_copy(update={"waveforms": f"{WAVEFORMS}/{self.files[scenario]}.cfg"})

    def _write(self, waveforms: Waveforms, name: str, item: Assignment, nominal: Nominal) -> None:
        write_comtrade(
            waveforms,
            self.output.waveforms / name,
            station=item.profile.id,
            device="pvlvrt-check",
            frequency_hz=nominal.frequency_hz,
            start=self.created,
            trigger_s=item.test.scenario.start_s,
        )
        if self.request.csv:
            write_csv(waveforms, self.output.waveforms / f"{name}.csv")


def _of(profile: Profile, items: Iterable[Assignment]) -> list[TestCase]:
    return [item.test for item in items if item.profile is profile]


def _limits(profile: Profile) -> dict[str, float]:
    limit = profile.requirements.current_limit
    if limit is None:
        return {}
    return {"current_fundamental_pu": limit.allowed_pu, "current_peak_pu": limit.peak_pu.value}


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
    screen.print(f"Report: {Path(request.output) / 'report.html'}", soft_wrap=True)


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
