"""Files that others wrote or name: opened so that nothing waits, and read no further than is allowed."""

import codecs
import os
import stat
from pathlib import Path

_MARKS = (
    (codecs.BOM_UTF32_LE, "UTF-32"),  # begins with the mark of UTF-16
    (codecs.BOM_UTF32_BE, "UTF-32"),
    (codecs.BOM_UTF16_LE, "UTF-16"),
    (codecs.BOM_UTF16_BE, "UTF-16"),
)
_BY_ZEROS = {2: "UTF-16", 3: "UTF-32"}  # among the first four bytes of ASCII text without a mark

_KINDS = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)

# What a system does not have is nothing: Windows knows neither pipes in folders nor terminals that are files.
_FLAGS = os.O_RDONLY | sum(getattr(os, name, 0) for name in ("O_NONBLOCK", "O_NOCTTY", "O_CLOEXEC", "O_BINARY"))
_NO_LINK = getattr(os, "O_NOFOLLOW", 0)


class NotOrdinaryError(Exception):
    """Why a file is not read; nothing of what is in it."""


class TooLargeError(NotOrdinaryError):
    """It has more bytes than may be read."""


def kind_of(mode: int) -> str | None:
    """What a file is by its mode, in words; None of an ordinary file."""
    if stat.S_ISREG(mode):
        return None
    return next((words for is_kind, words in _KINDS if is_kind(mode)), "not an ordinary file")


def mode_of(path: Path) -> int:
    """The mode of what a path leads to; 0 where there is nothing, or nothing that can be looked at.

    `Path.exists` and its like raise where a name is too long, or lies in a folder that cannot be entered.
    """
    try:
        return path.stat().st_mode
    except (OSError, ValueError):
        return 0


def content_of(path: Path, most_bytes: int, within: Path | None = None) -> bytes:
    """The bytes of an ordinary file.

    Nothing else is opened, since a pipe may be waited for without end and a device may act on being opened; what was
    opened is asked again what it is, as another may have taken its place.

    Parameters
    ----------
    path : Path
    most_bytes : int
        How many it may have; of a larger one no more is read.
    within : Path, optional
        Folder that it must lie in or below, links resolved.

    Raises
    ------
    TooLargeError
        When it has more.
    NotOrdinaryError
        When it is not there, no ordinary file, not readable, or outside of the folder.
    """
    try:
        file = path if within is None else _resolved(path, within)
        _refuse_kind(file.stat().st_mode)
        descriptor = os.open(file, _FLAGS | (0 if within is None else _NO_LINK))
        with os.fdopen(descriptor, "rb") as opened:
            status = os.fstat(descriptor)
            _refuse_kind(status.st_mode)
            if status.st_size > most_bytes:
                raise TooLargeError
            content = opened.read(most_bytes + 1)
    except OSError as error:
        raise NotOrdinaryError(f"cannot be read: {error.strerror or error}") from None
    except (ValueError, RuntimeError) as error:  # a path that no file can have; links that lead round
        raise NotOrdinaryError(f"cannot be read: {error}") from None
    if len(content) > most_bytes:
        raise TooLargeError
    return content


def is_within(path: Path, folder: Path) -> bool:
    """Whether a path leads into a folder or below it, links resolved."""
    try:
        return path.resolve().is_relative_to(folder.resolve())
    except (OSError, ValueError, RuntimeError):
        return False


def real(path: Path) -> Path:
    """A path with its links resolved, as far as they lead anywhere: `Path.resolve` raises where they lead round."""
    return Path(os.path.realpath(path))


def is_there(file: Path) -> bool:
    """Whether this is a file, as far as that can be seen: no text is too long to be asked for as a name."""
    try:
        return file.is_file()
    except OSError:
        return False


def other_encoding(content: bytes) -> str | None:
    """The encoding of a text that is not UTF-8, by its mark or by its zeros; None where neither tells one."""
    marked = next((name for mark, name in _MARKS if content.startswith(mark)), None)
    return marked or _BY_ZEROS.get(content[:4].count(0))


def _resolved(path: Path, within: Path) -> Path:
    file = path.resolve()
    if not file.is_relative_to(within.resolve()):
        raise NotOrdinaryError("leads out of the folder that it may lie in")
    return file


def _refuse_kind(mode: int) -> None:
    kind = kind_of(mode)
    if kind is not None:
        raise NotOrdinaryError(f"cannot be read: it is {kind}, and must be an ordinary file")
