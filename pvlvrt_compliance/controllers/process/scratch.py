"""Folders for the files of a job in the system's temporary folder, told from those of processes that are gone."""

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path

from pvlvrt_compliance.controllers.process.command import at_end
from pvlvrt_compliance.errors import OutputError
from pvlvrt_compliance.locks import Lock, is_mine, take_lock

_NAME, _LOCK = "pvlvrt-job-", ".lock"
_open: dict[Path, Lock] = {}


@contextmanager
def job_folder() -> Iterator[Path]:
    """A new folder, removed at the end. Beside it stands a lock that this process holds for as long as it lives.

    Raises
    ------
    OutputError
        When it cannot be made.
    """
    try:
        folder, lock = _made()
    except OSError as error:
        raise OutputError(f"{tempfile.gettempdir()} cannot be written: {error.strerror or error}") from None
    _remove_at_end()
    _open[folder] = lock
    try:
        yield folder
    finally:
        _remove(folder)


def clear_abandoned() -> None:
    """Remove folders of processes of this user that were killed; of none that lives, and nothing else."""
    for path in Path(tempfile.gettempdir()).glob(f"{_NAME}*{_LOCK}"):
        with suppress(OSError):
            folder = path.with_suffix("")
            if not is_mine(path) or (folder.exists() and not is_mine(folder)):
                continue
            if (lock := take_lock(path)) is None:
                continue
            if lock.is_certain:
                _remove_folder(folder)
                lock.release()
            else:
                lock.close()


def _made() -> tuple[Path, Lock]:
    # The lock comes first: what has none is not ours, and no folder is ever seen without.
    while True:
        path = Path(tempfile.gettempdir(), f"{_NAME}{os.urandom(6).hex()}{_LOCK}")
        if (lock := take_lock(path)) is not None:
            folder = path.with_suffix("")
            folder.mkdir(mode=0o700)
            return folder, lock


@cache
def _remove_at_end() -> None:
    at_end(_remove_all)


def _remove(folder: Path) -> None:
    lock = _open.pop(folder, None)
    _remove_folder(folder)
    if lock is not None:
        lock.release()


def _remove_folder(folder: Path) -> None:
    """Remove a folder, also where a controller has taken the right to that, or has put a link in its place."""
    shutil.rmtree(folder, ignore_errors=True)
    if folder.is_symlink():
        with suppress(OSError):
            folder.unlink()
    elif folder.exists():
        for path in _folders_from(folder):
            with suppress(OSError):
                path.chmod(0o700)
        shutil.rmtree(folder, ignore_errors=True)


def _folders_from(folder: Path) -> Iterator[Path]:
    """A folder and those in it, each before it is looked into."""
    yield folder
    for path, names, _ in os.walk(folder):
        yield from (Path(path, name) for name in names if not Path(path, name).is_symlink())


def _remove_all() -> None:
    for folder in list(_open):
        _remove(folder)
