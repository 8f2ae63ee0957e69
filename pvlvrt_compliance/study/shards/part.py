"""A part of a run, as it lies in its folder."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from pvlvrt_compliance.results import Results
from pvlvrt_compliance.study.job import Job
from pvlvrt_compliance.study.shards.shard import Shard, shard_of


@dataclass(frozen=True, kw_only=True)
class Head:
    """What a part says of the whole run.

    Parameters
    ----------
    shard : str
        Which part it is, ``2/5``.
    given : mapping
        What was given for the run, by field.
    command : sequence of str
        As it was recorded.
    settings : mapping
        What of it was written down.
    run_id : str
        Of the results beside it.
    """

    shard: str
    given: Mapping[str, Any]
    command: Sequence[str]
    settings: Mapping[str, Any]
    run_id: str = ""


def head_of(
    job: Job, given: Mapping[str, Any], command: Sequence[str], settings: Mapping[str, Any] | None
) -> Head | None:
    """What is said of the whole run by the part that a job is, if it is one; arguments are fields of it."""
    if job.shard is None:
        return None
    return Head(shard=str(job.shard), given=given, command=command, settings=settings or {})


@dataclass(frozen=True)
class Part:
    """A part: its folder, what it says of the whole, what it has found, and what was made of its records."""

    folder: Path
    head: Head
    results: Results
    made: Mapping[str, Any]

    @property
    def shard(self) -> Shard:
        """Which part it is."""
        return shard_of(self.head.shard, f"{self.folder}: part")

    def with_given(self, given: Mapping[str, Any]) -> "Part":
        """The same part, with other values that were given for the run."""
        return replace(self, head=replace(self.head, given=given))
