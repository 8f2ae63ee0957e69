"""The page: sections as Markdown, and whether two pages say the same."""

import re
from collections.abc import Iterable, Iterator

from validation.places import DOCS
from validation.simulator.evidence import Row, Section

PAGE = DOCS / "validation.md"
FIGURES = "validation/figures"
"""Folder of the drawings, beside the page."""
_DIGITS = 3
_NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")

_HEAD = """# Validation

Figures found beside figures that another program, a closed form or the paper gives. This page is written by `python -m
validation.simulator`; `--check` computes everything anew and fails when a printed figure is another one, by
more than one unit of its last digit. `tests/validation/` asserts the same figures. It needs the extra `dev` and
ngspice. The inverter is the averaged one unless a section says otherwise."""


def number(x: float) -> str:
    """Three significant digits, without an exponent where that is readable."""
    if x == 0 or 1e-3 <= abs(x) < 1e5:
        shown = f"{float(f'{x:.{_DIGITS}g}'):.10g}"
        # Whole numbers keep their digits: 610.4, 63.5 and 507 are read beside each other.
        return shown if abs(x) < 100 else f"{x:.1f}"
    return f"{x:.1e}"


def found(row: Row) -> str:
    """The figure, or the level below which it is rounding."""
    return f"below {number(row.floor)}" if abs(row.found) < row.floor else number(row.found)


def cells(row: Row) -> tuple[str, ...]:
    """One line of a table."""
    if row.expected is None:
        return row.name, found(row), "", "", row.unit, ""
    expected, verdict = number(row.expected), "yes" if row.within else "**no**"
    return row.name, found(row), expected, number(row.tolerance), row.unit, verdict


def table(rows: Iterable[Row]) -> Iterator[str]:
    """Lines of a table."""
    yield "| figure | found | expected | tolerance | unit | within |"
    yield "|---|---|---|---|---|---|"
    for row in rows:
        yield f"| {' | '.join(cells(row))} |"


def lines(section: Section) -> Iterator[str]:
    """Lines of a section."""
    yield f"## {section.title}\n"
    yield f"{section.text}\n"
    if section.rows:
        yield from table(section.rows)
        yield ""
    for plot in section.plots:
        yield f"![{plot.caption}]({FIGURES}/{plot.file}.svg)\n"
        yield f"*{plot.caption}*\n"


def page(sections: Iterable[Section]) -> str:
    """The whole page."""
    return "\n".join([_HEAD + "\n", *(line for section in sections for line in lines(section))]).rstrip() + "\n"


def _unit_of_last_digit(text: str) -> float:
    mantissa, _, exponent = text.partition("e")
    decimals = len(mantissa.partition(".")[2])
    return float(10.0 ** (int(exponent or 0) - decimals))


def same_number(a: str, b: str) -> bool:
    """Whether two printed numbers differ by at most one unit of the last digit: on a boundary either may be printed."""
    allowed = max(_unit_of_last_digit(a), _unit_of_last_digit(b))
    return abs(float(a) - float(b)) <= 1.001 * allowed


def differences(old: str, new: str) -> list[str]:
    """Lines of two pages that say something else, as ``old -> new``."""
    before, after = old.splitlines(), new.splitlines()
    pairs = list(zip(before, after, strict=False))
    wrong = [f"{a}\n  -> {b}" for a, b in pairs if not _same_line(a, b)]
    if len(before) != len(after):
        wrong.append(f"the page has {len(before)} lines and should have {len(after)}")
    return wrong


def _same_line(a: str, b: str) -> bool:
    numbers = list(zip(_NUMBER.findall(a), _NUMBER.findall(b), strict=False))
    return _NUMBER.sub("#", a) == _NUMBER.sub("#", b) and all(same_number(x, y) for x, y in numbers)
