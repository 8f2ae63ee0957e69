"""The doors that there are, found by listing the folders of this room, and which one a specification leads to."""

from collections.abc import Iterator, Mapping
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from typing import Any

from pvlvrt_compliance import controllers
from pvlvrt_compliance.controllers.description import Value
from pvlvrt_compliance.controllers.door import Door, DoorError
from pvlvrt_compliance.controllers.faults import RAISED, Faults
from pvlvrt_compliance.controllers.python.door import PythonDoor
from pvlvrt_compliance.controllers.spelling import names_module


def _listed() -> Iterator[type[Door]]:
    for folder in iter_modules(controllers.__path__, f"{controllers.__name__}."):
        if folder.ispkg and "door" in {module.name for module in iter_modules(import_module(folder.name).__path__)}:
            yield import_module(f"{folder.name}.door").DOOR


DOORS: tuple[type[Door], ...] = tuple(_listed())
"""In the order of their folders."""


def door_to(
    spec: str,
    given: Mapping[str, Value],
    mapping: str | None = None,
    faults: Faults = RAISED,
    *,
    allow_out_of_range: bool = False,
) -> Door:
    """Door to a controller; ``given`` are the parameters that the user has set, ``mapping`` names a mapping file.

    With ``allow_out_of_range`` these may be out of the ranges that the controller states for them.

    Raises
    ------
    DoorError
        When no door fits, or there is nothing behind it; of faults that are kept only where nothing more can be known.
    """
    found = _by_scheme(spec) or _by_suffix(spec) or _by_module(spec)
    if found is None:
        *first, last = (door.written for door in DOORS)
        raise DoorError(f"not a kind of controller that is known; write {', '.join(first)} or {last}")
    if not (faults.kept and found.keeps_faults):
        return found(spec, given, mapping, allow_out_of_range=allow_out_of_range)
    with_faults: Any = found
    made: Door = with_faults(spec, given, mapping, faults, allow_out_of_range=allow_out_of_range)
    return made


def _by_scheme(spec: str) -> type[Door] | None:
    return next((door for door in DOORS if spec.startswith(door.schemes)), None)


def _by_module(spec: str) -> type[Door] | None:
    """By being written as a module and a class, ``pkg.module:Class``, which only Python has."""
    return PythonDoor if names_module(spec) else None


def _by_suffix(spec: str) -> type[Door] | None:
    """By how the file's name ends; the last suffix counts before those inside (``libctrl.so.1``)."""
    names = [Path(spec), Path(spec.rpartition(":")[0])]  # FILE.py:CLASS
    suffixes = [suffix for name in names for suffix in reversed(name.suffixes)]
    last = [name.suffix for name in names]
    return next((door for suffix in [*last, *suffixes] for door in DOORS if suffix in door.suffixes), None)
