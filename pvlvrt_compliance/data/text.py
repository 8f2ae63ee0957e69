"""Text of a file that people write: of an ordinary file, not too large, in UTF-8."""

from pathlib import Path

from pvlvrt_compliance.ordinary_file import NotOrdinaryError, TooLargeError, content_of, other_encoding

LARGEST_FILE_MIB = 1
LARGEST_FILE_BYTES = LARGEST_FILE_MIB << 20


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
    try:
        content = content_of(path, LARGEST_FILE_BYTES)
    except TooLargeError:
        raise UnreadableError(f"larger than {LARGEST_FILE_MIB} MiB; {what} is a few kilobytes") from None
    except NotOrdinaryError as error:
        raise UnreadableError(str(error)) from None
    encoding = other_encoding(content)
    if encoding is not None:
        raise UnreadableError(f"not UTF-8 text: it is {encoding}; save it as UTF-8", 1)
    try:
        return content.decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise UnreadableError(f"not UTF-8 text: byte {error.start} cannot be decoded; save it as UTF-8", line) from None
