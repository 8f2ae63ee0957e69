"""Markdown in which texts of others are texts: nothing in them is markup, calls somebody, or leads anywhere.

What GitHub and GitLab read besides CommonMark is broken by a zero-width space: mentions, references to issues, merge
requests, labels and milestones, emoji by their names, addresses, mathematics.
"""

import re
from collections.abc import Iterable, Sequence

from pvlvrt_compliance.texts import printable

_BREAK = "\u200b"

_MARKUP = re.compile(r"[\\`*_\[\]|~$]")
_CALLS = re.compile(r"([@#!~$%^&])(?=[\w\"'])|(:)(?=[\w+-]+:)|(:)(?=//)|(www)(?=\.)|\b(GH-)(?=\d)", re.IGNORECASE)
# What would begin a heading, an item of a list or a line across the page, where a text begins a line.
_BEGINS = re.compile(r"^(?:(\d+)(?=[.)](?:\s|$))|(?=[-+](?:\s|$))|(?=#+(?:\s|$))|(?=[-=]+$))")
_ENTITIES = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;"})
_WHITE = 8  # times as long a text, white space in it included, is looked at as is shown


def plain(text: str, longest: int | None = None) -> str:
    """A text of anybody's on one line, to stand within a paragraph or a cell; cut behind so many characters."""
    begin = text if longest is None else text[: _WHITE * longest]
    line = " ".join(printable(begin, None).split())
    if longest is not None and len(line) > longest:
        line = f"{line[: longest - 1].rstrip()}…"
    escaped = _MARKUP.sub(r"\\\g<0>", _CALLS.sub(rf"\g<0>{_BREAK}", line).translate(_ENTITIES))
    return _BEGINS.sub(r"\1\\", escaped)


def code(text: str) -> str:
    """The same as code, in HTML: it holds any number of backticks, and a bar in a cell."""
    return f"<code>{plain(text)}</code>"


def table(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    """Lines of a table; cells are Markdown already."""
    return [_row(headings), _row(["---"] * len(headings)), *map(_row, rows)]


def folded(summary: str, lines: Iterable[str]) -> list[str]:
    """Lines that are shown when somebody asks for them, under a heading, which is Markdown already."""
    return ["<details>", f"<summary>{summary}</summary>", "", *lines, "", "</details>"]


def size(lines: Iterable[str]) -> int:
    """Bytes of lines with their ends."""
    return sum(len(line.encode()) + 1 for line in lines)


def _row(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cell or ' ' for cell in cells)} |"
