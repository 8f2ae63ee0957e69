"""Run the tests, show them, write the reports."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from datetime import datetime
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, SpinnerColumn, TextColumn

from pvlvrt_compliance.checks.evaluate import summarise
from pvlvrt_compliance.checks.results import EXIT_STATUS, Results, TestResult, conclude
from pvlvrt_compliance.cli.output import RESULTS, WAVEFORMS, OutputFolder
from pvlvrt_compliance.cli.request import Job, Request
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.profile.provenance import CHOSEN
from pvlvrt_compliance.report import console, html, junit, results_json
from pvlvrt_compliance.report.figure import test_figure
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.study.provenance import created_at, provenance
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms import Waveforms
from pvlvrt_compliance.waveforms.comtrade import write_comtrade
from pvlvrt_compliance.waveforms.csv import write_csv

_INTERRUPTED_STATUS = 130


def execute(request: Request, job: Job) -> int:
    """Run what was asked for and return the exit status."""
    run = _Run(request, job, created_at(), OutputFolder(request.output))
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
    with suppress(SystemExit):  # rich ends the program when the reader of stdout has gone; the verdict still stands
        _show(results, request)
    return 0 if request.exit_zero else EXIT_STATUS[results.status]


class _Run:
    """One run: the tests that are finished, their figures, and where its files go."""

    def __init__(self, request: Request, job: Job, created: datetime, output: OutputFolder) -> None:
        self.request = request
        self.job = job
        self.created = created
        self.output = output
        self.finished: list[TestResult] = []
        self.figures: dict[str, dict[str, Any]] = {}

    def simulate(self) -> None:
        """Run every test; waveforms are written and drawn at once, so that they need not be kept."""
        with _progress(len(self.job.tests), self.request.quiet) as advance:
            # The simulator is compiled, or read from its cache, on this import and on the first run.
            from pvlvrt_compliance.simulation.translate import nominal_of
            from pvlvrt_compliance.study.run import run_test

            for test in self.job.tests:
                advance(test.id, len(self.finished))
                result, waveforms = run_test(self.job.profile, test, self.job.parameters)
                if waveforms is not None:
                    nominal = nominal_of(self.job.parameters, test.scenario)
                    result = self._keep(result, waveforms, test.scenario, nominal)
                self.finished.append(result)

    def results(self) -> Results:
        """What is finished, as one result object."""
        job = self.job
        origin = provenance(job.profile, job.parameters, self.request.command, self.created)
        return conclude(self.finished, [summarise(job.profile, job.tests)], origin)

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

    def _keep(self, result: TestResult, waveforms: Waveforms, scenario: Scenario, nominal: Nominal) -> TestResult:
        stem = self.output.waveforms / result.id
        write_comtrade(
            waveforms,
            stem,
            station=self.job.profile.id,
            device="pvlvrt-check",
            frequency_hz=nominal.frequency_hz,
            start=self.created,
            trigger_s=scenario.start_s,
        )
        if self.request.csv:
            write_csv(waveforms, stem.with_name(f"{result.id}.csv"))
        profile = self.job.profile
        envelope = profile.envelope.points if profile.envelope else None
        self.figures[result.id] = test_figure(waveforms, result, nominal, envelope, _limits(profile))
        return result.model_copy(update={"waveforms": f"{WAVEFORMS}/{result.id}.cfg"})


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
    for profile in results.profiles:
        _show_doubts(screen, profile.notes)
    screen.print(f"Report: {Path(request.output) / 'report.html'}", soft_wrap=True)


def _show_doubts(screen: Console, notes: tuple[str, ...]) -> None:
    """Name what is not verified; what the project itself has chosen is only counted, the report lists it."""
    chosen = [note for note in notes if f": {CHOSEN} (" in note]
    for note in notes:
        if note not in chosen:
            # In a file a note stays one line; a terminal would cut it in the middle of a word.
            screen.print(f"Not verified: {note}", soft_wrap=not screen.is_terminal)
    if chosen:
        screen.print(f"Not verified: {len(chosen)} numbers that this project has chosen (the report lists them)")
