"""Putting the files of a run in the place of those of the one before, so that a kill at any step leaves no mix.

What moves stands in a journal before the first file does, and every step is one renaming. Files that are replaced are
kept aside until all is in place: what was begun can be finished, or taken back, by whoever finds the journal.
"""

import json
import os
import shutil
from collections.abc import Iterable, Sequence
from contextlib import suppress
from pathlib import Path, PurePosixPath
from typing import NamedTuple

_JOURNAL, _ASIDE = "journal.json", "aside"


class Placing(NamedTuple):
    """Files on their way from a staging folder, which stands in the output folder, to their places.

    Names are relative, with `/`. They move in the order given, and back in the reverse.
    """

    staging: Path
    into: str  # folder in the output folder, or nothing for that itself
    withdrawn: tuple[str, ...]  # of the output folder, put aside first
    placed: tuple[str, ...]  # of the staging folder, without `into`

    def begin(self) -> None:
        """Write the journal; from here on, `finish` or `take_back` is due.

        Raises
        ------
        OSError
            When it cannot be written; nothing has moved then.
        """
        unfinished = self.staging / f"{_JOURNAL}.part"
        data = {"into": self.into, "withdrawn": self.withdrawn, "placed": self.placed}
        unfinished.write_text(json.dumps(data), "ascii")
        unfinished.replace(self.staging / _JOURNAL)

    @property
    def is_open(self) -> bool:
        """Whether it has begun, and has come to no end."""
        return (self.staging / _JOURNAL).exists()

    def finish(self) -> None:
        """Put every file in its place, those that were there before aside.

        Raises
        ------
        OSError
            When a file cannot be moved; some have moved then.
        """
        for name in self.withdrawn:
            if self._file(name).exists() and not self._aside(name).exists():
                _move(self._file(name), self._aside(name))
        for name in self.placed:
            if (self.staging / name).exists():
                _move(self.staging / name, self._place(name))
        (self.staging / _JOURNAL).unlink()

    def take_back(self) -> None:
        """Put everything back that has moved.

        Raises
        ------
        OSError
            When a file cannot be moved back; the journal is still there then.
        """
        for name in reversed(self.placed):
            if self._place(name).exists() and not (self.staging / name).exists():
                _move(self._place(name), self.staging / name)
        for name in reversed(self.withdrawn):
            if self._aside(name).exists():
                _move(self._aside(name), self._file(name))
        (self.staging / _JOURNAL).unlink()

    def _file(self, name: str) -> Path:
        return self.staging.parent / name

    def _aside(self, name: str) -> Path:
        return self.staging / _ASIDE / name

    def _place(self, name: str) -> Path:
        return self.staging.parent / self.into / name


def begun_in(staging: Path) -> Placing | None:
    """What has been begun there; None when nothing has, or the journal is none of ours."""
    try:
        found = json.loads((staging / _JOURNAL).read_bytes())
        into, withdrawn, placed = (found[key] for key in ("into", "withdrawn", "placed"))
    except (OSError, ValueError, RecursionError, KeyError, TypeError):
        return None
    if not (isinstance(into, str) and _are_names(withdrawn) and _are_names(placed) and _is_inside(into)):
        return None
    return Placing(staging, into, tuple(withdrawn), tuple(placed))


def remove(folder: Path) -> None:
    """Remove a staging folder; what cannot be removed stays for the next run."""
    shutil.rmtree(folder, ignore_errors=True)


def remove_empty(folders: Iterable[Path]) -> None:
    """Remove folders as far as they are empty."""
    for folder in folders:
        with suppress(OSError):
            folder.rmdir()


def _are_names(found: object) -> bool:
    return isinstance(found, list) and all(isinstance(name, str) and name and _is_inside(name) for name in found)


def _is_inside(name: str) -> bool:
    """Whether a name cannot lead out of the folder that it is taken from: a journal may come from anywhere."""
    path = PurePosixPath(name)
    return not (path.is_absolute() or ".." in path.parts or "\\" in name or ":" in name or "\0" in name)


def _move(source: Path, target: Path) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    try:
        os.replace(source, target)  # noqa: PTH105 - one name for the one step that must not be torn
    except OSError as error:
        error.filename, error.filename2 = str(target), None
        raise


def in_order(names: Iterable[str], last: Sequence[str]) -> tuple[str, ...]:
    """Names with these at the end, in this order; the others sorted."""
    present = set(names)
    return (*sorted(present - set(last)), *(name for name in last if name in present))
