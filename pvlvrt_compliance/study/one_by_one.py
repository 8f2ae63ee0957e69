"""Tests of a job, each run when somebody asks for it, in any order: for programs that have a loop of their own."""

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from pvlvrt_compliance.checks.rows import is_judged_as_one
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.results import TestResult
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.study.baseline.applying import with_baseline
from pvlvrt_compliance.study.job import Job
from pvlvrt_compliance.study.opening import open_controller
from pvlvrt_compliance.study.ordering import rows_of, shared_together
from pvlvrt_compliance.study.selection import Assignment
from pvlvrt_compliance.waveforms import Waveforms

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator
    from pvlvrt_compliance.study.run import Judged, Simulator


class OneByOne:
    """The tests of a job, to be run one by one.

    Nothing is opened or compiled before the first of them. A test that its profile judges by all runs of its row
    (`rows`) is run with these, and their results are kept for when they are asked for.
    """

    def __init__(self, job: Job) -> None:
        self._job = job
        rows = shared_together(rows_of(job.tests))
        self._rows = {item.key: row for row in rows for item in row}
        self._found: dict[str, tuple[TestResult, ...]] = {}
        self._controller: ForeignSimulator | None = None
        self._simulator: Callable[[Scenario, Parameters], Waveforms] | None = None
        self.tests: tuple[Assignment, ...] = tuple(item for row in rows for item in row)
        """In an order in which those that share a scenario follow one another: its record is made once then."""

    def row_of(self, item: Assignment) -> str:
        """Name of the row that a test is judged with; empty of one that is judged alone."""
        return f"{item.profile.id}.{item.test.row}" if is_judged_as_one(item.profile, item.test) else ""

    def results(self, item: Assignment) -> tuple[TestResult, ...]:
        """Results of a test, run now if they are not there yet: its own; of the last of a row further runs, too.

        Raises
        ------
        UsageError
            When the job's controller cannot be opened.
        BaseException
            What ends the run early; the controller is stopped then, and opened anew for the next test.
        """
        if item.key not in self._found:
            row = self._rows[item.key] if self.row_of(item) else (item,)
            try:
                self._found |= self._run(row)
            except BaseException:
                controller, self._controller, self._simulator = self._controller, None, None
                if controller is not None:
                    controller.stop()
                raise
        return self._found[item.key]

    def _run(self, row: tuple[Assignment, ...]) -> dict[str, tuple[TestResult, ...]]:
        from pvlvrt_compliance.study.rows import run_rows

        profile, cases = row[0].profile, [item.test for item in row]
        found: dict[str, tuple[TestResult, ...]] = {item.key: () for item in row}
        for test, judged in run_rows(profile, cases, partial(self._judge, profile)):
            key = Assignment(profile, test).key
            owner = key if key in found else row[-1].key
            known = self._job.baseline
            found[owner] += (judged.result if known is None else with_baseline(judged.result, known),)
            if judged.evidence is not None:
                judged.evidence.forget()
        return found

    def _judge(self, profile: Profile, test: TestCase) -> "Judged":
        from pvlvrt_compliance.study.run import run_test

        if self._simulator is None:
            self._simulator = self._opened()
        return run_test(profile, test, self._job.parameters, self._simulator)

    def _opened(self) -> "Simulator":
        from pvlvrt_compliance.controllers.process.scratch import clear_abandoned
        from pvlvrt_compliance.study.reuse.opening import simulator_for

        clear_abandoned()
        self._controller = open_controller(self._job)
        return _LastRecord(simulator_for(self._job, self._controller))


class _LastRecord:
    """A simulator that gives its last record again where the next test has the same scenario."""

    def __init__(self, simulator: "Simulator") -> None:
        self._simulator = simulator
        self._last: tuple[Scenario, Waveforms] | None = None

    def __call__(self, scenario: Scenario, parameters: Parameters) -> Waveforms:
        if self._last is None or self._last[0] != scenario:
            self._last = None  # two records at a time would be one too many
            self._last = (scenario, self._simulator(scenario, parameters))
        return self._last[1]
