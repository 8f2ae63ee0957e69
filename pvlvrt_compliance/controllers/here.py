"""A controller that is given in Python: its class, a function that makes it, or one that is made already.

What is given exists in this process, and is run in it as it is. Only where tests are to be run in other processes a
class is named by the file that these can import, if there is one; see `spec_of`.
"""

import copy
import hashlib
import inspect
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from threading import Event
from typing import Any, NamedTuple

from pvlvrt_compliance.controllers import Controller
from pvlvrt_compliance.controllers.description import ParameterInfo, Value
from pvlvrt_compliance.controllers.door import Door
from pvlvrt_compliance.controllers.in_process import InProcess
from pvlvrt_compliance.controllers.python.door import PythonDoor
from pvlvrt_compliance.controllers.python.making import attributes_of
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.simulation.door.native_call import FAILED

Factory = Callable[..., Any]

Given = Factory | Controller
"""A class, a function that makes a controller, or one that is made already."""


class _Digest(NamedTuple):
    """What identifies a controller that is given in Python, and what there is to say of that."""

    sha256: str
    notes: tuple[str, ...]


def spec_of(made: Given) -> str | None:
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


def name_of(made: Given) -> str:
    """Name of a class or function in messages and reports; of a controller that of its class."""
    name = getattr(made, "__qualname__", None) or type(made).__qualname__
    return f"{getattr(made, '__module__', None) or '__main__'}.{name}"


class SimulatorHere(InProcess):
    """Simulator with a controller that is given in Python: each of its tests has one of its own.

    Parameters
    ----------
    made : class, function or object
        A class or a function is called for every test anew; of a controller that is made already a copy is taken now,
        and each test has one of that.
    given : mapping
        Its parameters, as far as they are set.
    allow_out_of_range : bool
        Of no meaning here, as a class states no ranges; which is told.

    Raises
    ------
    UsageError
        When it cannot be made or copied, makes no controller, or parameters are set of one that is made already.
    """

    def __init__(
        self, made: Given, given: Mapping[str, Value] | None = None, *, allow_out_of_range: bool = False
    ) -> None:
        self._made = _maker(made, given or {})
        self._digest = _digest(made)
        super().__init__(name_of(made), given, allow_out_of_range=allow_out_of_range)

    @property
    def stays_here(self) -> str:
        """That it is in this process alone."""
        return "the controller exists in this process alone"

    def _door(self) -> Door:
        return _DoorHere(self._made, self.given, self._digest, self._stopped)


class _Copies:
    """Makes controllers by copying one, as it was at first."""

    def __init__(self, made: Any) -> None:
        self.first = copy.deepcopy(made)

    def __call__(self) -> Any:
        return copy.deepcopy(self.first)


def _maker(made: Any, given: Mapping[str, Value]) -> Factory:
    """What makes the controller of a test.

    Raises
    ------
    UsageError
        When there is none.
    """
    is_made = hasattr(made, "sample_time_s") and not inspect.isclass(made)
    if not is_made:
        if not callable(made):
            said = "give a class, a function that makes it, or a controller that is made already"
            raise UsageError(f"controller {made!r}: {said}")
        return made  # type: ignore[no-any-return]
    if given:
        said = "a controller that is made already takes no parameters; give its class, or make it with them"
        raise UsageError(f"controller.{next(iter(given))}: {said}")
    try:
        return _Copies(made)
    except Exception as error:
        said = "it cannot be copied, and each test has its own; give its class, or a function that makes it"
        raise UsageError(f"controller {name_of(made)}: {said} ({type(error).__name__}: {error})") from None


class _DoorHere(PythonDoor):
    """Door for a class, or a function that makes a controller, until it is stopped."""

    def __init__(self, made: Factory, given: Mapping[str, Value], digest: _Digest, stopped: Event) -> None:
        first = made.first if isinstance(made, _Copies) else None
        self._class_name, self._stopped = name_of(made if first is None else first), stopped
        self._digest, self._notes = digest
        self._begin(made, given)
        if first is not None:  # what it was made with is seen by its attributes alone
            self._parameters = tuple(ParameterInfo(name, value) for name, value in attributes_of(first).items())

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


def _digest(made: Any) -> _Digest:
    """SHA-256 of its source, as far as that can be had, else of its name, which is noted then."""
    of = made if inspect.isclass(made) or inspect.isroutine(made) or not hasattr(made, "sample_time_s") else type(made)
    functions: list[Any] = [of]
    if inspect.isclass(of):
        functions += [of_class for of_class in of.__mro__[1:] if of_class is not object]
        functions += [x for x in vars(of).values() if inspect.isfunction(x)]
    sources = []
    for function in functions:
        with suppress(OSError, TypeError):
            sources.append(inspect.getsource(function))
    content = "\n".join(sources or [name_of(made)])
    notes = () if sources else ("its source is not at hand: the digest is of its name alone",)
    return _Digest(hashlib.sha256(content.encode()).hexdigest(), notes)


def _from_here(file: Path) -> Path:
    """A file as it is named from the working folder, where it stands in it."""
    resolved = file.resolve()
    return resolved.relative_to(Path.cwd()) if resolved.is_relative_to(Path.cwd()) else resolved
