"""Text of a file that people write: of an ordinary file, not too large, in UTF-8."""

import codecs
import stat
from pathlib import Path

LARGEST_FILE_MIB = 1
LARGEST_FILE_BYTES = LARGEST_FILE_MIB << 20

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


class UnreadableError(Exception):
    """A file cannot be read as what it should be: why, and the line where that is known."""

    def __init__(self, why: str, line: int | None = None) -> None:
        super().__init__(why)
        self.line = line


def read_text(path: Path, what: str) -> str:
    r"""Text of a file, without a byte-order mark, lines ending in ``\n``.

    Parameters
    ----------
    path : Path
    what : str
        The kind of file, for the error of a large one: ``a profile``.

    Raises
    ------
    UnreadableError
        When it is not there or no ordinary file (nothing else is opened: a pipe could be waited for without end), is
        larger than ``LARGEST_FILE_BYTES`` (no more is read), or is not UTF-8.
    """
    content = _content(path)
    if len(content) > LARGEST_FILE_BYTES:
        raise UnreadableError(f"larger than {LARGEST_FILE_MIB} MiB; {what} is a few kilobytes")
    encoding = _other_encoding(content)
    if encoding is not None:
        raise UnreadableError(f"not UTF-8 text: it is {encoding}; save it as UTF-8", 1)
    try:
        return content.decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise UnreadableError(f"not UTF-8 text: byte {error.start} cannot be decoded; save it as UTF-8", line) from None


def kind_of(mode: int) -> str | None:
    """What a file is by its mode, in words; None of an ordinary file."""
    if stat.S_ISREG(mode):
        return None
    return next((words for is_kind, words in _KINDS if is_kind(mode)), "not an ordinary file")


def _content(path: Path) -> bytes:
    """The bytes of an ordinary file, at most one more than are allowed."""
    try:
        kind = kind_of(path.stat().st_mode)
        if kind is not None:
            raise UnreadableError(f"cannot be read: it is {kind}, and must be an ordinary file")
        with path.open("rb") as file:
            return file.read(LARGEST_FILE_BYTES + 1)
    except OSError as error:
        raise UnreadableError(f"cannot be read: {error.strerror or error}") from None
    except ValueError as error:  # a path that no file can have
        raise UnreadableError(f"cannot be read: {error}") from None


def _other_encoding(content: bytes) -> str | None:
    marked = next((name for mark, name in _MARKS if content.startswith(mark)), None)
    return marked or _BY_ZEROS.get(content[:4].count(0))
