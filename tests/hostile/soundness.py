"""Whether what was written is what it should be: finite JSON, XML, HTML with every element closed, clean text."""

import json
import re
from collections.abc import Callable, Collection, Iterator
from html.parser import HTMLParser
from pathlib import Path

from lxml import etree

_VOID = {"area", "base", "br", "col", "embed", "hr", "img", "input", "link", "meta", "source", "track", "wbr"}
_CLOSED_BY_OTHERS = {"body", "colgroup", "dd", "dt", "html", "li", "option", "p", "tbody", "td", "tfoot", "th"}
_CLOSED_BY_OTHERS |= {"thead", "tr"}
_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f]")
_FORGED = ("alert(1)", "onerror")


class _Page(HTMLParser):
    """What is wrong with a page."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.wrong: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Opened."""
        if tag not in _VOID:
            self.open.append(tag)
        self.wrong += [f"<{tag}> has {name}" for name, _ in attrs if name in _FORGED]

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Opened and closed, as in SVG."""

    def handle_endtag(self, tag: str) -> None:
        """Closed: the one that was opened last, and in it those that need no end of their own."""
        while tag in self.open and self.open[-1] != tag and self.open[-1] in _CLOSED_BY_OTHERS:
            self.open.pop()
        if not self.open or self.open.pop() != tag:
            self.wrong.append(f"</{tag}> closes nothing, line {self.getpos()[0]}")

    def handle_data(self, data: str) -> None:
        """Text."""
        if self.open[-1:] == ["script"] and data.startswith("alert(1)"):
            self.wrong.append("a script of others")


def _json(content: bytes) -> Iterator[str]:
    def refuse(constant: str) -> None:
        raise ValueError(f"holds {constant}")

    try:
        json.loads(content, parse_constant=refuse)
    except ValueError as error:
        yield f"is no JSON: {error}"


def _xml(content: bytes) -> Iterator[str]:
    try:
        etree.fromstring(content, etree.XMLParser(huge_tree=True, resolve_entities=False))
    except etree.XMLSyntaxError as error:
        yield f"is no XML: {error}"


def _html(content: bytes) -> Iterator[str]:
    page = _Page()
    page.feed(content.decode("utf-8"))
    yield from page.wrong[:3]
    if still := [tag for tag in page.open if tag not in _CLOSED_BY_OTHERS]:
        yield f"{still[-3:]} are not closed"
    yield from _text(content)


def _text(content: bytes) -> Iterator[str]:
    try:
        if found := _CONTROL.search(content.decode("utf-8")):
            yield f"has the control character {found.group()!r}"
    except UnicodeDecodeError as error:
        yield f"is no UTF-8: {error}"


_BY_SUFFIX: dict[str, Callable[[bytes], Iterator[str]]] = {
    ".json": _json,
    ".xml": _xml,
    ".svg": _xml,
    ".html": _html,
    ".md": _text,
    ".txt": _text,
}


def unsound(folder: Path, others: Collection[Path] = ()) -> Iterator[str]:
    """What is wrong with the files in a folder but those of others."""
    for file in sorted(folder.rglob("*")) if folder.is_dir() else [folder]:
        if file.suffix in _BY_SUFFIX and file.is_file() and not file.is_symlink() and file not in others:
            yield from (f"{file.name} {said}" for said in _BY_SUFFIX[file.suffix](file.read_bytes()))


def finite(content: bytes) -> bool:
    """Whether something is JSON without a number that is none."""
    return not list(_json(content))


def control_in(text: str) -> str | None:
    """The first control character but the end of a line and a tabulator."""
    found = _CONTROL.search(text)
    return found.group() if found else None
