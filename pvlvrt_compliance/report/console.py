"""The verdicts for a terminal, readable at 80 columns and without colour."""

from collections.abc import Iterable

from rich import box
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report.verdicts import Finding, counts, findings, verdicts
from pvlvrt_compliance.results import EXIT_STATUS, Results, Status, TestResult

_SHORT = {
    Status.ERROR: "error",
    Status.NOT_EVALUATED: "n/e",
    Status.FAIL: "fail",
    Status.PASS: "pass",
    Status.NOT_APPLICABLE: "n/a",
}
_STYLE = {
    Status.ERROR: "bold magenta",
    Status.NOT_EVALUATED: "yellow",
    Status.FAIL: "bold red",
    Status.PASS: "green",
    Status.NOT_APPLICABLE: "dim",
}


_MANY_TESTS = 60
_SHORT_NAME = 16  # characters of a check's name that leave room for its clause


def render(results: Results) -> RenderableType:
    """Table, then what is to be said about every verdict that is not a pass, then one line of summary.

    Of many tests only the verdicts by profile and check are shown; the report has the rest.
    """
    summary = Text(summary_line(results), style=_STYLE[results.status])
    if len(results.tests) > _MANY_TESTS:
        return Group(overview_table(results), Text(), *_not_passed(results), Text(), summary)
    parts: list[RenderableType] = [verdict_table(results), Text()]
    found = findings(results)
    if found:
        parts += [_finding(item) for item in found] + [Text()]
    return Group(*parts, summary)


def overview_table(results: Results) -> Table:
    """How many verdicts of each kind every check has, by profile."""
    table = Table(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False, padding=0)
    table.add_column("profile / check", no_wrap=True, min_width=28)
    for status in Status:
        table.add_column(_SHORT[status], justify="right", no_wrap=True, min_width=6)
    for profile, tests in _by_profile(results):
        title = f"{profile}: {len(tests)} test{'' if len(tests) == 1 else 's'}"
        table.add_row(Text(title, style="bold"), *_counts(test.status for test in tests))
        for name in dict.fromkeys(check.check for test in tests for check in verdicts(test)):
            found = [check.status for test in tests for check in verdicts(test) if check.check == name]
            table.add_row(Text(f"  {name}"), *_counts(found))
    return table


def _by_profile(results: Results) -> list[tuple[str, list[TestResult]]]:
    names = dict.fromkeys(test.profile for test in results.tests)
    return [(name, [test for test in results.tests if test.profile == name]) for name in names]


def _not_passed(results: Results) -> list[Text]:
    """A line for each check of a profile that is not passed everywhere: where it is not."""
    where: dict[tuple[Status, str, str], list[str]] = {}
    for profile, tests in _by_profile(results):
        for test in tests:
            for check in verdicts(test):
                if EXIT_STATUS[check.status]:
                    where.setdefault((check.status, profile, check.check), []).append(test.id)
    lines = sorted(where.items(), key=lambda item: list(Status).index(item[0][0]))
    return [
        Text.assemble((f"{spell.STATUS_WORD[status]}: {name} in {profile}: ", _STYLE[status]), ", ".join(ids))
        for (status, profile, name), ids in lines
    ]


def _counts(statuses: Iterable[Status]) -> list[Text]:
    found = list(statuses)
    return [Text(str(found.count(s) or ""), style=_STYLE[s]) for s in Status]


def verdict_table(results: Results) -> Table:
    """Table of all verdicts; of several tests, each has a line of its own above its checks, and each profile one.

    Beside long names of checks 80 columns have no room for clauses; the report has them.
    """
    several = len(results.tests) > 1
    with_clause = all(len(check.check) <= _SHORT_NAME for test in results.tests for check in verdicts(test))
    table = Table(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False, padding=0)
    table.add_column("test / check" if several else "check", no_wrap=True)
    for heading in ("measured", "limit", "margin"):
        table.add_column(heading, justify="right", no_wrap=True)
    table.add_column("verdict", no_wrap=True)
    if with_clause:
        table.add_column("clause", overflow="fold", min_width=6)
    table.add_column("confidence", no_wrap=True)
    for profile, tests in _by_profile(results):
        if len(results.profiles) > 1:
            table.add_row(Text(profile, style="bold underline"))
        for test in tests:
            if several:
                clause = (Text(test.clause),) if with_clause else ()
                title = Text(test.id, style="bold")
                table.add_row(title, "", "", "", _verdict(test.status), *clause, Text(test.confidence))
            _add_checks(table, test, "  " if several else "", with_clause)
    return table


def summary_line(results: Results) -> str:
    """One line: the verdict of the run, how many tests, and how many verdicts of each kind."""
    tests = len(results.tests)
    kinds = ", ".join(f"{count} {spell.STATUS_WORD[status]}" for status, count in counts(results).items())
    head = f"{spell.STATUS_WORD[results.status].upper()}: {tests} test{'' if tests == 1 else 's'}"
    return f"{head}; checks: {kinds}" if kinds else head


def _add_checks(table: Table, test: TestResult, indent: str, with_clause: bool) -> None:
    for check in verdicts(test):
        numbers = spell.row(check)
        # The unit once a line: at 80 columns there is no room for it three times.
        limit, margin = (text.removesuffix(f" {check.unit}") for text in (numbers.limit, numbers.margin))
        cells = (indent + check.check, numbers.measured, limit, margin)
        # Text, because a str would be read as markup and "[0.7, 0.3]" would vanish.
        clause = (Text(check.clause),) if with_clause else ()
        table.add_row(*map(Text, cells), _verdict(check.status), *clause, Text(check.confidence))


def _verdict(status: Status) -> Text:
    return Text(spell.STATUS_WORD[status], style=_STYLE[status])


def _finding(item: Finding) -> Text:
    head = f"{spell.STATUS_WORD[item.status]}: {', '.join(item.checks)} in {', '.join(item.tests)}: "
    return Text.assemble((head, _STYLE[item.status]), item.message)
