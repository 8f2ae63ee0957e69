"""Runs of a controller from outside that go on from where one of them has settled, as far as that is the same."""

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.controllers.process.worker import RunJob
from pvlvrt_compliance.controllers.run import ForeignRecord
from pvlvrt_compliance.errors import PvlvrtError
from pvlvrt_compliance.simulation.common_start import CommonStart, CommonStarts, parted

Run = Callable[[RunJob], ForeignRecord]
"""Does a job; raises a `PvlvrtError` where there is no record."""

_EACH = "not settled once, each test settles for itself"


class SettledController(NamedTuple):
    """Where a run was as it parted from others, and all that it could have recorded before."""

    state: bytes  # `resting.Resting`, never unpacked but in the process of a controller
    samples: NDArray[np.float64]  # a row for every period from ``start.begin`` on
    start: CommonStart


class SettlesOnce:
    """Has runs go on from settled states, each simulated once.

    What a controller keeps elsewhere than where its door finds it is not in these. So the first run that could go on
    from one is made whole, too: unless both give the same to the bit, all runs are made whole. One that fails is made
    whole, so that it says what it would have said.

    Parameters
    ----------
    keys : iterable of str
        Of the runs to come (`CommonStarts`).
    tell : callable
        Is given why nothing is gone on from, once.
    """

    def __init__(self, keys: Iterable[str], tell: Callable[[str], None]) -> None:
        self._starts: CommonStarts[SettledController] = CommonStarts(keys)
        self._tell = tell
        self._is_sure = self._is_off = False
        self._failed = ""  # why a run that was to be put aside has ended

    def record(self, job: RunJob, start: CommonStart | None, run: Run) -> ForeignRecord:
        """Record of a job.

        Raises
        ------
        PvlvrtError
            When there is none, as of the whole run.
        """
        kept = None if self._is_off else self._starts.of(start, lambda start: self._settled(job, start, run))
        if kept is None:
            failed, self._failed = self._failed, ""
            whole = run(job)
            if failed:  # the whole run has not
                self._none(f"to put aside what it remembers has failed: {failed}")
            return whole
        if self._is_sure:
            return _gone_on(job, kept, run) or run(job)
        whole, found = run(job), _gone_on(job, kept, run)
        if found is not None and _are_one(whole, found):
            self._is_sure = True
        else:
            self._none(
                "what it remembers is not all where it can be taken from and put back (a test that went on from its"
                " settled state came out otherwise than in one run)"
            )
        return whole

    def _settled(self, job: RunJob, start: CommonStart, run: Run) -> SettledController | None:
        try:
            found = run(replace(job, plan=start.plan, keeps=True))
        except PvlvrtError as error:  # the test says why, if it fails as well
            self._failed = str(error)
            return None
        if found.state is None:
            self._none(found.stateless)
            return None
        return SettledController(found.state, found.samples, start)

    def _none(self, why: str) -> None:
        self._is_off = True
        self._tell(f"{_EACH}: {why}")


def _gone_on(job: RunJob, kept: SettledController, run: Run) -> ForeignRecord | None:
    """Record of a job that goes on from a settled state; none where that fails."""
    here = parted(job.plan, kept.start.period)
    try:
        found = run(replace(job, plan=here.rest, since=kept.state))
    except PvlvrtError:
        return None
    rows = np.empty((here.rows + len(found.samples), found.samples.shape[1]))
    here.put(kept.samples, kept.start.begin, rows)
    rows[here.rows :] = found.samples
    return found._replace(samples=rows)


def _are_one(a: ForeignRecord, b: ForeignRecord) -> bool:
    """Whether two records are the same to the bit, with all that goes with them."""
    return (
        (a.channels, a.notes, a.tripped_at_s) == (b.channels, b.notes, b.tripped_at_s)
        and a.samples.shape == b.samples.shape
        and np.array_equal(_bits(a.samples), _bits(b.samples))
    )


def _bits(samples: NDArray[np.float64]) -> NDArray[np.int64]:
    return np.ascontiguousarray(samples).view(np.int64)
