"""Names that are no text: the bytes of a file's name or an argument need not be UTF-8."""

import re
from typing import Any

_NO_TEXT = re.compile("[\ud800-\udfff]")  # what Python has in the place of such a byte


def printable(text: str) -> str:
    r"""The same with every byte that is no text spelled out, as ``\xff``."""
    return _NO_TEXT.sub(_spelled, text)


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

    if not _NO_TEXT.search(word):
        return shlex.quote(word)
    escaped = word.replace("\\", "\\\\").replace("'", "\\'").replace("\n", "\\n")
    return f"$'{printable(escaped)}'"


def _spelled(found: re.Match[str]) -> str:
    code = ord(found[0])
    return f"\\x{code - 0xDC00:02x}" if 0xDC80 <= code <= 0xDCFF else f"\\u{code:04x}"
