"""The folder of a case: its files are put there, and what has become of them is looked at afterwards."""

import os
import shutil
from collections.abc import Collection, Iterator
from pathlib import Path

from tests.hostile.case import Case
from tests.hostile.damage import BYTES, FIFO, FOLDER, File


def put(case: Case, place: Path) -> None:
    """Make the folder anew, with the files of a case and nothing else."""
    clear(place)
    for name, file in case.files.items():
        path = place / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if file.kind == BYTES:
            path.write_bytes(file.content)
        elif file.kind == FOLDER:
            path.mkdir()
        elif file.kind == FIFO:
            os.mkfifo(path)
        else:
            path.symlink_to(path.name if file.target == "itself" else file.target)


def clear(place: Path) -> None:
    """An empty folder."""
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir(parents=True)


def changes(case: Case, place: Path, may_write: Collection[str]) -> Iterator[str]:
    """What is other than it was put there, but for what the case may write."""
    # Python keeps what it has compiled of a controller's file beside that, as of any other.
    writes = {"__pycache__"} | {Path(os.path.normpath(name)).as_posix() for name in may_write if "\x00" not in name}
    if "." in writes:
        return
    for name, file in case.files.items():
        if not _is_in(name, writes) and (said := _changed(place / name, file)):
            yield f"{name} {said}"
    holders = {parent.as_posix() for name in case.files for parent in Path(name).parents}
    for folder, folders, files in os.walk(place):
        for name in [*folders, *files]:
            inner = (Path(folder) / name).relative_to(place).as_posix()
            if inner not in case.files and inner not in holders and not _is_in(inner, writes):
                if not any(write.startswith(f"{inner}/") for write in writes):
                    yield f"{inner!r} was written"
                elif not (place / inner).is_dir():
                    yield f"{inner!r} was written in place of a folder"


def untouched(case: Case, place: Path) -> set[Path]:
    """Files of a case that are as they were put there."""
    return {place / name for name, file in case.files.items() if not _changed(place / name, file)}


def _is_in(name: str, writes: Collection[str]) -> bool:
    return any(name == write or name.startswith(f"{write}/") for write in writes)


def _changed(path: Path, file: File) -> str:
    if file.kind == BYTES:
        if path.is_symlink() or not path.is_file():
            return "is gone"
        return "" if path.read_bytes() == file.content else "was changed"
    kept = path.is_dir() if file.kind == FOLDER else path.is_fifo() if file.kind == FIFO else path.is_symlink()
    return "" if kept else "is gone"


def left_over(place: Path, case: Case) -> Iterator[str]:
    """Unfinished files that lie in a folder after all."""
    for folder, folders, files in os.walk(place):
        for name in [*folders, *files]:
            if name.startswith(".") and (Path(folder) / name).relative_to(place).as_posix() not in case.files:
                yield f"{name!r} is left"
