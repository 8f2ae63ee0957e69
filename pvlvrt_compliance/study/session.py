"""A job in, a stream of judged tests out."""

from collections.abc import Callable, Generator, Iterator
from contextlib import closing, contextmanager
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from pvlvrt_compliance.checks.rows import is_judged_as_one
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.results import TestResult
from pvlvrt_compliance.study.job import Job
from pvlvrt_compliance.study.named import Named
from pvlvrt_compliance.study.opening import open_controller
from pvlvrt_compliance.study.selection import Assignment
from pvlvrt_compliance.study.timing import Stopwatch

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator
    from pvlvrt_compliance.study.run import Judged

Progress = Callable[[str, int, int], None]
"""Told before every test: its profile and id, how many tests are finished, how many there are without further runs."""

Keep = Callable[[Assignment, TestResult, Evidence], TestResult]
"""Keeps something of a record and says so in its result."""


Ends = Callable[[TestResult], bool]
"""Whether a run ends with a result."""


class Tested(NamedTuple):
    """A test that is finished."""

    profile: Profile
    test: TestCase
    result: TestResult
    made: Any = None  # what was made of its record; None where there is none


def session(
    job: Job,
    *,
    each: Named | None = None,
    keep: Keep | None = None,
    progress: Progress | None = None,
    controller: "ForeignSimulator | None" = None,
    ends: Ends | None = None,
) -> Generator[Tested, None, None]:
    """Run a job's tests, each scenario once however many profiles judge it.

    Rows of a table stay together: where a profile repeats a row, the further runs that it asks for come besides, and a
    run that was not ridden through comes when its row is decided (`rows`).

    Parameters
    ----------
    job : Job
        What is to be run.
    each : Named, optional
        Makes something of every judged record where that is, for instance its figure.
    keep : callable, optional
        Writes the record somewhere; called before ``each``.
    progress : callable, optional
        Hears of each test before it is run.
    controller : ForeignSimulator, optional
        The job's controller, where it is open already.
    ends : callable, optional
        Says of a result whether the run ends with it: nothing is begun after it but what its row still asks for.

    Yields
    ------
    Tested
        Tests that share a scenario follow one another. One that cannot be simulated is an `error` with the reason.

    Raises
    ------
    UsageError
        Before the first test: when the controller cannot be used, or there is no function of the name.
    """
    controller = controller or open_controller(job)
    make = each.found() if each else None
    with closing(_judged(job, controller, progress or _nobody, ends or _never)) as stream:
        for item, judged in stream:
            watch, result, made, evidence = Stopwatch(), judged.result, None, judged.evidence
            if evidence is not None:
                result = keep(item, result, evidence) if keep else result
                made = make(evidence, result) if make else None
            yield Tested(item.profile, item.test, _took(result, watch), made)


def _took(result: TestResult, watch: Stopwatch) -> TestResult:
    """A result with the time that was spent on it besides."""
    return result.model_copy(update={"wall_time_s": result.wall_time_s + watch.elapsed_s})


def _nobody(_test: str, _done: int, _total: int) -> None:
    """Nobody hears of it."""


def _never(_result: TestResult) -> bool:
    """The run goes on whatever is found."""
    return False


@contextmanager
def _stopped_early(controller: "ForeignSimulator | None") -> Iterator[None]:
    """Stop what a controller is at where the run ends early: its next run must find it free."""
    try:
        yield
    except BaseException:
        if controller is not None:
            controller.stop()
        raise


def _judged(
    job: Job, controller: "ForeignSimulator | None", progress: Progress, ends: Ends
) -> "Generator[tuple[Assignment, Judged], None, None]":
    # The simulator is compiled, or read from its cache, on this import and on the first run.
    from pvlvrt_compliance.controllers.process.scratch import clear_abandoned
    from pvlvrt_compliance.simulation.simulate import simulate
    from pvlvrt_compliance.study.rows import run_rows
    from pvlvrt_compliance.study.run import run_test
    from pvlvrt_compliance.study.sharing import SharedSimulator, in_turn

    clear_abandoned()
    rows = in_turn(job.tests, job.first)
    in_order = [item for row in rows for item in row]
    done = 0
    with (
        _stopped_early(controller),
        SharedSimulator(controller or simulate, in_order, job.parameters) as simulator,
    ):

        def judge_one(profile: Profile, test: TestCase) -> "Judged":
            progress(f"{profile.id} {test.id}", done, len(job.tests))
            watch = Stopwatch()  # a record may be at hand: what counts is how long the run has waited for it
            judged = run_test(profile, test, job.parameters, simulator)
            return judged._replace(result=_took(judged.result, watch))

        for row in rows:
            profile, ended = row[0].profile, False
            for test, judged in run_rows(profile, [item.test for item in row], partial(judge_one, profile)):
                yield Assignment(profile, test), judged
                done += 1
                ended = ended or ends(judged.result)
                if ended and not is_judged_as_one(profile, test):
                    return
            if ended:
                return
