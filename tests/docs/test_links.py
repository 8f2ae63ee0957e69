"""What `docs/` holds, and where the links of all pages lead."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
FRONT = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")]
PAGES = sorted(DOCS.rglob("*.md"))
SITE = ROOT / "mkdocs.yml"
PICTURES, DATA, STYLE = {".png", ".svg"}, {".csv"}, {DOCS / "site.css"}
WITH_CODE = ("pvlvrt_compliance", "validation", "tests", "benchmarks", "profiles", "reports", "examples")

_FENCED = re.compile(r"^( *)```.*?^\1```", re.MULTILINE | re.DOTALL)
_IN_LINE = re.compile(r"`[^`]*`")
_LINK = re.compile(r"\]\(([^)\s]+)\)")
_NAMED = re.compile(rf"`((?:docs|{'|'.join(WITH_CODE)})/[\w./-]*)`")
_IN_NAVIGATION = re.compile(r"([\w./-]+\.md)$", re.MULTILINE)
_PAGE_NAMED = re.compile(r"docs/[\w/-]+\.\w+")


class Link(NamedTuple):
    """Where a link leads."""

    file: Path
    anchor: str


def files_in_docs() -> list[Path]:
    """All files, but for what Python left behind where code used to be."""
    return [path for path in DOCS.rglob("*") if path.is_file() and "__pycache__" not in path.parts]


def _as_named(page: Path) -> str:
    return page.relative_to(DOCS).as_posix()


def text_of(page: Path) -> str:
    """Text of a page; of the changelog its newest section, as older ones name what there was."""
    text = page.read_text("utf-8")
    return text if page.name != "CHANGELOG.md" else "## ".join(text.split("\n## ")[:2])


def links(page: Path) -> Iterator[Link]:
    """Links to files of the checkout; one without a file is to the page itself."""
    for target in _LINK.findall(_IN_LINE.sub("", _FENCED.sub("", text_of(page)))):
        if "://" not in target and not target.startswith("mailto:"):
            file, _, anchor = target.partition("#")
            yield Link((page.parent / file).resolve() if file else page, anchor)


def anchors(page: Path) -> set[str]:
    """What a page's headings are called in links."""
    headings = re.findall(r"^#+ +(.+?) *$", _FENCED.sub("", page.read_text("utf-8")), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def dead_links(page: Path) -> list[str]:
    """Links of a page that lead nowhere."""
    return [
        f"{page.name}: {link.file.name}#{link.anchor}"
        for link in links(page)
        if not link.file.exists() or (link.anchor and link.anchor not in anchors(link.file))
    ]


@pytest.mark.parametrize("page", [*FRONT, *PAGES], ids=lambda page: page.relative_to(ROOT).as_posix())
def test_every_link_leads_somewhere(page):
    """The file is there, and the heading in it."""
    assert dead_links(page) == []


@pytest.mark.parametrize("page", [*FRONT, *PAGES], ids=lambda page: page.relative_to(ROOT).as_posix())
def test_every_path_that_is_named_is_there(page):
    """What a page calls `folder/file` is a folder or file of the checkout."""
    assert [name for name in _NAMED.findall(text_of(page)) if not (ROOT / name).exists()] == []


def test_every_page_that_code_names_is_there():
    """Docstrings, comments and messages send readers to pages that there are."""
    files = [file for folder in WITH_CODE for file in (ROOT / folder).rglob("*.*") if file.suffix in {".py", ".toml"}]
    named = {(name, file.name) for file in files for name in _PAGE_NAMED.findall(file.read_text("utf-8"))}
    assert len(named) > 5
    assert {(name, file) for name, file in named if not (ROOT / name).exists()} == set()


def test_docs_holds_pages_only():
    """Pages, pictures, data and how the site looks; what makes them lies in `validation/`."""
    assert {path.suffix for path in files_in_docs() if path not in STYLE} <= {".md"} | PICTURES | DATA


def test_every_file_of_docs_is_linked():
    """A picture or table that no page shows is left over, and so is a page that no other one leads to."""
    linked = {link.file for page in [*FRONT, *PAGES] for link in links(page) if link.file != page}
    assert set(files_in_docs()) - linked == STYLE


def test_every_page_stands_in_the_navigation():
    """Once each, and nothing that there is not."""
    named = _IN_NAVIGATION.findall(SITE.read_text("utf-8"))
    assert sorted(named) == [page.relative_to(DOCS).as_posix() for page in sorted(PAGES, key=_as_named)]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(DOCS).as_posix())
def test_no_page_leads_out_of_the_site(page):
    """What is no page, picture or table of `docs/` is named, not linked: the site does not have it."""
    assert [str(link.file) for link in links(page) if not link.file.is_relative_to(DOCS)] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(DOCS).as_posix())
def test_the_site_reads_lists_as_they_are_meant(page):
    """The site takes a list that follows a line of text for more text, and in lists wants steps of four blanks."""
    assert re.findall(r"^(?:    )* {1,3}```.*", page.read_text("utf-8"), re.MULTILINE) == []
    text = _FENCED.sub("", page.read_text("utf-8"))
    assert re.findall(r"^(?! *(?:[-*]|\d+\.) )(?! )[^\n<|]+\n(?:- |\d+\. ).*", text, re.MULTILINE) == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(DOCS).as_posix())
def test_no_bar_stands_in_code_of_a_table(page):
    """Where a page of the repository shows a bar, the site would show its backslash, too."""
    lines = _FENCED.sub("", page.read_text("utf-8")).splitlines()
    assert [line for line in lines for code in line.split("`")[1::2] if r"\|" in code] == []


@pytest.mark.parametrize(
    ("text", "dead"),
    [
        ("[a](other.md)", False),
        ("[a](other.md#some-heading-its-x_y)", False),
        ("[a](#here)", False),
        ("[a](https://nowhere.invalid/x.md)", False),
        ("`[a](gone.md)`", False),
        ("```\n[a](gone.md)\n```", False),
        ("[a](gone.md)", True),
        ("![a](gone.png)", True),
        ("[a](other.md#in-a-listing)", True),
        ("[a](#gone)", True),
    ],
)
def test_a_dead_link_is_found(tmp_path, text, dead):
    """Files and headings are looked up, and listings are not read."""
    (tmp_path / "other.md").write_text("# Some heading: it's `x_y`!\n\n```\n# in a listing\n```\n", "utf-8")
    page = tmp_path / "page.md"
    page.write_text(f"# Here\n\n{text}\n", "utf-8")
    assert bool(dead_links(page)) == dead
