"""What draws panels into a file: one module a drawer, found by its `SUFFIX`, with `render(name, title, panels)`.

A drawer that is put here is offered at once: nothing else knows one by name. None imports a library that draws before
it does.
"""

import pkgutil
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from typing import NamedTuple, get_args

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.report import drawing
from pvlvrt_compliance.report.drawing import svg
from pvlvrt_compliance.report.drawing.model import Panel, Scale

Render = Callable[[str, str, Sequence[Panel]], str | bytes]


class Drawer(NamedTuple):
    """The suffix of its files, and what makes their content."""

    suffix: str
    render: Render


def drawers() -> dict[str, Drawer]:
    """All drawers, by their suffix, against the alphabet of their modules."""
    names = sorted((module.name for module in pkgutil.iter_modules(drawing.__path__)), reverse=True)
    modules = [import_module(f"{drawing.__name__}.{name}") for name in names]
    return {module.SUFFIX: Drawer(module.SUFFIX, module.render) for module in modules if hasattr(module, "SUFFIX")}


def drawer_for(file: str, option: str) -> Drawer:
    """What draws into a file of this name; SVG, which needs nothing more, where the name is left open (empty).

    Raises
    ------
    UsageError
        When nothing does, with the suffixes that are known; ``option`` is how the file was asked for.
    """
    known = drawers()
    found = known.get(Path(file).suffix.lower() if file else svg.SUFFIX)
    if found is None:
        raise UsageError(f"{option} {file}: the name must end in {', '.join(known)}")
    return found


def scale_named(name: str, option: str) -> Scale:
    """The scale of an axis by its name.

    Raises
    ------
    UsageError
        When there is none, with those that there are; ``option`` is how it was asked for.
    """
    scales: tuple[Scale, ...] = get_args(Scale)
    for scale in scales:
        if scale == name:
            return scale
    raise UsageError(f"{option} {name}: allowed are {', '.join(scales)}")
