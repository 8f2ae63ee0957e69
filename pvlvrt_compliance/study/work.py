"""What is done with the tests of a job, wherever they are run."""

from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any, NamedTuple

from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.results import UNSETTLED, TestResult, counts_for
from pvlvrt_compliance.study.baseline.applying import with_baseline
from pvlvrt_compliance.study.job import Job
from pvlvrt_compliance.study.named import Named


class Tested(NamedTuple):
    """A test that is finished."""

    profile: Profile
    test: TestCase
    result: TestResult
    made: Any = None  # what was made of its record; None where there is none
    is_reused: bool = False  # whether the record is one of an earlier run


@dataclass(frozen=True, kw_only=True)
class Keeping:
    """Where records are kept while a run is under way.

    Parameters
    ----------
    staging : Path
        Folder that is written to; records go into a folder of it.
    folder : Path
        Where that is placed in the end: what messages name.
    created : datetime
        Instant of t = 0.
    csv : bool
        Whether records are written as CSV, too.
    """

    staging: Path
    folder: Path
    created: datetime
    csv: bool = False


@dataclass(frozen=True, kw_only=True)
class Work:
    """A job, and what is done with each of its tests. Plain data: it goes to another process as it is.

    Parameters
    ----------
    job : Job
        What is to be run.
    each : Named, optional
        Makes something of every judged record where that is, for instance its figure.
    keeping : Keeping, optional
        Where records are kept; without, they are not.
    allow_unjudged : bool
        Whether a test of which nothing is judged lets a run go on that ends at the first failure.
    """

    job: Job
    each: Named | None = None
    keeping: Keeping | None = None
    allow_unjudged: bool = False

    def is_a_failure(self, result: TestResult) -> bool:
        """Whether a test keeps the run from ending with status 0."""
        if self.job.baseline is not None:
            result = with_baseline(result, self.job.baseline)
        return counts_for(result, allow_unjudged=self.allow_unjudged) in UNSETTLED

    def ends_with(self, result: TestResult) -> bool:
        """Whether the run ends with this test."""
        return self.job.fail_fast and self.is_a_failure(result)
