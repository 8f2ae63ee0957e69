"""What other packages announce under a group of entry points."""

import os
import sys
from importlib.machinery import PathFinder
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint


def announced(group: str) -> "list[EntryPoint]":
    """Entry points of a group, by name.

    `importlib.metadata` takes longer, to be imported and to read what all packages say of themselves, than everything
    else that a list of profiles does: it is asked only where one of them has the group written down.
    """
    if not _may_be_announced(group.encode()):
        return []
    from importlib.metadata import entry_points

    return sorted(entry_points(group=group), key=lambda entry: entry.name)


def _may_be_announced(group: bytes) -> bool:
    """Whether any package that can be found as Python finds them names the group, or is found in another way."""
    others = (finder for finder in sys.meta_path if finder is not PathFinder)
    if any(hasattr(finder, "find_distributions") for finder in others):
        return True
    return any(_names(place or os.curdir, group) for place in sys.path)


def _names(place: str, group: bytes) -> bool:
    """Whether a package in a place of the search path has the group in its metadata, as far as that can be seen."""
    try:
        with os.scandir(place) as found:
            metadata = [Path(entry.path) for entry in found if _is_metadata(entry.name.lower())]
    except FileNotFoundError:
        return False
    except OSError:  # an archive, or whatever else Python may know to read
        return True
    return any(group in _content(folder / "entry_points.txt") for folder in metadata)


def _is_metadata(name: str) -> bool:
    return name.endswith((".dist-info", ".egg-info")) or name == "egg-info"


def _content(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError:  # a package without entry points
        return b""
