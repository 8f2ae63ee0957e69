"""Which control periods of a run are recorded: all where something happens, every Nth elsewhere."""

from collections.abc import Iterable
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.simulation.thinning import Busy, settling_step, stretches_of


class RecordingPlan(NamedTuple):
    """Stretches of a record: each holds its first control period and every ``step``-th from there."""

    first: NDArray[np.int64]  # first period of each stretch, then the number of periods; shape (stretches + 1,)
    step: NDArray[np.int64]  # periods from one row to the next; shape (stretches,)

    @property
    def rows(self) -> list[int]:
        """Rows of each stretch."""
        stretches = zip(pairwise(self.first.tolist()), self.step.tolist(), strict=True)
        return [len(range(begin, end, step)) for (begin, end), step in stretches]


def every_period(periods: int) -> RecordingPlan:
    """Plan of a record that holds every control period."""
    return RecordingPlan(first=np.array([0, periods]), step=np.array([1]))


def with_settling(plan: RecordingPlan, periods: int, T_reg: float) -> RecordingPlan:
    """Plan of a record and of at most so many control periods before it, in a stretch of its own up to period 0.

    Every period where that is short, else fewer (`thinning`).
    """
    step = settling_step(periods, T_reg)
    if periods < step:
        return plan
    before, step_before = np.array([-(periods // step) * step]), np.array([step])
    return RecordingPlan(
        first=np.concatenate([before, plan.first]).astype(np.int64),
        step=np.concatenate([step_before, plan.step]).astype(np.int64),
    )


def plan_of(busy: Iterable[Busy], periods: int, T_reg: float) -> RecordingPlan:
    """Plan of a record in which something happens in some stretches of time.

    All rows lie on one grid: every stretch but the last begins and ends at multiples of the same N periods, so that
    every Nth period is there from the first to the last.

    Parameters
    ----------
    busy : iterable of (s, s)
        When something happens, from the start of the record; an instant begins where it ends.
    periods : int
        Control periods of the record.
    T_reg : float
        Their length (s).
    """
    stretches = stretches_of(busy, periods, T_reg)
    first, step = [stretch.first for stretch in stretches], [stretch.step for stretch in stretches]
    return RecordingPlan(first=np.array([*first, periods], dtype=np.int64), step=np.array(step, dtype=np.int64))


@kernel
def next_row(stretch: int, n: int, plan: RecordingPlan) -> tuple[int, int]:
    """Stretch and control period of the row that follows the one of period ``n``, which lies in ``stretch``."""
    after = n + plan.step[stretch]
    if after < plan.first[stretch + 1]:
        return stretch, after
    return stretch + 1, plan.first[stretch + 1]
