"""The pages: text written by hand, with parts between marks that are made of code, parameters, numbers and tests.

A part begins with ``<!-- made: KIND what it is of -->`` and ends with ``<!-- end -->``; what is between is made anew.
"""

import ast
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from validation.blocks import numbers
from validation.blocks.parameters import table as parameter_table
from validation.places import DOCS, ROOT
from validation.simulator.page import table as number_table

FOLDERS = ("controller", "plant", "hardware")
"""Of `docs/`, each named as its room but for `control/`."""
MADE = re.compile(r"<!-- made: (\w+)(.*?) -->\n(.*?)<!-- end -->\n", re.DOTALL)


def pages() -> list[Path]:
    """All pages of blocks."""
    return [path for folder in FOLDERS for path in sorted((DOCS / folder).glob("*.md"))]


def made_of(text: str, kind: str) -> list[str]:
    """What the parts of a kind are made of, on one page."""
    return [name for found, names, _ in MADE.findall(text) if found == kind for name in names.split()]


def filled(page: Path) -> str:
    """Text of a page with every part made anew."""

    def part(match: re.Match[str]) -> str:
        kind, names, _ = match.groups()
        body = "\n".join(lines(kind, names.split()))
        return f"<!-- made: {kind}{names} -->\n{body}\n<!-- end -->\n"

    return MADE.sub(part, page.read_text("utf-8"))


def lines(kind: str, names: list[str]) -> Iterable[str]:
    """Lines of a part."""
    match kind:
        case "code":
            return [f"Code: {', '.join(f'`{name}`' for name in names)}."]
        case "parameters":
            return ["", *parameter_table(names), ""]
        case "numbers":
            return ["", *number_table(row for name in names for row in numbers.ROWS[name]()), ""]
        case "tests":
            return ["", *_tests(names), ""]
    raise ValueError(f"no part of a page is called {kind}")


def _tests(names: list[str]) -> Iterator[str]:
    """Each file, and the sentence of each test: of all, or of those that are named as ``file::test``."""
    for file in dict.fromkeys(name.partition("::")[0] for name in names):
        yield f"- `{file}`"
        wanted = {test for name in names for path, _, test in [name.partition("::")] if path == file}
        yield from (f"    - {said}" for said in sentences(ROOT / file, wanted - {""}))


def sentences(file: Path, wanted: set[str]) -> list[str]:
    """First paragraphs of the docstrings of a file's tests; with ``wanted`` of these alone.

    Raises
    ------
    KeyError
        When a test that is wanted is not there.
    """
    found = {
        node.name: " ".join((ast.get_docstring(node) or "").partition("\n\n")[0].split())
        for node in ast.parse(file.read_text("utf-8")).body
        if isinstance(node, ast.FunctionDef) and node.name.startswith("test_")
    }
    missing = wanted - set(found)
    if missing:
        raise KeyError(f"{file.name} has no {', '.join(sorted(missing))}")
    return [_escaped(text) for name, text in found.items() if not wanted or name in wanted]


def _escaped(text: str) -> str:
    """Text in which Markdown sees no emphasis, but for what stands between backticks."""
    parts = text.split("`")
    return "`".join(part if k % 2 else re.sub(r"([*_|])", r"\\\1", part) for k, part in enumerate(parts))
