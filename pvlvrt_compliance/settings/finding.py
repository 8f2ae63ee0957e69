"""Which file of settings holds: the nearest upwards, within what is the user's own."""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from pvlvrt_compliance.data.positions import Location
from pvlvrt_compliance.data.reader import Kind, Source
from pvlvrt_compliance.data.repository import begins_repository
from pvlvrt_compliance.data.syntax import Table
from pvlvrt_compliance.errors import UsageError, listed
from pvlvrt_compliance.ordinary_file import NotOrdinaryError, content_of
from pvlvrt_compliance.settings import FILE, PROJECT_FILE
from pvlvrt_compliance.trust import distrust

TABLE = ("tool", "pvlvrt")
"""Keys of the table in a `PROJECT_FILE`."""

_KIND = Kind("a settings file", "settings files", lambda origin, problems: UsageError(listed(origin, problems)))


class Taken(NamedTuple):
    """A file of settings."""

    source: Source
    place: Location  # of the table of settings in it
    folder: Path  # that its paths count from, from the working directory

    @property
    def table(self) -> Table:
        """The settings in it."""
        found: Table = self.source.table
        for key in self.place:
            found = found[str(key)]
        return found


class Found(NamedTuple):
    """What a search for a file of settings has come to."""

    file: Taken | None
    why_not: str = ""  # in words, where there is none
    refused: str = ""  # why a file that is there is not used, and how to go on; nothing is run then


def find_file(start: Path) -> Found:
    """The nearest file of settings, from a folder upwards.

    Of each folder `FILE` counts before a `PROJECT_FILE`, and that only with the table. The search ends with the
    repository's root (a folder with ``.git``) and with the home folder. A file that somebody else may have written is
    not used, and none beyond it: it may name a controller, that is, code. Nor is another controller judged in its
    place: what is refused ends a run (`Effective.to_run_by`).

    Parameters
    ----------
    start : Path
        Absolute.

    Raises
    ------
    UsageError
        When the nearest file cannot be read or is not TOML, with its line and key.
    """
    folders = list(_folders(start))
    for folder, _ in folders:
        if found := _in_folder(folder):
            return found
    folder, end = folders[-1]
    return Found(None, f"no {FILE}, and no {PROJECT_FILE} with [{'.'.join(TABLE)}], from here up to {folder}, {end}")


def _in_folder(folder: Path) -> Found | None:
    """What the files of one folder come to; None where none of them is one."""
    for path in (folder / FILE, folder / PROJECT_FILE):
        own = path.name == FILE
        if not os.path.lexists(path):
            continue
        # An own file is not even opened; whether a project's file has the table only its content says.
        reason, shown = distrust(path), _from_here(path)
        taken = read_file(shown) if not (own and reason) and (own or os.access(path, os.R_OK)) else None
        if reason and (own or taken):
            said = refusal(shown, reason)
            return Found(None, said, said)
        if taken is not None:
            return Found(taken)
    return None


def refusal(path: Path, reason: str) -> str:
    """Why a file is not used, and by which options a run goes on."""
    on = f"--config {path} uses it all the same, --isolated runs without it"
    return f"{path} is not used: {reason}, and it may name code to run; {on}"


def read_file(path: Path) -> Taken | None:
    """A file of settings; None of a `PROJECT_FILE` without the table.

    Raises
    ------
    UsageError
        When it cannot be read or is not TOML, with its line and key.
    """
    if path.name != PROJECT_FILE:
        return Taken(Source(path, _KIND), (), path.parent)
    if not _speaks_of_us(path):
        return None
    source = Source(path, _KIND)
    tool = source.table.get(TABLE[0])
    table = tool.get(TABLE[1]) if isinstance(tool, dict) else None
    if table is not None and not isinstance(table, dict):
        raise source.refusal((TABLE, "must be a table"))
    return None if table is None else Taken(source, TABLE, path.parent)


_LARGEST_BYTES = 64 << 20  # of a project's file that says nothing of us (chosen): more than anybody writes


def _speaks_of_us(path: Path) -> bool:
    """Whether it can have the table; what else is wrong with a project's file is not for us to say."""
    try:
        return TABLE[1].encode() in content_of(path, _LARGEST_BYTES)
    except NotOrdinaryError:
        return True  # whoever reads it says why it cannot be read


def _from_here(path: Path) -> Path:
    try:
        return Path(os.path.relpath(path))
    except ValueError:  # on another drive
        return path


def _folders(start: Path) -> Iterator[tuple[Path, str]]:
    """Folders to look in, with what would end the search there, in words."""
    try:
        home = Path.home().resolve()
    except (RuntimeError, OSError):
        home = None
    for folder in (start, *start.parents):
        is_root = begins_repository(folder)
        if is_root or folder == home:
            yield folder, "the root of the repository" if is_root else "the home folder"
            return
        yield folder, "the root of the file system"
