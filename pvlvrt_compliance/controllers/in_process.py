"""A controller that runs in the process that judges it: a class that exists there alone, or one to be debugged."""

import sys
from abc import abstractmethod
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager
from typing import Any

import numpy as np

from pvlvrt_compliance.controllers.debugging import debugged
from pvlvrt_compliance.controllers.description import Description, Value
from pvlvrt_compliance.controllers.door import Door, DoorError, described
from pvlvrt_compliance.controllers.doors import door_to
from pvlvrt_compliance.controllers.limits import Limits
from pvlvrt_compliance.controllers.process.worker import RunJob, record_of
from pvlvrt_compliance.controllers.run import ForeignRecord
from pvlvrt_compliance.controllers.simulator import ForeignSimulator
from pvlvrt_compliance.errors import PvlvrtError, SimulationError, UsageError
from pvlvrt_compliance.simulation.door import ending
from pvlvrt_compliance.simulation.door.exchange import PROGRESSES
from pvlvrt_compliance.simulation.parameters import Parameters


class InProcess(ForeignSimulator):
    """Simulator whose controller runs in this process, in the thread that asks for the record.

    An exception that it raises is an error of that test. Nothing holds it otherwise: what it prints is printed, a crash
    is one of this process, and it may take as long as it likes. Ctrl-C while it computes ends the run, and so does a
    debugger that is left: nothing of that is the controller's.
    """

    is_in_process = True

    def __reduce__(self) -> tuple[Any, ...]:
        """There is no other process that could have it."""
        raise TypeError(self.stays_here)

    def stop(self) -> None:
        """Have the run that may be under way in another thread end with its next sample."""
        self._stopped.set()

    @abstractmethod
    def _door(self) -> Door:
        """The door, not open yet."""

    def _describe(self, parameters: Parameters) -> Description:
        del parameters  # there are no limits
        try:
            with _ending_as_asked(self.stop), closing(self._door()) as door:
                return described(door)
        except DoorError as error:
            raise UsageError(f"controller {self.spec}: {error}") from None

    def _run(self, job: RunJob, limits: Limits) -> ForeignRecord:
        del limits
        if self._stopped.is_set():
            raise SimulationError("the run was stopped")
        try:
            with _ending_as_asked(self.stop), closing(self._door()) as door:
                return record_of(door, job, np.full(PROGRESSES, np.nan))
        except PvlvrtError as error:  # a door that does not open, too, is an error of this test, as in another process
            raise SimulationError(str(error)) from None


class Debugged(InProcess):
    """Simulator with a controller by its specification, in this process: see `debugging`.

    Parameters
    ----------
    spec, given, mapping, allow_out_of_range
        As of `ForeignSimulator`.

    Raises
    ------
    UsageError
        When it cannot be opened.
    """

    def __init__(
        self, spec: str, given: Mapping[str, Value], mapping: str | None = None, *, allow_out_of_range: bool = False
    ) -> None:
        super().__init__(spec, given, mapping, allow_out_of_range=allow_out_of_range)

    @property
    def stays_here(self) -> str:
        """That it is to be debugged here."""
        return "the controller is debugged in this one"

    def _door(self) -> Door:
        return door_to(self.spec, self.given, self._mapping, allow_out_of_range=self._allow_out_of_range)

    def _describe(self, parameters: Parameters) -> Description:
        with debugged():
            return super()._describe(parameters)

    def _run(self, job: RunJob, limits: Limits) -> ForeignRecord:
        with debugged():
            return super()._run(job, limits)


@contextmanager
def _ending_as_asked(stop: Callable[[], None]) -> Iterator[None]:
    """End the run where something has been met in the controller that is not its own; a debugger is left by Ctrl-C.

    A signal may come as a function in Python is entered from compiled code, before anything there could catch it:
    Python calls that unraisable, and goes on.
    """
    ending.take()  # of an earlier run in this thread, which somebody has seen to
    before = sys.unraisablehook

    def met_unraisable(unraisable: "sys.UnraisableHookArgs") -> None:
        if unraisable.exc_value is not None and (end := ending.from_outside(unraisable.exc_value)):
            ending.keep(end)
            stop()
        else:
            before(unraisable)

    sys.unraisablehook = met_unraisable
    try:
        yield
    except BaseException as error:
        met = ending.from_outside(error) or ending.take()
        if met is None:
            raise
    else:
        met = ending.take()
    finally:
        sys.unraisablehook = before
    if met is not None:
        raise KeyboardInterrupt("the debugger was left") if ending.is_of_the_debugger(met) else met
