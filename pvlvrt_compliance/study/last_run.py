"""What the last run into a folder has left unsettled: those tests may be run again, or first."""

from collections.abc import Collection, Sequence
from pathlib import Path
from typing import NamedTuple

from pvlvrt_compliance.checks.rows import is_judged_as_one
from pvlvrt_compliance.results import UNSETTLED, TestResult, counts_for
from pvlvrt_compliance.results.files import INTERRUPTED, RESULTS
from pvlvrt_compliance.results.reading import read_results
from pvlvrt_compliance.study.selection import Assignment, row_of_further


def last_tests(folder: Path) -> tuple[TestResult, ...] | None:
    """The tests of the last run into a folder; None where there is none.

    Of a run that was interrupted those that were finished count, and of the others what the whole run before found.

    Raises
    ------
    UsageError
        When its results cannot be read.
    """
    files = [file for file in (folder / RESULTS, folder / INTERRUPTED / RESULTS) if file.is_file()]
    found = {test.key: test for file in files for test in read_results(file).tests}
    return tuple(found.values()) if files else None


class Unsettled(NamedTuple):
    """What the last run has left unsettled among some tests."""

    again: frozenset[str] = frozenset()  # keys of those that are to be run again
    not_passed: int = 0  # tests that were not passed, further runs of rows among them
    rows: int = 0  # rows of which runs are needed again though nothing is said against these themselves


def unsettled_among(found: Sequence[Assignment], last: Collection[TestResult]) -> Unsettled:
    """Those tests that were not passed the last time, as far as they are among these.

    Failures that a baseline knows are none. Where a row is judged as one, all of its runs are needed again.
    """
    keys = {test.key for test in last if counts_for(test) in UNSETTLED}
    of_further = {row_of_further(key) for key in keys}
    begun = [item for item in found if item.key in keys or _row(item) in of_further]
    whole = {_row(item) for item in begun if is_judged_as_one(item.profile, item.test)}
    again = {item.key: _row(item) for item in [*begun, *(item for item in found if _row(item) in whole)]}
    reached = set(again.values())
    return Unsettled(
        again=frozenset(again),
        not_passed=sum(key in again or row_of_further(key) in reached for key in keys),
        rows=len({row for key, row in again.items() if key not in keys}),
    )


def _row(item: Assignment) -> str:
    return f"{item.profile.id}.{item.test.row}"
