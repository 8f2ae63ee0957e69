"""Names that are no text: the bytes of a file's name or an argument need not be UTF-8."""

import codecs
import io
from typing import Any

_HANDLER = "pvlvrt-names"


def write_any_name(stream: io.TextIOWrapper) -> None:
    """Have a stream write bytes that are no text as they are, and ``?`` for a character that its encoding lacks."""
    codecs.register_error(_HANDLER, _bytes_or_mark)
    stream.reconfigure(errors=_HANDLER)


def _bytes_or_mark(error: UnicodeError) -> tuple[str | bytes, int]:
    try:
        return codecs.lookup_error("surrogateescape")(error)
    except UnicodeError:
        return codecs.lookup_error("replace")(error)


def printable(text: str) -> str:
    r"""The same with every byte that is no text spelled out, as ``\xff``."""
    return text if text.isascii() else "".join(map(_spelled, text))


def all_printable(data: Any) -> Any:
    """Plain data with every text in it `printable`."""
    if isinstance(data, str):
        return printable(data)
    if isinstance(data, dict):
        return {printable(key): all_printable(value) for key, value in data.items()}
    if isinstance(data, list | tuple):
        return [all_printable(value) for value in data]
    return data


def shell_word(word: str) -> str:
    r"""A word as a shell reads it back; with bytes that are no text as ``$'\xff'``, which bash, zsh and ksh know."""
    import shlex

    if printable(word) == word:
        return shlex.quote(word)
    escaped = word.replace("\\", "\\\\").replace("'", "\\'").replace("\n", "\\n")
    return f"$'{printable(escaped)}'"


def _spelled(character: str) -> str:
    # Python has a surrogate, which no text holds, in the place of such a byte.
    code = ord(character)
    if 0xDC80 <= code <= 0xDCFF:
        return f"\\x{code - 0xDC00:02x}"
    return f"\\u{code:04x}" if 0xD800 <= code <= 0xDFFF else character
