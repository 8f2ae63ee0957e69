"""The folder of stored records: bounded in size, shared by runs at the same time, safe against kills."""

import os
import time
import warnings
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from pvlvrt_compliance.errors import StoredRecordWarning
from pvlvrt_compliance.study.reuse.record_file import (
    UNFINISHED,
    DamagedError,
    Kept,
    read_record,
    size_of,
    write_record,
)

ENDING = ".record"
"""How the name of a stored record ends, after its key."""

_ABANDONED_AFTER_NS = 3600 * 10**9  # no file is written for an hour: its run was killed


class _Stored(NamedTuple):
    used_ns: int
    size: int
    place: str


class RecordStore:
    """Records by their keys. What goes wrong with one of them costs time and changes no result.

    Where the folder is full, what was used longest ago goes; but nothing that was used since this run has begun: a run
    that is larger than the bound would else replace what it is about to need, and find nothing the next time.

    Parameters
    ----------
    folder : Path
        Made when something is kept.
    limit : int
        Bytes that all records may take.
    begun_ns : int, optional
        When the run has begun (ns since 1970), of which this may be one process; by default now.
    """

    def __init__(self, folder: Path, limit: int, begun_ns: int | None = None) -> None:
        self.folder = folder
        self._limit = limit
        self._begun_ns = time.time_ns() if begun_ns is None else begun_ns
        self._clear_abandoned()

    def read(self, key: str) -> Kept | None:
        """The record of a key; None where there is none. A damaged one is thrown away, which is said."""
        file = self._file_of(key)
        try:
            found = read_record(file, key)
            os.utime(file)
        except FileNotFoundError:
            return None
        except DamagedError as error:
            _throw_away(file)
            _say("damaged", f"{file}: damaged ({error}): thrown away and simulated anew")
            return None
        except OSError as error:
            _say("unreadable", f"{file}: cannot be read ({error.strerror or error}): simulated anew")
            return None
        return found

    def write(self, key: str, kept: Kept) -> None:
        """Keep a record, if there is room; that there is none is said."""
        file = self._file_of(key)
        if not self._make_room(size_of(kept)):
            _say("full", f"{self.folder} is full; further records are not kept; --reuse-size gives them more room")
            return
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            write_record(file, key, kept)
        except OSError as error:
            _say("not kept", f"records are not kept: {self.folder}: {error.strerror or error}")
            return
        if not self._make_room(0):  # another run has taken the room meanwhile
            _throw_away(file)

    def _file_of(self, key: str) -> Path:
        return self.folder / f"{key}{ENDING}"

    def _make_room(self, size: int) -> bool:
        """Remove what was used longest ago, until so many bytes are free; whether they are."""
        stored = sorted(self._stored())
        excess = sum(each.size for each in stored) + size - self._limit
        old = [each for each in stored if each.used_ns < self._begun_ns]
        if excess > sum(each.size for each in old):
            return False
        for each in old:
            if excess <= 0:
                break
            _throw_away(Path(each.place))
            excess -= each.size
        return True

    def _stored(self) -> list[_Stored]:
        found = []
        with suppress(OSError), os.scandir(self.folder) as entries:
            for entry in entries:
                if entry.name.endswith(ENDING):
                    with suppress(OSError):  # another run has removed it
                        state = entry.stat()
                        found.append(_Stored(state.st_mtime_ns, state.st_size, entry.path))
        return found

    def _clear_abandoned(self) -> None:
        for file in self.folder.glob(f"*{UNFINISHED}"):
            with suppress(OSError):
                if file.stat().st_mtime_ns < self._begun_ns - _ABANDONED_AFTER_NS:
                    file.unlink()


def _throw_away(file: Path) -> None:
    with suppress(OSError):
        file.unlink()


_said: set[str] = set()


def _say(kind: str, text: str) -> None:
    """Warn, once a process for each kind: where one file is bad others often are."""
    if kind not in _said:
        _said.add(kind)
        warnings.warn(text, StoredRecordWarning, stacklevel=2)
