"""Where profiles are looked for by name: a folder of the user's, those that ship, other packages."""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from pvlvrt_compliance.data.announced import announced
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.resources import resource_folder

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

VARIABLE = "PVLVRT_PROFILES"
ENTRY_POINT_GROUP = "pvlvrt_compliance.profiles"
SUFFIX = ".toml"
SHIPPED = "shipped"

_SUFFIXES_OF_PATHS = (SUFFIX, ".json", ".yaml", ".yml")


class Known(NamedTuple):
    """A profile that a name stands for."""

    path: Path
    origin: str  # ``shipped``, the folder in $PVLVRT_PROFILES, or the package


def is_path(text: str) -> bool:
    """Whether a text names a file rather than a profile: by its ending, or because it has a separator."""
    return has_suffix(text) or "/" in text or "\\" in text


def has_suffix(text: str) -> bool:
    """Whether a path ends as one of a profile may, though written in another language."""
    return text.lower().endswith(_SUFFIXES_OF_PATHS)


def known_profiles() -> dict[str, Known]:
    """All profiles that can be named, sorted by name.

    Looked for in the folders of ``$PVLVRT_PROFILES``, among those that ship with this package, and in the folders that
    packages announce under the entry-point group ``pvlvrt_compliance.profiles``. Of a name that occurs more than once,
    the first counts.

    Raises
    ------
    UsageError
        When ``$PVLVRT_PROFILES`` names a folder that does not exist, or an entry point cannot be used.
    """
    found: dict[str, Known] = {}
    for origin, folder in _folders():
        for file in folder.glob(f"*{SUFFIX}"):
            found.setdefault(file.stem, Known(file, origin))
    return dict(sorted(found.items()))


def find_profile(name: str) -> Path | None:
    """File of a profile by its name, None where there is none; packages are only asked when nothing else has it.

    Raises
    ------
    UsageError
        As `known_profiles`.
    """
    for _, folder in _folders():
        file = folder / f"{name}{SUFFIX}"
        if file.is_file():
            return file
    return None


def origin_of(path: Path) -> str:
    """A file as a reader knows it: shipped ones by folder and name, others as written."""
    shipped = path.parent == resource_folder("profiles")
    return f"profiles/{path.name}" if shipped else str(path)


def _folders() -> Iterator[tuple[str, Path]]:
    yield from _folders_of_the_user()
    yield SHIPPED, resource_folder("profiles")
    for entry in announced(ENTRY_POINT_GROUP):
        origin = f"package {entry.dist.name}" if entry.dist else f"entry point {entry.name}"
        yield origin, _folder_of(entry)


def _folders_of_the_user() -> Iterator[tuple[str, Path]]:
    for text in filter(None, os.environ.get(VARIABLE, "").split(os.pathsep)):
        folder = Path(text)
        if not folder.is_dir():
            raise UsageError(f"${VARIABLE}: there is no folder {text!r}")
        yield text, folder


def _folder_of(entry: "EntryPoint") -> Path:
    """Folder that an entry point announces: that of its package or module, or what its function returns."""
    try:
        beside: Any = entry.load()
        if callable(beside):
            folder = Path(beside())
        elif beside.__file__ is not None:
            folder = Path(beside.__file__).parent
        else:
            folder = Path(next(iter(beside.__path__)))  # a folder without __init__.py
    except Exception as error:  # whatever another package raises
        raise UsageError(f"profiles of entry point {entry.name!r} ({entry.value}): {error}") from None
    if not folder.is_dir():
        raise UsageError(f"profiles of entry point {entry.name!r} ({entry.value}): there is no folder {str(folder)!r}")
    return folder
