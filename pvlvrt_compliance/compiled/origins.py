"""Which files a constant comes from: a number does not say where it was written, the statements that bind it do.

Read from the text of modules: a name is followed through imports to where it is bound, and from there to every name
that decides its value. What cannot be told apart counts as deciding it.
"""

import importlib.util
import sys
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from pvlvrt_compliance.compiled.contents import is_library
from pvlvrt_compliance.compiled.statements import text_of


def origins_of(names: Iterable[tuple[str, str]], files: Mapping[str, str]) -> dict[str, str]:
    """Find the files, by module, that decide what names of modules stand for.

    Parameters
    ----------
    names : iterable of (module, name)
    files : mapping
        Files of the modules that use them. An installed package that has none of these counts where a name leads into
        it; what it is made from in turn is not looked for.
    """
    found: dict[str, str] = {}
    ours = {module.partition(".")[0] for module in files}
    met: set[tuple[str, str]] = set()
    ends = list(names)
    while ends:
        end = ends.pop()
        if end in met:
            continue
        met.add(end)
        file = files.get(end[0]) or file_of(end[0])
        if file is not None:
            found[end[0]] = file
            ends += _behind(*end, file, ours)
    return found


def _behind(module: str, name: str, file: str, ours: set[str]) -> Iterator[tuple[str, str]]:
    installed = {"site-packages", "dist-packages"} & set(Path(file).parts)
    if file.endswith(".py") and (not installed or module.partition(".")[0] in ours):
        yield from text_of(module, file).behind(name)


def file_of(module: str) -> str | None:
    """File of a module; none for one of Python's or the compiler's, one without a file, or one that is not there."""
    if is_library(module):
        return None
    if module in sys.modules:
        return getattr(sys.modules[module], "__file__", None)
    try:
        spec = importlib.util.find_spec(module)
    except (ImportError, ValueError):  # what should be its package is none
        return None
    return spec.origin if spec is not None and spec.has_location else None
