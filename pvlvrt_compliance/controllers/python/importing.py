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
from pvlvrt_compliance.controllers.spelling import SUFFIX, names_module
from pvlvrt_compliance.errors import did_you_mean

_OF_A_PACKAGE = "__init__.py"
_TRACEBACK_LINES = 6
_LONGEST_REASON = 2000  # characters of an exception
_IN_HERE = Path(__file__).parent


class Found(NamedTuple):
    """A class, and the file that it is in."""

    made: Any
    file: Path


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


def tail(error: BaseException) -> str:
    """An exception, and the last lines of where it came from."""
    frames = [f for f in traceback.extract_tb(error.__traceback__) if Path(f.filename).parent != _IN_HERE]
    own = [f for f in frames if "importlib" not in f.filename]
    lines = [f"  {Path(f.filename).name}, line {f.lineno}, in {f.name}: {f.line}" for f in own[-_TRACEBACK_LINES:]]
    said = "".join(traceback.format_exception_only(error)).strip()[:_LONGEST_REASON]
    return "\n".join([said, *lines])


def _module(name: str) -> tuple[ModuleType, Path]:
    """Module by its name, and its file."""
    sys.path.insert(0, str(Path.cwd()))
    try:
        found = importlib.util.find_spec(name)
    except ModuleNotFoundError as error:
        found, missing = None, error.name or name
    except BaseException as error:  # a package that the module lies in is imported, and may do anything
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
    if not file.is_file():
        raise DoorError(f"there is no file {file}")
    path = file.resolve()
    folder, names = path.parent, [path.stem]
    while (folder / _OF_A_PACKAGE).is_file() and folder.name.isidentifier() and folder != folder.parent:
        folder, names = folder.parent, [folder.name, *names]
    sys.path.insert(0, str(path.parent))
    if len(names) > 1 and path.stem.isidentifier():
        sys.path.insert(0, str(folder))
        return _imported(".".join(names), str(file)), file
    specification = importlib.util.spec_from_file_location(file.stem, file)
    if specification is None or specification.loader is None:
        raise DoorError(f"{file} is not a Python file")
    module = importlib.util.module_from_spec(specification)
    sys.modules[file.stem] = module
    try:
        specification.loader.exec_module(module)
    except BaseException as error:
        raise DoorError(f"{file} cannot be imported: {tail(error)}") from None
    return module, file


def _imported(name: str, shown: str) -> ModuleType:
    try:
        return importlib.import_module(name)
    except BaseException as error:
        raise DoorError(f"{shown} cannot be imported: {tail(error)}") from None
