"""A job in, a stream of judged tests out."""

from collections.abc import Callable, Generator
from contextlib import closing
from typing import TYPE_CHECKING

from pvlvrt_compliance.study.executors.executor import Executor, Finished
from pvlvrt_compliance.study.executors.here import Here
from pvlvrt_compliance.study.executors.units import units_of
from pvlvrt_compliance.study.opening import open_controller
from pvlvrt_compliance.study.selection import Assignment
from pvlvrt_compliance.study.store import writing
from pvlvrt_compliance.study.work import Keeping, Tested, Work

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator

Progress = Callable[[str, int, int], None]
"""Told before every test: its profile and id, how many tests are finished, how many there are without further runs."""


def session(
    work: Work,
    *,
    progress: Progress | None = None,
    controller: "ForeignSimulator | None" = None,
    executor: Executor | None = None,
) -> Generator[Tested, None, None]:
    """Run a job's tests, each scenario once however many profiles judge it.

    Rows of a table stay together: where a profile repeats a row, the further runs that it asks for come besides, and a
    run that was not ridden through comes when its row is decided (`rows`).

    Parameters
    ----------
    work : Work
        The job, and what is done with each test.
    progress : callable, optional
        Hears of each test before it is run.
    controller : ForeignSimulator, optional
        The job's controller, where it is open already; what it says in the tests is in its notes.
    executor : Executor, optional
        What runs them; this process, without.

    Yields
    ------
    Tested
        Tests that share a scenario come in their order. One that cannot be simulated is an `error` with the reason.

    Raises
    ------
    UsageError
        Before the first test: when the controller cannot be used, or there is no function of the name.
    OutputError
        When a record cannot be kept.
    """
    controller = controller or open_controller(work.job)
    if work.each:
        work.each.found()
    units, profiles = units_of(work.job.tests, work.job.first), {profile.id: profile for profile in work.job.profiles}
    done, total, notes = 0, len(work.job.tests), _Notes(controller)

    def begins(item: Assignment) -> None:
        if progress:
            progress(f"{item.profile.id} {item.test.id}", done, total)

    with closing((executor or Here(controller)).run(work, units, begins)) as stream:
        for finished in stream:
            notes.take(finished)
            if work.keeping:
                _write(finished, work.keeping)
            profile = profiles[finished.result.profile]
            yield Tested(profile, finished.test, finished.result, finished.made, finished.is_reused)
            done += 1


class _Notes:
    """What a controller says elsewhere, told by it here in the order of the tests, whichever came first."""

    def __init__(self, controller: "ForeignSimulator | None") -> None:
        self._controller = controller
        self._before = list(controller.notes) if controller else []
        self._of_units: dict[int, list[str]] = {}

    def take(self, finished: Finished) -> None:
        """Take what is new with a test."""
        if self._controller is None or not finished.notes:
            return
        self._of_units.setdefault(finished.unit, []).extend(finished.notes)
        in_turn = (note for _, notes in sorted(self._of_units.items()) for note in notes)
        self._controller.notes[:] = dict.fromkeys([*self._before, *in_turn])


def _write(finished: Finished, keeping: Keeping) -> None:
    """Stage the records that come from where there is no such folder."""
    for name, data in finished.files.items():
        with writing(keeping.staging / name, keeping.staging, keeping.folder):
            (keeping.staging / name).write_bytes(data)
