"""A controller that is given in Python: its class, or a function that makes it.

A class that another process can import by its file is run there, as one named by that file; see `spec_of`. All others
exist in this process alone, those of a notebook's cell and of the script that is running, and are run in it.
"""

import hashlib
import inspect
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from threading import Event
from typing import Any

import numpy as np

from pvlvrt_compliance.controllers.description import Description, Value
from pvlvrt_compliance.controllers.door import DoorError, described
from pvlvrt_compliance.controllers.limits import Limits
from pvlvrt_compliance.controllers.process.worker import RunJob
from pvlvrt_compliance.controllers.python.door import PythonDoor
from pvlvrt_compliance.controllers.run import ForeignRecord, run_through
from pvlvrt_compliance.controllers.simulator import ForeignSimulator
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.simulation.door.exchange import PROGRESSES
from pvlvrt_compliance.simulation.door.native_call import FAILED
from pvlvrt_compliance.simulation.parameters import Parameters

Factory = Callable[..., Any]


def spec_of(made: Factory) -> str | None:
    """``FILE.py:CLASS`` of a class that stands in a module of its own file, outside of any package; else None.

    Not of the script that is running: to import it would be to run it anew.
    """
    module = sys.modules.get(getattr(made, "__module__", "") or "")
    name, file = getattr(made, "__qualname__", ""), getattr(module, "__file__", None)
    if not inspect.isclass(made) or module is None or file is None or module.__name__ == "__main__":
        return None
    stands_alone = not module.__package__ and Path(file).suffix == ".py" and Path(file).is_file()
    if not stands_alone or getattr(module, name, None) is not made:
        return None
    return f"{_from_here(Path(file))}:{name}"


def name_of(made: Factory) -> str:
    """Name of a class or function in messages and reports."""
    name = getattr(made, "__qualname__", None) or type(made).__qualname__
    return f"{getattr(made, '__module__', None) or '__main__'}.{name}"


class SimulatorHere(ForeignSimulator):
    """Simulator with a controller of this process: what it does, it does here.

    An exception that it raises is an error of that test. Nothing holds it otherwise: what it prints is printed, a crash
    is one of this process, and it may take as long as it likes.

    Parameters
    ----------
    made : class or function
        Called for every test anew.
    given : mapping
        Its parameters, as far as they are set.

    Raises
    ------
    UsageError
        When it cannot be made, or makes no controller.
    """

    def __init__(self, made: Factory, given: Mapping[str, Value] | None = None) -> None:
        if not callable(made) or (hasattr(made, "sample_time_s") and not inspect.isclass(made)):
            raise UsageError(f"controller {made!r}: give its class, or a function that makes it; each test has its own")
        self._made = made
        super().__init__(name_of(made), given)

    def __reduce__(self) -> tuple[Any, ...]:
        """There is no other process that could have it."""
        raise TypeError(self.stays_here)

    @property
    def stays_here(self) -> str:
        """That it is in this process alone."""
        return "the controller exists in this process alone"

    def stop(self) -> None:
        """Have the run that may be under way in another thread end with its next sample."""
        self._stopped.set()

    def _door(self) -> PythonDoor:
        return _DoorHere(self._made, self.given, self._stopped)

    def _describe(self, parameters: Parameters) -> Description:
        del parameters  # a thread has no limits
        try:
            return described(self._door())
        except DoorError as error:
            raise UsageError(f"controller {self.spec}: {error}") from None

    def _run(self, job: RunJob, limits: Limits) -> ForeignRecord:
        del limits
        progress = np.full(PROGRESSES, np.nan)
        return run_through(self._door(), job.scenario, job.parameters, job.plan, progress, after_trip=job.after_trip)


class _DoorHere(PythonDoor):
    """Door for a class, or a function that makes a controller, until it is stopped."""

    def __init__(self, made: Factory, given: Mapping[str, Value], stopped: Event) -> None:
        self._class_name, self._digest, self._stopped = name_of(made), _digest(made), stopped
        self._begin(made, given)

    def besides(self) -> str:
        """What this process has made of it so far is not known."""
        return "it is made in this process, not from a file"

    def may_be_listed(self) -> bool:
        """There is no file."""
        return False

    def _caller(self, *of_the_run: Any) -> Callable[[Any], int]:
        advance, is_stopped = super()._caller(*of_the_run), self._stopped.is_set

        def advance_until_stopped(argument: Any) -> int:
            return FAILED if is_stopped() else advance(argument)

        return advance_until_stopped


def _digest(made: Factory) -> str:
    """SHA-256 of its source, as far as that can be had, else of its name."""
    functions: list[Factory] = [made]
    if inspect.isclass(made):
        functions += [x for x in vars(made).values() if inspect.isfunction(x)]
    sources = []
    for function in functions:
        with suppress(OSError, TypeError):
            sources.append(inspect.getsource(function))
    return hashlib.sha256("\n".join(sources or [name_of(made)]).encode()).hexdigest()


def _from_here(file: Path) -> Path:
    """A file as it is named from the working folder, where it stands in it."""
    resolved = file.resolve()
    return resolved.relative_to(Path.cwd()) if resolved.is_relative_to(Path.cwd()) else resolved
