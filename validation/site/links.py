"""What the pages of a built site ask a browser for, and where their links lead."""

import re
from collections.abc import Iterator
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from typing import NamedTuple
from urllib.parse import unquote, urlsplit

_NOT_FOUND = "404.html"  # shown at any address: its links begin at the top of a server
_FETCHED = {"script": "src", "img": "src", "source": "src", "iframe": "src", "video": "src", "audio": "src"}
_FETCHED_BY_LINK = {"stylesheet", "icon", "preload", "preconnect", "dns-prefetch", "manifest", "modulepreload"}
_IN_STYLE = re.compile(r"""(?:url\(\s*["']?|@import\s+["'])([^"')\s]+)""")


class _Page(NamedTuple):
    """What stands in a page."""

    fetched: tuple[str, ...]
    links: tuple[str, ...]
    anchors: frozenset[str]


class _Reader(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.fetched: list[str] = []
        self.links: list[str] = []
        self.anchors: set[str] = set()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        self.anchors |= {given[name] for name in ("id", "name") if name in given}
        self.fetched += [given[name] for name in (_FETCHED.get(tag, ""),) if name in given]
        if tag == "link" and _FETCHED_BY_LINK & set(given.get("rel", "").split()):
            self.fetched.append(given.get("href", ""))
        if tag == "a" and "href" in given:
            self.links.append(given["href"])


@cache
def _read(file: Path) -> _Page:
    reader = _Reader()
    reader.feed(file.read_text("utf-8"))
    return _Page(tuple(reader.fetched), tuple(reader.links), frozenset(reader.anchors))


def problems(site: Path, start: str) -> list[str]:
    """Links that lead nowhere, what is fetched from other hosts, and pages that no way leads to.

    Parameters
    ----------
    site : Path
        Folder of the built pages.
    start : str
        The page from which all others are to be reached.
    """
    pages = _pages(site)
    wrong = [line for page in pages for line in _of_page(site, page)]
    wrong += [f"{style.relative_to(site)}: fetches {place}" for style in site.rglob("*.css") for place in _asked(style)]
    unreached = set(pages) - _reached(site / start)
    return wrong + [f"{page.relative_to(site)}: no page leads there" for page in sorted(unreached)]


def count(site: Path) -> int:
    """How many pages there are."""
    return len(_pages(site))


def _pages(site: Path) -> list[Path]:
    return sorted(page for page in site.rglob("*.html") if page.name != _NOT_FOUND)


def _of_page(site: Path, page: Path) -> Iterator[str]:
    name, read = page.relative_to(site), _read(page)
    yield from (f"{name}: fetches {place}" for place in read.fetched if _is_elsewhere(place))
    for place in (*read.fetched, *read.links):
        if not _has_scheme(place) and not _leads(page, place):
            yield f"{name}: nothing at {place}"


def _leads(page: Path, place: str) -> bool:
    file, anchor = _target(page, place)
    if not file.is_file():
        return False
    return not anchor or file.suffix != ".html" or anchor in _read(file).anchors


def _target(page: Path, place: str) -> tuple[Path, str]:
    parts = urlsplit(place)
    file = (page.parent / unquote(parts.path)).resolve() if parts.path else page
    return (file / "index.html" if file.is_dir() else file), unquote(parts.fragment)


def _reached(start: Path) -> set[Path]:
    found, ahead = set[Path](), [start]
    while ahead:
        page = ahead.pop()
        if page not in found and page.suffix == ".html" and page.is_file():
            found.add(page)
            ahead += [_target(page, place)[0] for place in _read(page).links if not _has_scheme(place)]
    return found


def _asked(style: Path) -> list[str]:
    return [place for place in _IN_STYLE.findall(style.read_text("utf-8")) if _is_elsewhere(place)]


def _has_scheme(place: str) -> bool:
    return bool(urlsplit(place).scheme) or place.startswith("//")


def _is_elsewhere(place: str) -> bool:
    return _has_scheme(place) and not place.startswith("data:")
