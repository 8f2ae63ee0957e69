"""What is told of reused records when the tests are run."""

from collections.abc import Collection
from typing import Any

from pvlvrt_compliance.study.job import Job
from pvlvrt_compliance.study.work import Tested


def reuse_of(job: Job, finished: Collection[Tested]) -> dict[str, Any]:
    """For the provenance: the folder, how many tests are finished, and how many of them on records from there."""
    if job.reuse is None or job.debug:
        return {}
    return {"folder": job.reuse, "tests": len(finished), "reused": sum(tested.is_reused for tested in finished)}


def reuse_in_words(job: Job, finished: Collection[Tested]) -> list[str]:
    """The same as a line to tell, if there is one."""
    found = reuse_of(job, finished)
    return [f"{found['reused']} of {found['tests']} tests reuse a record of {found['folder']}"] if found else []
