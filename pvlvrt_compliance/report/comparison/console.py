"""A comparison for a terminal, readable at 80 columns and without colour."""

from collections.abc import Sequence
from itertools import groupby

from rich import box
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from pvlvrt_compliance.report.comparison.words import (
    MOST,
    Part,
    cells_of,
    differences_in_words,
    outcome,
    parts_of,
    profiles_in_words,
    summary,
)
from pvlvrt_compliance.report.console import SHORT, STYLE
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.results.comparison import Changed, Compared, Comparison
from pvlvrt_compliance.results.verdict import Status
from pvlvrt_compliance.texts import printable

WIDTH_OF_A_FILE = 240
"""Columns where no terminal is: no line is broken there, so that it can be searched."""

_STYLES = {"none": "green", "regression": "bold red", "unjudged": "bold magenta", "nothing": "bold magenta"}
_SHORTENED = {"lost", "gained"}
"""Parts that may have hundreds of entries: the files have them all."""


def render(comparison: Comparison) -> RenderableType:
    """What the two are, the table of all changes, what they were made with that differs, and one line of summary."""
    texts = Texts()
    parts: list[RenderableType] = [_run(word, one) for word, one in _both(comparison, texts)]
    if comparison.changes:
        parts += [Text(), table(comparison, texts)]
    said = [
        *(Text(line, style="bold yellow") for line in profiles_in_words(comparison.profiles, texts)),
        *map(Text, differences_in_words(comparison.differences, texts)),
    ]
    return Group(*parts, *([Text(), *said] if said else []), Text(), summary_text(comparison))


def summary_text(comparison: Comparison) -> Text:
    """One line of summary."""
    return Text(summary(comparison, Texts()), style=_STYLES[outcome(comparison)])


def left_out(reasons: Sequence[str]) -> tuple[str, ...]:
    """One line that says why figures are not on the page, where some are not."""
    if not reasons:
        return ()
    more = f" (and {len(reasons) - 1} more such, which the page names)" if len(reasons) > 1 else ""
    return (f"{Texts()('comparison.left_out')} {printable(reasons[0])}{more}",)


def table(comparison: Comparison, texts: Texts) -> Table:
    """All changes by kind; of margins the largest."""
    found = Table(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False, padding=0)
    found.add_column("test / check", overflow="fold")
    for heading in ("was", "is"):
        found.add_column(heading, no_wrap=True, min_width=5)
    for heading in ("margin was", "margin is", "of limit"):
        found.add_column(heading, justify="right", no_wrap=True)
    for part in parts_of(comparison):
        _add(found, part, texts)
    return found


def _both(comparison: Comparison, texts: Texts) -> list[tuple[str, Compared]]:
    return [(texts("comparison.old"), comparison.old), (texts("comparison.new"), comparison.new)]


def _run(word: str, one: Compared) -> Text:
    tests = f"{one.tests} test{'' if one.tests == 1 else 's'}"
    controller = [one.controller] if one.controller not in ("", one.name) else []
    return Text(f"{word}: {', '.join([one.name, *controller, tests, SHORT[one.status]])}")


def _add(found: Table, part: Part, texts: Texts) -> None:
    shown = part.changes[:MOST] if part.key in _SHORTENED else part.changes
    number = f"{len(shown)} of {part.verdicts}" if len(shown) < len(part.changes) else f"{part.verdicts}"
    found.add_row(Text(f"{texts(f'comparison.part.{part.key}')} ({number})", style="bold underline"))
    for test in part.tests:
        mark = "! " if test.is_regression else "  "
        found.add_row(Text(f"{mark}{test.name} ({len(test.changes)})", style="bold"), *map(_status, test.statuses))
    for name, changes in groupby(shown, key=lambda one: one.test):
        found.add_row(Text(f"  {name}", style="bold"))
        for change in changes:
            found.add_row(*_cells(change))


def _cells(change: Changed) -> list[Text]:
    cells = cells_of(change)
    mark = "! " if change.regression else "  "
    statuses = [_status(None if one is None else one.status) for one in (change.old, change.new)]
    name = Text(f"{mark:>4}{change.check}", style="bold red" if change.regression else "")
    return [name, *statuses, *map(Text, cells)]


def _status(status: Status | None) -> Text:
    return Text("-") if status is None else Text(SHORT[status], style=STYLE[status])
