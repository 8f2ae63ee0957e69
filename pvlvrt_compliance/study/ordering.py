"""The order in which a run shows its tests."""

from collections.abc import Sequence

from pvlvrt_compliance.study.job import Job
from pvlvrt_compliance.study.selection import Assignment
from pvlvrt_compliance.study.session import Tested


def in_order(finished: Sequence[Tested], job: Job) -> list[Tested]:
    """Tests in the order of the profiles and their tables, whichever was run first; further runs behind their row."""
    from pvlvrt_compliance.study.sharing import in_turn  # with the simulator, which reading results never pays for

    profiles = [profile.id for profile in job.profiles]
    rows = {_row(item): number for number, (item, *_) in enumerate(in_turn(job.tests))}
    return sorted(finished, key=lambda tested: (profiles.index(tested.profile.id), rows[_row(tested)]))


def _row(item: Assignment | Tested) -> tuple[str, str]:
    return item.profile.id, item.test.row or item.test.id
