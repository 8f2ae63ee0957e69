"""A class by the file or the module that it is in."""

import importlib
import importlib.util
import inspect
import sys
import traceback
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.file import check_there
from pvlvrt_compliance.controllers.process.command import is_the_server
from pvlvrt_compliance.controllers.spelling import SUFFIX, names_module
from pvlvrt_compliance.errors import did_you_mean
from pvlvrt_compliance.ordinary_file import is_there
from pvlvrt_compliance.simulation.door.ending import from_outside, is_of_the_debugger

_OF_A_PACKAGE = "__init__.py"
_TRACEBACK_LINES = 6
_LONGEST_REASON = 2000  # characters of an exception
_IN_HERE = Path(__file__).parent


class Found(NamedTuple):
    """A class, and the file that it is in."""

    made: Any
    file: Path
    notes: tuple[str, ...] = ()  # how it was found, where that needs saying


def class_in(place: str, name: str) -> Found:
    """Class of a file, or of a module that is installed or lies in the working folder.

    A file in a folder with an ``__init__.py`` is imported as part of that package, so that relative imports work.

    Raises
    ------
    DoorError
        When there is no such file or module, it cannot be imported, or it has no such class.
    """
    module, file = _module(place) if names_module(f"{place}:{name}") else _of_file(Path(place))
    found = getattr(module, name, None)
    if not inspect.isclass(found):
        classes = [n for n, x in vars(module).items() if inspect.isclass(x) and x.__module__ == module.__name__]
        raise DoorError(f"{place} has no class {name!r}{did_you_mean(name, classes)}")
    return Found(found, file)


def let_pass(error: BaseException) -> None:
    """Raise again what ends a run from outside; in the process of a controller all that is raised is its own."""
    end = None if is_the_server() else from_outside(error)
    if end is not None:
        raise end


def tail(error: BaseException) -> str:
    """An exception, and the last lines of where it came from."""
    frames = [f for f in traceback.extract_tb(error.__traceback__) if Path(f.filename).parent != _IN_HERE]
    own = [f for f in frames if "importlib" not in f.filename]
    lines = [  # of a class that was typed there is no text
        f"  {Path(f.filename).name}, line {f.lineno}, in {f.name}{f': {f.line}' if f.line else ''}"
        for f in own[-_TRACEBACK_LINES:]
    ]
    said = "".join(traceback.format_exception_only(error)).strip()[:_LONGEST_REASON]
    return "\n".join([said, *lines, *_hint(error)])


def _hint(error: BaseException) -> tuple[str, ...]:
    """What to do about it, where that is known: a process of its own has no terminal that a debugger could ask."""
    return ("breakpoint() needs --debug",) if is_of_the_debugger(error) and is_the_server() else ()


def _module(name: str) -> tuple[ModuleType, Path]:
    """Module by its name, and its file."""
    _reach(Path.cwd())
    try:
        found = importlib.util.find_spec(name)
    except ModuleNotFoundError as error:
        found, missing = None, error.name or name
    except BaseException as error:  # a package that the module lies in is imported, and may do anything
        let_pass(error)
        raise DoorError(f"{name} cannot be imported: {tail(error)}") from None
    else:
        missing = name
    if found is None:
        raise DoorError(f"there is no module {missing}, installed or in {Path.cwd()}; a file is FILE.py:CLASS")
    if not found.origin or not found.origin.endswith(SUFFIX):
        raise DoorError(f"{name} is no module that is written in Python")
    return _imported(name, name), Path(found.origin)


def _of_file(file: Path) -> tuple[ModuleType, Path]:
    """Module of a file, with the modules beside it within reach."""
    check_there(file)
    path = file.resolve()
    folder, names = path.parent, [path.stem]
    while is_there(folder / _OF_A_PACKAGE) and folder.name.isidentifier() and folder != folder.parent:
        folder, names = folder.parent, [folder.name, *names]
    _reach(path.parent)
    if len(names) > 1 and path.stem.isidentifier():
        _reach(folder)
        return _imported(".".join(names), str(file)), file
    specification = importlib.util.spec_from_file_location(file.stem, file)
    if specification is None or specification.loader is None:
        raise DoorError(f"{file} is not a Python file")
    module = importlib.util.module_from_spec(specification)
    sys.modules[file.stem] = module
    try:
        specification.loader.exec_module(module)
    except BaseException as error:
        let_pass(error)
        raise DoorError(f"{file} cannot be imported: {tail(error)}") from None
    return module, file


def _reach(folder: Path) -> None:
    """Have what lies in a folder be found first; once, however often a controller is opened in this process."""
    sys.path[:] = [str(folder), *(place for place in sys.path if place != str(folder))]


def _imported(name: str, shown: str) -> ModuleType:
    try:
        return importlib.import_module(name)
    except BaseException as error:
        let_pass(error)
        raise DoorError(f"{shown} cannot be imported: {tail(error)}") from None
