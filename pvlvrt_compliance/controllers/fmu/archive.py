"""The archive that an FMU is: what may be in it, seen before anything is read or unpacked."""

import stat
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath

from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.limits import FILES, FILES_MB, MB, TABLE, Limits, allowing_more, limits_here

_SHOWN = 80  # characters of a name


def check_archive(file: Path) -> None:
    """Refuse an archive that unpacks to too much, or to elsewhere.

    Sizes are those that its directory states: of a file that holds more than is stated nothing more is ever unpacked.

    Raises
    ------
    DoorError
        With the reason; also when it is no archive.
    """
    with opened(file) as archive:
        entries = archive.infolist()
    limits = limits_here()
    if len(entries) > limits.files:
        raise DoorError(f"it holds {len(entries)} files, more than {_bound(FILES, limits)}")
    size = sum(entry.file_size for entry in entries)
    if size > limits.files_mb * MB:
        raise DoorError(f"it unpacks to {size / MB:.0f} MB, more than {_bound(FILES_MB, limits)}")
    for entry in entries:
        if why := _why_not(entry):
            raise DoorError(f"it holds {entry.filename[:_SHOWN]!r}, {why}")


@contextmanager
def opened(file: Path) -> Iterator[zipfile.ZipFile]:
    """An archive, to be read from.

    Raises
    ------
    DoorError
        When it is none, or what is read of it is damaged.
    """
    try:
        with zipfile.ZipFile(file) as archive:
            yield archive
    except (zipfile.BadZipFile, zlib.error, EOFError, OSError, RuntimeError, ValueError) as error:
        raise DoorError(f"{file.name} is not an FMU, or is damaged: {error}") from None


def unpack(file: Path, folder: Path) -> None:
    """Unpack a checked archive.

    Raises
    ------
    DoorError
        When it is damaged, or the folder cannot be written.
    """
    with opened(file) as archive:
        archive.extractall(folder)


def _bound(name: str, limits: Limits) -> str:
    parameter, unit = TABLE[name].parameter, " MB" if name == FILES_MB else ""
    return f"{getattr(limits, name):g}{unit} ({parameter}){allowing_more(parameter)}"


def _why_not(entry: zipfile.ZipInfo) -> str:
    """Why an entry has no place in an FMU; empty where it has one."""
    path = PurePosixPath(entry.filename.replace("\\", "/"))
    if path.is_absolute() or ".." in path.parts or ":" in (path.parts or ("",))[0]:
        return "which lies outside of its folder"
    kind = stat.S_IFMT(entry.external_attr >> 16)
    if kind not in (0, stat.S_IFREG, stat.S_IFDIR):
        return "which is a link, or no ordinary file"
    return "which is encrypted" if entry.flag_bits & 1 else ""
