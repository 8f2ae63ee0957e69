"""Pieces of Markdown."""

from collections.abc import Iterable, Iterator, Sequence


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> Iterator[str]:
    """Lines of a table; nothing without rows."""
    lines = [f"| {' | '.join(map(cell, row))} |" for row in rows]
    if lines:
        yield f"| {' | '.join(heads)} |"
        yield f"|{'---|' * len(heads)}"
        yield from lines
        yield ""


def cell(text: str) -> str:
    """A text that stays in its cell."""
    return text.replace("|", r"\|").replace("\n", " ").replace("<", "&lt;") or " "


def code(text: str) -> str:
    """A name of the data."""
    return f"`{text}`" if text else ""


def page(lines: Iterable[str]) -> str:
    """The text of a page: one empty line where there are several, one newline at its end."""
    text = "\n".join(lines)
    while "\n\n\n" in text:
        text = text.replace("\n\n\n", "\n\n")
    return text.rstrip("\n") + "\n"
