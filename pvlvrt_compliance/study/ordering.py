"""The order in which tests are run, and the one in which a run shows them."""

from collections.abc import Collection, Iterable, Sequence

from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.study.job import Job
from pvlvrt_compliance.study.selection import Assignment
from pvlvrt_compliance.study.work import Tested


def rows_of(assignments: Iterable[Assignment]) -> list[tuple[Assignment, ...]]:
    """Runs of the same row together, in the order in which they come; a test outside any table is a row of its own."""
    rows: dict[tuple[str, str], list[Assignment]] = {}
    for assignment in assignments:
        rows.setdefault((assignment.profile.id, assignment.test.row or assignment.test.id), []).append(assignment)
    return [tuple(row) for row in rows.values()]


def shared_together(rows: Sequence[tuple[Assignment, ...]]) -> list[tuple[Assignment, ...]]:
    """The rows in an order in which those that begin with the same scenario follow one another.

    The records that `sharing.SharedSimulator` keeps are then few.
    """
    first = [row[0].test.scenario for row in rows]
    place: dict[Scenario, int] = {}
    for index, scenario in enumerate(first):
        place.setdefault(scenario, index)
    return [rows[index] for index in sorted(range(len(rows)), key=lambda index: place[first[index]])]


def in_turn(assignments: Iterable[Assignment], first: Collection[str] = ()) -> list[tuple[Assignment, ...]]:
    """The rows in the order in which they are run: those with one of ``first`` before the others.

    What begins with the same scenario goes with them, since its record is at hand then.
    """
    rows = shared_together(rows_of(assignments))
    ahead = {row[0].test.scenario for row in rows if any(item.key in first for item in row)}
    return sorted(rows, key=lambda row: row[0].test.scenario not in ahead)


def in_order(finished: Sequence[Tested], job: Job) -> list[Tested]:
    """Tests in the order of the profiles and their tables, whichever was run first; further runs behind their row."""
    profiles = [profile.id for profile in job.profiles]
    rows = {_row(item): number for number, (item, *_) in enumerate(in_turn(job.tests))}
    return sorted(finished, key=lambda tested: (profiles.index(tested.profile.id), rows[_row(tested)]))


def _row(item: Assignment | Tested) -> tuple[str, str]:
    return item.profile.id, item.test.row or item.test.id
