"""Tests run in this process, one after the other."""

from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, NamedTuple

from pvlvrt_compliance.study.executors.executor import Finished
from pvlvrt_compliance.study.executors.units import Begins, Unit, items_of, run_unit
from pvlvrt_compliance.study.work import Tested, Work

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator
    from pvlvrt_compliance.study.run import Simulator


class Here(NamedTuple):
    """Runs units in this process (`Executor`).

    Parameters
    ----------
    controller : ForeignSimulator, optional
        The job's own, opened; it is stopped where the run ends early.
    is_ahead : bool
        Whether the next record is made while one is judged: a second core is used then.
    """

    controller: "ForeignSimulator | None" = None
    is_ahead: bool = True

    def run(self, work: Work, units: Sequence[Unit], begins: Begins) -> Generator[Finished, None, None]:
        """Run units one after the other, as of `Executor`."""
        from pvlvrt_compliance.controllers.process.scratch import clear_abandoned
        from pvlvrt_compliance.study.reuse.opening import simulator_for
        from pvlvrt_compliance.study.sharing import SharedSimulator

        clear_abandoned()
        to_run = [item for unit in units for item in items_of(unit)]
        made_here = self.controller is not None and self.controller.is_in_process
        simulator = SharedSimulator(
            *(simulator_for(work.job, self.controller), to_run, work.job.parameters),
            is_ahead=self.is_ahead,
            in_thread=not made_here,  # breakpoints, Ctrl-C and what is printed belong to the thread that has begun it
        )
        with _stopped_early(self.controller), simulator:
            for number, unit in enumerate(units):
                ended = yield from _numbered(number, run_unit(work, unit, simulator, begins))
                if ended:
                    return


def run_alone(
    work: Work,
    units: Sequence[Unit],
    number: int,
    controller: "ForeignSimulator | None",
    begins: Begins,
    simulator: "Simulator | None" = None,
) -> Generator[Finished, None, bool]:
    """Run one of the units with nothing that was there before it, on one core: as a worker does, wherever it is.

    Parameters
    ----------
    work, units, begins
        As of `Executor.run`.
    number : int
        Of the unit.
    controller : ForeignSimulator, optional
        The job's own, opened in this process; its notes become those of this unit.
    simulator : callable, optional
        What makes the records of the job, where it is at hand (`simulator_for`).

    Yields
    ------
    Finished
        With the notes of the controller.

    Returns
    -------
    bool
        Whether the run ends with it.
    """
    from pvlvrt_compliance.study.reuse.opening import simulator_for
    from pvlvrt_compliance.study.sharing import SharedSimulator

    unit, new = units[number], _new_notes(controller)
    simulator = simulator or simulator_for(work.job, controller)
    shared = SharedSimulator(simulator, items_of(unit), work.job.parameters, is_ahead=False)
    with _stopped_early(controller), shared:
        stream = _numbered(number, run_unit(work, unit, shared, begins))
        while True:
            try:
                finished = next(stream)
            except StopIteration as end:
                return bool(end.value)
            yield finished._replace(notes=new())


def _numbered(number: int, stream: "Generator[Tested, None, bool]") -> Generator[Finished, None, bool]:
    """The tests of a unit with its number."""
    while True:
        try:
            tested = next(stream)
        except StopIteration as end:
            return bool(end.value)
        yield Finished(number, tested.test, tested.result, tested.made, is_reused=tested.is_reused)


def _new_notes(controller: "ForeignSimulator | None") -> Callable[[], list[str]]:
    """What gives the notes of a controller that are new, from now on."""
    if controller is None:
        return list
    controller.notes.clear()
    told = 0

    def new() -> list[str]:
        nonlocal told
        begin, told = told, len(controller.notes)
        return controller.notes[begin:]

    return new


@contextmanager
def _stopped_early(controller: "ForeignSimulator | None") -> Iterator[None]:
    """Stop what a controller is at where the run ends early: its next run must find it free."""
    try:
        yield
    except BaseException:
        if controller is not None:
            controller.stop()
        raise
