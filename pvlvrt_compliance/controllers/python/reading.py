"""What a file of Python says of a class where it cannot be imported: its text is read, and nothing of it is run."""

import ast
import importlib.util
import inspect
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.faults import Faults
from pvlvrt_compliance.controllers.file import content_of
from pvlvrt_compliance.controllers.python.importing import Found, class_in
from pvlvrt_compliance.controllers.spelling import names_module

_AS_WRITTEN = "its class is shown as it is written in its file, and may say more when it runs"
_UNREAD = "what its class says is not known: shown are the ports of one that says nothing of them"


def class_or_text(place: str, name: str, faults: Faults) -> Found:
    """A class; of one that cannot be had, where that is kept, what its file says of it.

    Raises
    ------
    DoorError
        As of `class_in`, unless it is kept and the file says something.
    """
    try:
        return class_in(place, name)
    except DoorError as error:
        read = as_written(place, name) if faults.kept else None
        if read is None:
            raise
        faults.tell(str(error))
        return read


def as_written(place: str, name: str) -> Found | None:
    """A class like the one that a file has, with the attributes and defaults that are plain values there.

    Parameters
    ----------
    place : str
        File or module.
    name : str
        Of the class.

    Returns
    -------
    Found or None
        None when there is no such file, or no such class in it. Of a file that is no Python a class that says nothing.
    """
    file = _file_of(place, name)
    if file is None:
        return None
    try:
        tree = ast.parse(content_of(file))
    except DoorError:
        return None
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return Found(type(name, (), {}), file, (_UNREAD,))
    made: dict[str, type] = {}
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            made[node.name] = _class_of(node, made)
    return Found(made[name], file, (_AS_WRITTEN,)) if name in made else None


def _file_of(place: str, name: str) -> Path | None:
    if not names_module(f"{place}:{name}"):
        return Path(place)
    with suppress(BaseException):  # a package that the module lies in is imported, and may do anything
        found = importlib.util.find_spec(place)
        return Path(found.origin) if found is not None and found.origin else None
    return None


def _class_of(node: ast.ClassDef, known: dict[str, type]) -> type:
    bases = [known[base.id] for base in node.bases if isinstance(base, ast.Name) and base.id in known]
    body: dict[str, Any] = dict(_attributes(node))
    for function in node.body:
        if isinstance(function, ast.FunctionDef) and function.name == "__init__":
            body["__signature__"] = inspect.Signature(list(_arguments(function.args)))
        elif isinstance(function, ast.FunctionDef) and not function.name.startswith("__"):
            body[function.name] = _does_nothing
    made: type = type(node.name, tuple(dict.fromkeys(bases))[:1], body)
    return made


def _attributes(node: ast.ClassDef) -> Iterator[tuple[str, Any]]:
    for statement in node.body:
        targets = statement.targets if isinstance(statement, ast.Assign) else []
        if isinstance(statement, ast.AnnAssign) and statement.value is not None:
            targets = [statement.target]
        for target in targets:
            if isinstance(target, ast.Name) and not target.id.startswith("__"):
                assert isinstance(statement, (ast.Assign, ast.AnnAssign))
                with suppress(ValueError):
                    yield target.id, _value(statement.value)


def _arguments(given: ast.arguments) -> Iterator[inspect.Parameter]:
    """Arguments of a constructor that have plain values as defaults; without ``self``."""
    placed = given.posonlyargs + given.args
    pairs = [
        *zip(placed[len(placed) - len(given.defaults) :], given.defaults, strict=True),
        *zip(given.kwonlyargs, given.kw_defaults, strict=True),
    ]
    for argument, default in pairs:
        with suppress(ValueError):
            yield inspect.Parameter(argument.arg, inspect.Parameter.KEYWORD_ONLY, default=_value(default))


def _value(node: ast.expr | None) -> Any:
    """A plain value.

    Raises
    ------
    ValueError
        When it is to be computed.
    """
    try:
        if node is not None:
            return ast.literal_eval(node)
    except (ValueError, TypeError, SyntaxError, RecursionError, MemoryError):
        pass
    raise ValueError


def _does_nothing(*_given: Any) -> None: ...
