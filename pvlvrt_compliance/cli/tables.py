"""Tables on stdout: whole lines in a file, folded to a terminal's width."""

from collections.abc import Sequence
from typing import NamedTuple

from rich import box
from rich.console import Console
from rich.measure import Measurement
from rich.table import Table

from pvlvrt_compliance.cli.telling import screen
from pvlvrt_compliance.texts import printable


class Column(NamedTuple):
    """A column: its heading, whether it is of numbers, and whether its cells may go on in the next line."""

    heading: str
    is_number: bool = False
    folds: bool = False


def print_table(columns: Sequence[Column], rows: Sequence[Sequence[str]], gap: int = 1) -> None:
    """Print a table: a row a line where it goes to a file or a pipe, and nothing cut on a terminal either.

    Parameters
    ----------
    columns : sequence of Column
    rows : sequence of sequence of str
        A cell a column.
    gap : int
        Blanks between two columns.
    """
    shown = screen()
    table = Table(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False, padding=(0, gap - 1, 0, 0))
    for column in columns:
        table.add_column(
            column.heading,
            justify="right" if column.is_number else "left",
            no_wrap=not column.folds,
            overflow="fold",
        )
    for row in rows:
        table.add_row(*map(printable, row))
    if not shown.is_terminal:
        shown.width = _whole_width(shown, table)
    shown.print(table)


def terminal_columns() -> int | None:
    """Width of the terminal that stdout is; nothing of a file or a pipe, where a line stays whole."""
    shown = screen()
    return shown.width if shown.is_terminal else None


def _whole_width(shown: Console, table: Table) -> int:
    """Columns that a table needs when nothing in it goes on in a next line."""
    endless = shown.options.update(width=_ENDLESS)
    return max(shown.width, Measurement.get(shown, endless, table).maximum)


_ENDLESS = 100_000
