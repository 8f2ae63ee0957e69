"""How much of a record is kept: every control period where something happens, fewer elsewhere. No kernel, no array."""

import math
from collections.abc import Iterable
from typing import NamedTuple

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

COLUMNS = 24
"""Channels of a record with the bundled controller (`columns.CHANNELS`, which takes a compiler to read)."""

MOST_BYTES = 2 << 30
"""What the samples of one record may take: chosen, for judging takes as much again, and a small machine has 8 GB."""

_SHORTEST_THIN_S = 0.5  # a stretch of fewer samples that is shorter is not worth a change of step

Busy = tuple[float, float]
"""Begin and end (s)."""


class Stretch(NamedTuple):
    """Control periods of a record: the first and every ``step``-th from there, up to ``end``, which is not of it."""

    first: int
    end: int
    step: int

    @property
    def rows(self) -> int:
        """How many are kept."""
        return len(range(self.first, self.end, self.step))


def stretches_of(busy: Iterable[Busy], periods: int, T_reg: float) -> list[Stretch]:
    """Stretches of a record, as `recorder.plan_of` describes them."""
    if periods * T_reg < SHORT_RECORD_S:
        return [Stretch(0, periods, 1)]
    end_s = periods * T_reg
    dense = _joined([(begin - BEFORE_S, end + AFTER_S) for begin, end in [*busy, (end_s, end_s)]], end_s)
    N = _thinning(sum(end - begin for begin, end in dense), periods, T_reg)
    bounds = [(math.floor(begin / T_reg / N) * N, math.ceil(end / T_reg / N) * N) for begin, end in dense]
    return _stretches([(begin, min(end, periods)) for begin, end in bounds], N)


def too_much(rows: int) -> str | None:
    """What so many rows of a record take, and what is allowed; None where that is not more."""
    size = 8 * COLUMNS * rows
    return None if size <= MOST_BYTES else f"{size / 2**30:.3g} GiB of samples; {MOST_BYTES >> 30} GiB are allowed"


def settling_step(periods: int, T_reg: float) -> int:
    """From one control period of a settling that is kept to the next."""
    return 1 if periods * T_reg < SHORT_RECORD_S else max(int(1 / (THIN_RATE_HZ * T_reg)), 1)


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


def _stretches(dense: list[tuple[int, int]], N: int) -> list[Stretch]:
    """The dense ones, and what is thinned out before each."""
    found = []
    before = 0
    for begin, end in dense:
        if begin > before:
            found.append(Stretch(before, begin, N))
        found.append(Stretch(begin, end, 1))
        before = end
    return found
