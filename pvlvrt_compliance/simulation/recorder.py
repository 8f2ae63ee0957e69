"""Which control periods of a run are recorded: all where something happens, every Nth elsewhere."""

import math
from collections.abc import Iterable
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import kernel

SHORT_RECORD_S = 5.0
"""Records shorter than this (s) hold every control period."""

BEFORE_S, AFTER_S = 0.35, 1.5
"""Every control period is recorded this long before and after whatever happens (s), and this long before the end."""

MOST_ROWS = 500_000
"""Rows that a record is kept to, as far as `LEAST_RATE_HZ` allows: 24 channels of them are 0.10 GB."""

THIN_RATE_HZ = 3000.0
"""Samples a second that are left elsewhere, at least ..."""

LEAST_RATE_HZ = 8.5 * 60.0
"""... but in very long records, which keep eight samples of a cycle at 60 Hz."""

_SHORTEST_THIN_S = 0.5  # a stretch of fewer samples that is shorter is not worth a change of step

Busy = tuple[float, float]
"""Begin and end (s)."""


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

    Every period where that takes less than `SHORT_RECORD_S`, else `THIN_RATE_HZ`.
    """
    step = 1 if periods * T_reg < SHORT_RECORD_S else max(int(1 / (THIN_RATE_HZ * T_reg)), 1)
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
    if periods * T_reg < SHORT_RECORD_S:
        return every_period(periods)
    end_s = periods * T_reg
    dense = _joined([(begin - BEFORE_S, end + AFTER_S) for begin, end in [*busy, (end_s, end_s)]], end_s)
    N = _thinning(sum(end - begin for begin, end in dense), periods, T_reg)
    bounds = [(math.floor(begin / T_reg / N) * N, math.ceil(end / T_reg / N) * N) for begin, end in dense]
    return _plan([(begin, min(end, periods)) for begin, end in bounds], periods, N)


def _joined(stretches: list[Busy], end_s: float) -> list[Busy]:
    """Stretches within the record in order of time, in one where they come near each other."""
    found: list[Busy] = []
    inside = [(max(begin, 0.0), min(end, end_s)) for begin, end in stretches if begin < end_s and end > 0]
    for begin, end in sorted(inside):
        last_end = found[-1][1] if found else 0.0
        if begin - last_end >= _SHORTEST_THIN_S:
            found.append((begin, end))
        elif found:
            found[-1] = (found[-1][0], max(last_end, end))
        else:
            found.append((0.0, end))
    return found


def _thinning(dense_s: float, periods: int, T_reg: float) -> int:
    """N: every how many-th period is recorded where nothing happens."""
    usual, most = (max(int(1 / (rate * T_reg)), 1) for rate in (THIN_RATE_HZ, LEAST_RATE_HZ))
    dense = dense_s / T_reg
    left = MOST_ROWS - dense
    needed = math.ceil((periods - dense) / left) if left > 0 else most
    return min(max(usual, needed), most)


def _plan(dense: list[tuple[int, int]], periods: int, N: int) -> RecordingPlan:
    first, step = [], []
    before = 0
    for begin, end in dense:
        if begin > before:
            first.append(before)
            step.append(N)
        first.append(begin)
        step.append(1)
        before = end
    return RecordingPlan(first=np.array([*first, periods], dtype=np.int64), step=np.array(step, dtype=np.int64))


@kernel
def next_row(stretch: int, n: int, plan: RecordingPlan) -> tuple[int, int]:
    """Stretch and control period of the row that follows the one of period ``n``, which lies in ``stretch``."""
    after = n + plan.step[stretch]
    if after < plan.first[stretch + 1]:
        return stretch, after
    return stretch + 1, plan.first[stretch + 1]
