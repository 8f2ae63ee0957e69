"""Machine code kept from one process to the next, in a folder of its own or not at all."""

import hashlib
from functools import cached_property
from pathlib import Path
from types import FunctionType

from pvlvrt_compliance.compiled.checked_file import DamagedError, read_checked, write_checked
from pvlvrt_compliance.compiled.notes import discard, say_not_kept
from pvlvrt_compliance.compiled.sources import Sources


class Keeping:
    """Files of one function, one for each kind of its arguments, in a folder named after the key of its sources."""

    def __init__(self, function: FunctionType, sources: Sources, root: Path | None) -> None:
        self._module = function.__module__
        self._name = function.__qualname__.replace("<", "").replace(">", "")  # no part of a file's name everywhere
        self._root = root
        self.sources = sources

    @cached_property
    def folder(self) -> Path | None:
        """Where the code is kept; none where no folder is known."""
        return self._root / f"kernels-{self.sources.key}" / self._module if self._root is not None else None

    def file_for(self, which: str, suffix: str) -> Path | None:
        """File of the code that a text tells from all other code of this function."""
        name = f"{self._name}-{hashlib.sha256(which.encode()).hexdigest()[:16]}{suffix}"
        return self.folder / name if self.folder is not None else None

    def read(self, file: Path | None) -> bytes | None:
        """Content of a file; none if there is none, or it is damaged, which is said."""
        try:
            return read_checked(file, _purpose(file)) if file is not None else None
        except DamagedError as error:
            self.discard(file, error)
        except OSError:  # if it cannot be replaced either, that is said then
            pass
        return None

    def discard(self, file: Path | None, why: object) -> None:
        """Throw a file away whose content cannot be what was kept, and say so."""
        if file is not None:
            discard(file, why)

    def write(self, file: Path | None, content: bytes) -> None:
        """Keep what has just been made, if that is possible."""
        if file is None:
            say_not_kept("there is no home folder; NUMBA_CACHE_DIR names another")
            return
        try:
            write_checked(file, _purpose(file), content)
        except OSError as error:
            say_not_kept(f"{self._root}: {error.strerror or error}; NUMBA_CACHE_DIR names another folder")

    def flush(self, suffix: str) -> None:
        """Forget what is kept of this version."""
        for file in self.folder.glob(f"{self._name}-*{suffix}") if self.folder is not None else ():
            file.unlink(missing_ok=True)


def _purpose(file: Path) -> str:
    """What the head of a file confirms besides its content: a file in another's place is none."""
    return "/".join(file.parts[-3:])
