"""One file a format: its `FILE` in the folder of a run, and `render(results, drawings)`, text or bytes.

A file that is put here is written with every run, or where it has `ASKED_FOR = True`, only when its format is asked for
by the name of its module; nothing else knows a format by name. One with `needs()` says there what it lacks
(`UsageError`), before anything is run.
"""

import pkgutil
from collections.abc import Callable, Collection, Mapping
from importlib import import_module
from typing import NamedTuple

from pvlvrt_compliance.errors import UsageError, did_you_mean
from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.results import Results

Render = Callable[[Results, Mapping[str, Drawing]], str | bytes]


class Format(NamedTuple):
    """A file of a run, and what makes it from the results and from drawings by the key of their test."""

    name: str
    file: str
    render: Render
    asked_for: bool
    needs: Callable[[], None]


def formats() -> tuple[Format, ...]:
    """All formats, by the names of their modules."""
    return tuple(map(_format, sorted(module.name for module in pkgutil.iter_modules(__path__))))


def chosen_formats(names: Collection[str], spelled: str = "--format") -> tuple[Format, ...]:
    """Formats that are always written, and those that are asked for by name.

    Raises
    ------
    UsageError
        When there is no format of a name, or it lacks something that is not installed.
    """
    known = {found.name: found for found in formats()}
    for name in names:
        if name not in known:
            hint = did_you_mean(name, known) or f"; there are: {', '.join(known)}"
            raise UsageError(f"{spelled}: no format {name!r}{hint}")
    chosen = tuple(found for found in known.values() if found.name in names or not found.asked_for)
    for found in chosen:
        found.needs()
    return chosen


def _format(name: str) -> Format:
    module = import_module(f"{__name__}.{name}")
    needs = getattr(module, "needs", _nothing)
    return Format(name, module.FILE, module.render, getattr(module, "ASKED_FOR", False), needs)


def _nothing() -> None:
    """A format that needs nothing besides the core."""
