"""The verdicts for a terminal, readable at 80 columns and without colour."""

from rich import box
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from pvlvrt_compliance.checks.results import Results, Status, TestResult
from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report.verdicts import Finding, counts, findings, verdicts

_STYLE = {
    Status.ERROR: "bold magenta",
    Status.NOT_EVALUATED: "yellow",
    Status.FAIL: "bold red",
    Status.PASS: "green",
    Status.NOT_APPLICABLE: "dim",
}


def render(results: Results) -> RenderableType:
    """Table, then what is to be said about every verdict that is not a pass, then one line of summary."""
    parts: list[RenderableType] = [verdict_table(results), Text()]
    found = findings(results)
    if found:
        parts += [_finding(item) for item in found] + [Text()]
    return Group(*parts, Text(summary_line(results), style=_STYLE[results.status]))


def verdict_table(results: Results) -> Table:
    """Table of all verdicts; with more than one test, each test has a line of its own above its checks."""
    several = len(results.tests) > 1
    table = Table(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False, padding=0)
    table.add_column("test / check" if several else "check", no_wrap=True)
    for heading in ("measured", "limit", "margin"):
        table.add_column(heading, justify="right", no_wrap=True)
    table.add_column("verdict", no_wrap=True)
    table.add_column("clause", overflow="fold", min_width=6)
    table.add_column("confidence", no_wrap=True)
    for test in results.tests:
        if several:
            title = Text(test.id, style="bold")
            table.add_row(title, "", "", "", _verdict(test.status), Text(test.clause), Text(test.confidence))
        _add_checks(table, test, indent="  " if several else "")
    return table


def summary_line(results: Results) -> str:
    """One line: the verdict of the run, how many tests, and how many verdicts of each kind."""
    tests = len(results.tests)
    kinds = ", ".join(f"{count} {spell.STATUS_WORD[status]}" for status, count in counts(results).items())
    head = f"{spell.STATUS_WORD[results.status].upper()}: {tests} test{'' if tests == 1 else 's'}"
    return f"{head}; checks: {kinds}" if kinds else head


def _add_checks(table: Table, test: TestResult, indent: str) -> None:
    for check in verdicts(test):
        numbers = spell.row(check)
        # The unit once a line: at 80 columns there is no room for it three times.
        limit, margin = (text.removesuffix(f" {check.unit}") for text in (numbers.limit, numbers.margin))
        cells = (indent + check.check, numbers.measured, limit, margin)
        # Text, because a str would be read as markup and "[0.7, 0.3]" would vanish.
        table.add_row(*map(Text, cells), _verdict(check.status), Text(check.clause), Text(check.confidence))


def _verdict(status: Status) -> Text:
    return Text(spell.STATUS_WORD[status], style=_STYLE[status])


def _finding(item: Finding) -> Text:
    head = f"{spell.STATUS_WORD[item.status]}: {', '.join(item.checks)} in {', '.join(item.tests)}: "
    return Text.assemble((head, _STYLE[item.status]), item.message)
