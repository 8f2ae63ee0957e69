"""What runs have in common: the state that they settle to, and their record up to where they part."""

import hashlib
import json
import math
from collections import OrderedDict
from collections.abc import Callable, Iterable
from itertools import pairwise
from typing import Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.scenario.events import Harmonic, Recording
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.scenario.timeline import entries, irradiance_points
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.recorder import RecordingPlan

LONGEST_S = 2.0
"""Up to here a record may be one of several runs (s): chosen, as all of its control periods are kept, 9 MB."""

_MOST_KEPT = 16  # chosen: what of each is kept takes a few megabytes

_LATER = frozenset({"sag", "duration_s", "after_s", "events", "vector_group"})
"""Fields of a scenario that decide nothing before it departs from normal operation but by what is looked at here."""


class CommonStart(NamedTuple):
    """Where a run parts from others."""

    key: str  # of those with the same nothing differs before
    begin: int  # first control period of which a row may be kept: 0, or that of the settling
    period: int  # up to which they are one

    @property
    def plan(self) -> RecordingPlan:
        """Plan of a run up to there, of which every row may be wanted."""
        return RecordingPlan(first=np.array([self.begin, self.period]), step=np.array([1]))


def common_start(
    scenario: Scenario, parameters: Parameters, period_s: float, settling: int, ratio: int = 1
) -> CommonStart | None:
    """Where a run parts from others that start as it does; None where it does so at once.

    Parameters
    ----------
    scenario : Scenario
    parameters : Parameters
    period_s : float
        Length of a control period (s).
    settling : int
        Periods before the record.
    ratio : int
        Periods from one sample of the controller to the next: the common part ends with a sample.
    """
    grid, irradiance = entries(scenario), irradiance_points(scenario)
    departures = [entry.t_s for entry in grid[1:]] + [t for t, _ in irradiance[1:]]
    departures += [scenario.start_s + event.t_s for event in scenario.events if isinstance(event, Recording)]
    period = math.floor(min([*departures, LONGEST_S]) / period_s) - 1  # one less: whatever rounding says
    period -= (period + settling) % ratio
    if period <= 0:
        return None
    levels = [level for _, level in irradiance]
    parts = [
        repr(grid[0]),
        [event.model_dump(mode="json") for event in scenario.events if isinstance(event, Harmonic)],
        [levels[0], min(levels), max(levels)],  # what there may come to be is what a controller is told by
        scenario.model_dump(mode="json", exclude=set(_LATER)),
        parameters.model_dump(mode="json"),
        [period_s, settling, ratio, period],
    ]
    key = hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()
    return CommonStart(key, -settling if parameters.simulation.record_settling else 0, period)


class Parted(NamedTuple):
    """A plan, in two."""

    before: tuple[range, ...]  # periods of the rows before, by stretch
    rest: RecordingPlan

    @property
    def rows(self) -> int:
        """How many rows are before."""
        return sum(map(len, self.before))

    def put(self, kept: NDArray[np.float64], begin: int, rows: NDArray[np.float64]) -> None:
        """Write the first rows of a record from those of every period from ``begin`` on; shapes (n, columns)."""
        row = 0
        for periods in self.before:
            taken = slice(periods.start - begin, periods.stop - begin, periods.step)
            rows.T[:, row : row + len(periods)] = kept.T[:, taken]
            row += len(periods)


def parted(plan: RecordingPlan, period: int) -> Parted:
    """Part a plan at a control period that is before its end."""
    before, first, step = [], [], []
    for (begin, end), N in zip(pairwise(plan.first.tolist()), plan.step.tolist(), strict=True):
        rows = range(begin, end, N)
        early = range(begin, min(end, period), N)
        if early:
            before.append(early)
        if len(early) < len(rows):
            first.append(rows[len(early)])
            step.append(N)
    ends = [*first, int(plan.first[-1])]
    return Parted(tuple(before), RecordingPlan(np.array(ends, dtype=np.int64), np.array(step, dtype=np.int64)))


Kept = TypeVar("Kept")


class CommonStarts(Generic[Kept]):
    """What is kept of the starts that runs have in common, each made once.

    Parameters
    ----------
    keys : iterable of str
        Of the runs to come, as far as they are known: what only one of them starts from is not kept.
    """

    def __init__(self, keys: Iterable[str] = ()) -> None:
        self._left: dict[str, int] = {}
        for key in keys:
            self._left[key] = self._left.get(key, 0) + 1
        self._kept: OrderedDict[str, Kept | None] = OrderedDict()

    def of(self, start: CommonStart | None, make: Callable[[CommonStart], Kept | None]) -> Kept | None:
        """What a run can go on from, made now if it is not there yet; None where it begins at the beginning."""
        if start is None:
            return None
        left = self._left.get(start.key, 0)
        self._left[start.key] = left - 1
        if start.key not in self._kept:
            if left < 2:
                return None
            self._kept[start.key] = make(start)
        self._kept.move_to_end(start.key)
        found = self._kept[start.key]
        while len(self._kept) > _MOST_KEPT:
            self._kept.popitem(last=False)
        if left == 1:
            self._kept.pop(start.key, None)
        return found
