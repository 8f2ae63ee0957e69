"""The cursors of a test as a table: a part a stretch between steps, a row a quantity."""

from typing import NamedTuple

from pvlvrt_compliance.report.document.stretches import stretch_words
from pvlvrt_compliance.report.format import number
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.results import Cursor, CursorStretch, TestResult

COLUMNS = {
    **dict.fromkeys(("minimum", "maximum", "mean", "change"), ""),
    **dict.fromkeys(("reaction", "rise", "response", "settling"), "ms"),
    "overshoot": "%",
}
"""Columns of numbers, by the names of their headings in the catalogue, with their units; none: that of the row."""

_NONE = "–"
_UNITS = {"pu": "pu", "kw": "kW", "kvar": "kvar", "v": "V", "hz": "Hz"}
"""By the end of a quantity's name."""


class Heading(NamedTuple):
    """What stands over a column, and its unit; none: that of the row."""

    name: str
    unit: str


class CursorRow(NamedTuple):
    """A quantity in a stretch: its name and unit, and the cells in the order of `COLUMNS`."""

    name: str
    unit: str
    cells: tuple[str, ...]


class CursorPart(NamedTuple):
    """A stretch: when it is, what grid and sun do in it (whole sentences; none: not known), and its rows."""

    heading: str
    in_words: str
    rows: tuple[CursorRow, ...]


def headings(texts: Texts) -> tuple[Heading, ...]:
    """Headings of the quantity and of `COLUMNS`; the overshoot is in percent of the change."""
    return tuple(Heading(texts(f"cursor.column.{name}"), unit) for name, unit in (("quantity", ""), *COLUMNS.items()))


def cursor_parts(test: TestResult, texts: Texts) -> tuple[CursorPart, ...]:
    """The parts of the table; none of a test without cursors."""
    return tuple(_part(test, stretch, texts) for stretch in test.cursors if stretch.cursors)


def note(test: TestResult, texts: Texts) -> str:
    """What the numbers are, in sentences."""
    bands = {stretch.band_percent for stretch in test.cursors if stretch.band_percent is not None}
    return texts("cursor.note", band=", ".join(f"{band:g}" for band in sorted(bands)))


def _part(test: TestResult, stretch: CursorStretch, texts: Texts) -> CursorPart:
    heading = texts(
        "cursor.before" if stretch.is_before else "cursor.stretch",
        begin=number(stretch.begin_s, "s"),
        end=number(stretch.end_s, "s"),
    )
    words = "" if stretch.is_before else stretch_words(test, stretch.begin_s, stretch.end_s, texts)
    return CursorPart(heading, words, tuple(_row(cursor, texts) for cursor in stretch.cursors))


def _row(cursor: Cursor, texts: Texts) -> CursorRow:
    unit = _UNITS.get(cursor.quantity.rsplit("_", 1)[-1], "")
    levels = (_bare(value, unit) for value in (cursor.minimum, cursor.maximum, cursor.mean))
    times = (cursor.reaction_s, cursor.rise_s, cursor.response_s, cursor.settling_s)
    cells = (*levels, _change(cursor, unit, texts), *(_bare(_in_ms(t_s), "ms") for t_s in times))
    overshoot = number(cursor.overshoot_percent, decimals=1)
    return CursorRow(texts.named("cursor.quantity", cursor.quantity), unit, (*cells, overshoot or _NONE))


def _change(cursor: Cursor, unit: str, texts: Texts) -> str:
    if cursor.initial is None or cursor.final is None:
        return _NONE
    return texts("cursor.from_to", initial=_bare(cursor.initial, unit), final=_bare(cursor.final, unit))


def _in_ms(t_s: float | None) -> float | None:
    return None if t_s is None else 1e3 * t_s


def _bare(value: float | None, unit: str) -> str:
    """A number whose unit stands elsewhere; a dash for none."""
    return number(value, unit).removesuffix(f" {unit}") or _NONE
