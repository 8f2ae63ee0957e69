"""One file a format: its `FILE` in the folder of a run, and `render(results, drawings)`, text or bytes.

A file that is put here is written with every run: nothing else knows a format by name.
"""

import pkgutil
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import NamedTuple

from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.results import Results

Render = Callable[[Results, Mapping[str, Drawing]], str | bytes]


class Format(NamedTuple):
    """A file of a run, and what makes it from the results and from drawings by the key of their test."""

    file: str
    render: Render


def formats() -> tuple[Format, ...]:
    """All formats, by the names of their modules."""
    names = sorted(module.name for module in pkgutil.iter_modules(__path__))
    modules = [import_module(f"{__name__}.{name}") for name in names]
    return tuple(Format(module.FILE, module.render) for module in modules)
