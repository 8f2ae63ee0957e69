"""The verdicts for a terminal, readable at 80 columns and without colour."""

from collections.abc import Iterable

from rich import box
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report.verdicts import (
    Finding,
    findings,
    in_a_word,
    kinds_in_words,
    marginal,
    may_decide,
    on_the_run,
    verdicts,
)
from pvlvrt_compliance.results import UNSETTLED, Results, Status, TestResult, Verdict, exit_status

SHORT = {
    Status.ERROR: "error",
    Status.NOT_EVALUATED: "n/e",
    Status.FAIL: "fail",
    Status.PASS: "pass",
    Status.NOT_APPLICABLE: "n/a",
}
STYLE = {
    Status.ERROR: "bold magenta",
    Status.NOT_EVALUATED: "yellow",
    Status.FAIL: "bold red",
    Status.PASS: "green",
    Status.NOT_APPLICABLE: "dim",
}

_MANY_TESTS = 60
_MOST_NOTES = 20
_COLUMNS = 80
_LIMIT_COLUMNS = 12  # ">=450.0-10.0"; one with more decimals goes on in the next line
_VERDICT_COLUMNS = 10  # "applicable", the longest word of a verdict


def render(results: Results, *, exit_zero: bool = False) -> RenderableType:
    """Table, then what is to be said about every verdict that is not a pass, then one line of summary.

    Of many tests only the verdicts by profile and check are shown; the report has the rest.
    """
    summary = Text(summary_line(results, exit_zero=exit_zero), style=STYLE[results.counts_as])
    if len(results.tests) > _MANY_TESTS:
        return Group(
            overview_table(results),
            Text(),
            *_not_passed(results),
            *_baseline(results),
            *_marginal(results),
            Text(),
            summary,
        )
    parts: list[RenderableType] = [verdict_table(results), Text()]
    new = [finding for finding in findings(results) if not finding.is_known]
    said = [*map(_finding, new), *_baseline(results), *_marginal(results)]
    if said:
        parts += [*said, Text()]
    return Group(*parts, summary)


def least_width(results: Results) -> int:
    """Columns that the table of `render` needs for nothing in it to be cut."""
    return _least_width(overview_table(results) if len(results.tests) > _MANY_TESTS else verdict_table(results))


def overview_table(results: Results) -> Table:
    """How many verdicts of each kind every check has, by profile."""
    table = Table(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False, padding=0)
    table.add_column("profile / check", no_wrap=True, min_width=28)
    for status in Status:
        table.add_column(SHORT[status], justify="right", no_wrap=True, min_width=6)
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
                if (check.status in UNSETTLED or check.worse) and not check.is_known:
                    where.setdefault((check.status, profile, check.check), []).append(test.id)
    lines = sorted(where.items(), key=lambda item: list(Status).index(item[0][0]))
    return [
        Text.assemble((f"{spell.STATUS_WORD[status]}: {name} in {profile}: ", STYLE[status]), ", ".join(ids))
        for (status, profile, name), ids in lines
    ]


def _counts(statuses: Iterable[Status]) -> list[Text]:
    found = list(statuses)
    return [Text(str(found.count(s) or ""), style=STYLE[s]) for s in Status]


def verdict_table(results: Results) -> Table:
    """Table of all verdicts; of several tests, each has a line of its own above its checks, and each profile one.

    Where 80 columns have no room for clauses they are left out; the report has them.
    """
    whole, less = _table(results, with_clause=True), _table(results, with_clause=False)
    fits = next((table for table in (whole, less) if _least_width(table) <= _COLUMNS), None)
    return fits or _table(results, with_clause=False, limit_columns=_LIMIT_COLUMNS)


def _least_width(table: Table) -> int:
    """Columns of a terminal that a table needs: those that do not wrap as wide as they are, and a gap between two."""
    widths = [
        max(len(cell.plain) if isinstance(cell, Text) else len(str(cell)) for cell in [column.header, *column.cells])
        if column.no_wrap
        else column.min_width or 0
        for column in table.columns
    ]
    return sum(widths) + len(widths) - 1


def _table(results: Results, with_clause: bool, limit_columns: int | None = None) -> Table:
    """The table; where ``limit_columns`` are given, a limit that is wider may go on in the next line."""
    several = len(results.tests) > 1
    table = Table(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False, padding=0)
    table.add_column("test / check" if several else "check", no_wrap=True)
    table.add_column("measured", justify="right", no_wrap=True)
    may_fold = limit_columns is not None
    table.add_column("limit", justify="right", no_wrap=not may_fold, overflow="fold", min_width=limit_columns)
    table.add_column("margin", justify="right", no_wrap=True)
    table.add_column("verdict", no_wrap=with_clause, min_width=None if with_clause else _VERDICT_COLUMNS)
    if with_clause:
        table.add_column("clause", overflow="fold", min_width=6)
    table.add_column("confidence", no_wrap=True)
    for profile, tests in _by_profile(results):
        if len(results.profiles) > 1:
            table.add_row(Text(profile, style="bold underline"))
        for test in tests:
            if several:
                table.add_row(*_test_cells(test, with_clause))
            _add_checks(table, test, "  " if several else "", with_clause)
    return table


def summary_line(results: Results, *, exit_zero: bool = False) -> str:
    """One line: what the run counts as, how many tests, how many verdicts of each kind and with each mark."""
    tests, kinds = len(results.tests), kinds_in_words(results)
    head = f"{in_a_word(results)}: {tests} test{'' if tests == 1 else 's'}"
    pieces = [f"checks: {kinds}"] if kinds else []
    marks = [mark for finding in results.verdicts() for mark in spell.marks_of(finding.verdict)]
    pieces += [f"{marks.count(mark)} {mark}" for mark in spell.MARK_SYMBOL if mark in marks and mark != "known"]
    let_off = ["exit status 0 by --exit-zero"] if exit_zero and exit_status(results) else []
    return "; ".join([head, *pieces, *on_the_run(results), *let_off])


def _test_cells(test: TestResult, with_clause: bool) -> list[Text]:
    demanded = spell.demand_in_words(test.expect) if test.expect != "ride_through" else ""
    clause = [Text(test.clause)] if with_clause else []
    cells = [Text(test.id, style="bold"), Text(demanded), Text(), Text(), _verdict(test.status)]
    return [*cells, *clause, Text(test.confidence)]


def _add_checks(table: Table, test: TestResult, indent: str, with_clause: bool) -> None:
    for check in verdicts(test):
        numbers = spell.row(check)
        # The unit once a line: at 80 columns there is no room for it three times.
        margin = spell.bare(numbers.margin)
        cells = (indent + check.check, numbers.measured, spell.limit_in_signs(check), margin)
        # Text, because a str would be read as markup and "[0.7, 0.3]" would vanish.
        clause = (Text(check.clause),) if with_clause else ()
        verdict = _verdict(check.status, spell.verdict_in_words(check))
        table.add_row(*map(Text, cells), verdict, *clause, Text(check.confidence))


def _verdict(status: Status, words: str = "") -> Text:
    return Text(words or spell.STATUS_WORD[status], style=STYLE[status])


def _marginal(results: Results) -> list[Text]:
    """How many verdicts method and measurement leave open, what may decide, and a line for each."""
    found = marginal(results)
    if not found:
        return []
    count = "1 verdict is" if len(found) == 1 else f"{len(found)} verdicts are"
    head = "; ".join(filter(None, [f"{count} nearer to the limit than the uncertainty", may_decide(results)]))
    return [Text.assemble(("marginal: ", "yellow"), head), *(Text(f"  {_open(*item)}") for item in found)]


def _baseline(results: Results) -> list[Text]:
    """How many failures are known, and what of the baseline is out of date."""
    baseline = results.baseline
    if baseline is None:
        return []
    known = sum(finding.verdict.is_known for finding in results.verdicts())
    count = "1 failure" if known == 1 else f"{known} failures"
    lines = [Text.assemble(("known: ", "bold"), f"{count} that {baseline.file} knows")] if known else []
    for kind, notes in (("better", baseline.better), ("gone", baseline.gone)):
        lines += [Text.assemble((f"{kind}: ", "bold"), note.in_words) for note in notes[:_MOST_NOTES]]
        if len(notes) > _MOST_NOTES:
            lines.append(Text(f"{kind}: {len(notes) - _MOST_NOTES} more; results.json has them all"))
    return lines


def _open(test: str, check: Verdict) -> str:
    place = ", ".join(filter(None, [f"{check.check} in {test}", check.stretch]))
    return f"{place}: {spell.marginal_in_words(check)}"


def _finding(item: Finding) -> Text:
    head = f"{spell.STATUS_WORD[item.status]}: {', '.join(item.checks)} in {', '.join(item.tests)}: "
    said = "; ".join(filter(None, [item.message, spell.baseline_in_words(item)]))
    return Text.assemble((head, STYLE[item.status]), said)
