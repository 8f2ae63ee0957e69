"""What is run in one place: the rows of a job that share a scenario, and the work done with them."""

from collections.abc import Callable, Collection, Generator, Iterable, Sequence
from functools import partial
from typing import TYPE_CHECKING

from pvlvrt_compliance.checks.rows import is_judged_as_one
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.results import TestResult
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.study.ordering import in_turn
from pvlvrt_compliance.study.reuse.record_file import Reused
from pvlvrt_compliance.study.selection import Assignment
from pvlvrt_compliance.study.timing import Stopwatch
from pvlvrt_compliance.study.work import Tested, Work

if TYPE_CHECKING:
    from pvlvrt_compliance.study.run import Judged, Simulator

Row = tuple[Assignment, ...]

Unit = tuple[Row, ...]
"""Rows of which each shares a scenario with another: a record that several tests need is made in one place."""

Begins = Callable[[Assignment], None]
"""Told of every test before it is run."""


def units_of(assignments: Iterable[Assignment], first: Collection[str] = ()) -> list[Unit]:
    """The rows of a job by what they share, in the order in which they are run (`ordering.in_turn`)."""
    units: list[list[Row]] = []
    of_scenario: dict[Scenario, int] = {}
    for row in in_turn(assignments, first):
        scenarios = {item.test.scenario for item in row}
        shared = sorted({of_scenario[scenario] for scenario in scenarios if scenario in of_scenario})
        number = shared[0] if shared else len(units)
        if not shared:
            units.append([])
        units[number].append(row)
        for other in shared[1:]:  # the row joins what was apart so far
            units[number] += units[other]
            units[other] = []
            scenarios |= {scenario for scenario, owner in of_scenario.items() if owner == other}
        of_scenario |= dict.fromkeys(scenarios, number)
    return [tuple(unit) for unit in units if unit]


def items_of(unit: Unit) -> list[Assignment]:
    """The tests of a unit, in order."""
    return [item for row in unit for item in row]


def cost_s(unit: Unit) -> float:
    """What a unit costs, in seconds that are simulated: each of its scenarios once."""
    return sum(scenario.end_s for scenario in {item.test.scenario: None for item in items_of(unit)})


def run_unit(work: Work, unit: Unit, simulator: "Simulator", begins: Begins) -> Generator[Tested, None, bool]:
    """Run and judge the rows of a unit, each with the further runs that its profile asks for (`rows`).

    Records are kept before anything is made of them; what further runs share with another unit is kept twice, so that
    it is the same wherever the units are run.

    Parameters
    ----------
    work : Work
        What is done with each test.
    unit : Unit
    simulator : callable
        Makes the records.
    begins : callable
        Told of each test before it is run.

    Yields
    ------
    Tested

    Returns
    -------
    bool
        Whether the run ends with it: nothing is begun after a failure but what its row still asks for.
    """
    from pvlvrt_compliance.study.records import Records  # with what writes files, where there are records

    make = work.each.found() if work.each else None
    records = Records(work.keeping, work.job) if work.keeping else None
    for row in unit:
        ended = False
        for item, judged in _judged(row, work, simulator, begins):
            watch, result, made, evidence = Stopwatch(), judged.result, None, judged.evidence
            if evidence is not None:
                result = records.keep(item, result, evidence) if records else result
                made = make(evidence, result) if make else None
                evidence.forget()
            is_reused = isinstance(judged.waveforms, Reused)
            del judged, evidence  # the next record is made while whoever takes this test has it
            yield Tested(item.profile, item.test, _took(result, watch), made, is_reused)
            ended = ended or work.ends_with(result)
            if ended and not is_judged_as_one(item.profile, item.test):
                return True
        if ended:
            return True
    return False


def _judged(
    row: Sequence[Assignment], work: Work, simulator: "Simulator", begins: Begins
) -> "Generator[tuple[Assignment, Judged], None, None]":
    # The simulator is compiled, or read from its cache, on this import and on the first run.
    from pvlvrt_compliance.study.rows import run_rows
    from pvlvrt_compliance.study.run import run_test

    def judge_one(profile: Profile, test: TestCase) -> "Judged":
        begins(Assignment(profile, test))
        watch = Stopwatch()  # a record may be at hand: what counts is how long the run has waited for it
        judged = run_test(profile, test, work.job.parameters, simulator)
        return judged._replace(result=_took(judged.result, watch))

    profile = row[0].profile
    for test, judged in run_rows(profile, [item.test for item in row], partial(judge_one, profile)):
        yield Assignment(profile, test), judged


def _took(result: TestResult, watch: Stopwatch) -> TestResult:
    """A result with the time that was spent on it besides."""
    return result.model_copy(update={"wall_time_s": result.wall_time_s + watch.elapsed_s})
