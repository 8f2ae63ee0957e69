"""What a sheet is made of, as plain data that the templates lay out: no block knows what a report is about.

Text is data all the way: it reaches the templates as JSON, and nothing in it is markup there.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

from pvlvrt_compliance.report.pdf.characters import code, drawn, shown, told

Width = float | str
"""Of a column: a share of what is left, ``"auto"`` for as wide as its content, or a length, ``"18mm"``."""


class Cell(NamedTuple):
    """A cell of a table: its text, and what sets it off.

    ``status`` puts the symbol of a verdict before the text, in its colour; ``to`` makes it a link to a test by its
    number, ``page`` is the page on which a test begins in place of a text; ``span`` is over how many columns it goes,
    a ``joined`` one belongs to what stands above it, and what is ``english`` is so in every language.
    """

    text: str
    status: str = ""
    to: int | None = None
    page: int | None = None
    span: int = 1
    joined: bool = False
    strong: bool = False
    small: bool = False
    english: bool = False


class Column(NamedTuple):
    """A column: what stands above it, how wide it is, and on which side its cells stand."""

    head: str
    width: Width = 1.0
    align: str = "left"


class Heading(NamedTuple):
    """A heading of level 2 or 3; ``test`` is the number of the test that it begins."""

    text: str
    level: int = 2
    test: int | None = None


class Paragraph(NamedTuple):
    """Sentences; small ones are a note, ``english`` ones are so in every language."""

    text: str
    small: bool = False
    strong: bool = False
    english: bool = False


class Facts(NamedTuple):
    """Names and values, two columns."""

    rows: tuple[tuple[str, str], ...]
    code: bool = False


class Items(NamedTuple):
    """A list; each item may link to a test."""

    items: tuple[Cell, ...]


class Legend(NamedTuple):
    """What symbols mean, one after the other."""

    cells: tuple[Cell, ...]


class Table(NamedTuple):
    """A table with its heads repeated on every page; ``upright`` turns all heads but the first and the last."""

    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]
    upright: bool = False
    dense: bool = False


class Picture(NamedTuple):
    """A figure: an SVG, the words below it, what a screen reader says of it, and its share of a line's width."""

    svg: str
    caption: str
    alternative: str
    width: float = 1.0


class Beside(NamedTuple):
    """Narrow figures that stand on one line."""

    pictures: tuple[Picture, ...]


Block = Heading | Paragraph | Facts | Items | Legend | Table | Picture | Beside


class Section(NamedTuple):
    """A numbered part of the document that begins with a heading of level 1."""

    title: str
    blocks: tuple[Block, ...]
    annex: bool = False
    new_page: bool = False


def as_data(sections: Sequence[Section]) -> list[dict[str, Any]]:
    """Sections as JSON has them, every text made showable."""
    return [
        {
            "title": shown(section.title),
            "annex": section.annex,
            "new_page": section.new_page,
            "blocks": [{"kind": type(block).__name__.lower(), **_block(block)} for block in section.blocks],
        }
        for section in sections
    ]


def _block(block: Block) -> dict[str, Any]:
    match block:
        case Picture():
            return _picture(block)
        case Beside():
            return {"pictures": list(map(_picture, block.pictures))}
        case Table():
            return _table(block)
        case Facts():
            spelled = code if block.code else shown
            return {"rows": [[shown(name), spelled(value)] for name, value in block.rows], "code": block.code}
        case Items(cells) | Legend(cells):
            return {"items" if isinstance(block, Items) else "cells": list(map(cell, cells))}
    return block._asdict() | {"text": shown(block.text)}


def _table(given: Table) -> dict[str, Any]:
    columns = [column._asdict() | {"head": shown(column.head)} for column in given.columns]
    rows = [list(map(cell, row)) for row in given.rows]
    return {"columns": columns, "rows": rows, "upright": given.upright, "dense": given.dense}


def _picture(given: Picture) -> dict[str, Any]:
    return {
        "svg": drawn(given.svg),
        "caption": shown(given.caption),
        "alternative": told(given.alternative),
        "width": given.width,
    }


def cell(given: Cell) -> dict[str, Any]:
    """A cell as JSON has it: what is as usual is left out."""
    usual = Cell._field_defaults
    told = {name: value for name, value in given._asdict().items() if name not in usual or value != usual[name]}
    return told | {"text": shown(given.text)}
