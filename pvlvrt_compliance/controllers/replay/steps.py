"""The step of a file beside the sample time of a controller: one is a whole multiple of the other, or it is refused."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.waveforms.container import Samples, Segment

_SLACK = 1e-4
"""Steps that differ by less, as a share, are the same (chosen): times in a file are rounded."""

SHORTEST_S, LONGEST_S = 1e-9, 1e6
"""Sample times of controllers that are fed (chosen): no plant has a part in it, so that a run may take fewer."""

MOST_CALLS = 20_000_000
"""Calls of a replay (chosen): half an hour at 100 us."""

_OFF = 0.05
"""What two instants that are the same may differ by, in steps (chosen)."""


class Steps(NamedTuple):
    """How rows of a file go with calls of a controller; one of the two is 1."""

    calls: int  # a row
    rows: int  # a call

    def spread(self, column: Samples) -> Samples:
        """A column as the controller sees it: a row held for its calls, or one row of several."""
        return np.repeat(column, self.calls) if self.calls > 1 else column[:: self.rows]

    def words(self, file: Path, step_s: float, sample_time_s: float) -> str:
        """What is done with the rows, where that is not one a call."""
        said = f"{file}: a row every {1e6 * step_s:g} us, the controller's sample time is {1e6 * sample_time_s:g} us"
        if self.calls > 1:
            return f"{said}: each row is held for {self.calls} samples"
        return f"{said}: one row of {self.rows} is taken" if self.rows > 1 else ""


def steps_of(file: Path, vectors: Segment, sample_time_s: float) -> Steps:
    """How the rows of a file go with the calls of a controller of this sample time (s).

    Raises
    ------
    UsageError
        When neither step is a whole multiple of the other, with both; when the sample time is none, or the calls are
        too many.
    """
    if not SHORTEST_S <= sample_time_s <= LONGEST_S:
        said = f"it must be from {SHORTEST_S:g} s to {LONGEST_S:g} s"
        raise UsageError(f"the controller's sample time is {sample_time_s:g} s; {said}")
    ratio = vectors.dt_s / sample_time_s
    calls, rows = max(round(ratio), 1), max(round(1 / ratio), 1)
    if calls * len(vectors) > MOST_CALLS:
        raise UsageError(f"{file}: {calls * len(vectors)} samples are too many; {MOST_CALLS} can be replayed at once")
    if abs(ratio - calls) <= _SLACK * calls:
        return Steps(calls, 1)
    if abs(1 / ratio - rows) <= _SLACK * rows:
        return Steps(1, rows)
    raise UsageError(
        f"{file}: a row every {1e6 * vectors.dt_s:g} us does not go with the controller's sample time,"
        f" {1e6 * sample_time_s:g} us: one must be a whole multiple of the other"
    )


class Meeting(NamedTuple):
    """Calls of a controller that rows of another file are of, shape (n,) each."""

    calls: NDArray[np.int64]
    rows: NDArray[np.int64]


def meeting(file: Path, vectors: Segment, t0_s: float, count: int, sample_time_s: float) -> Meeting:
    """Which calls the rows of a file are of, where the first of ``count`` calls is at a time (s).

    Raises
    ------
    UsageError
        When the steps do not go together, the instants lie between each other, or there is none in common.
    """
    steps = steps_of(file, vectors, sample_time_s)
    step_s = sample_time_s if steps.rows == 1 else vectors.dt_s
    ahead = (vectors.t0_s - t0_s) / step_s
    begin = round(ahead)
    if abs(ahead - begin) > _OFF:
        raise UsageError(
            f"{file}: begins at {vectors.t0_s:.9g} s, between two samples of the inputs, which begin at {t0_s:.9g} s"
            f" and are {1e6 * sample_time_s:g} us apart"
        )
    if steps.rows == 1:
        rows = np.arange(len(vectors))
        calls = begin + steps.calls * rows
    else:
        calls = np.arange(count)
        rows = steps.rows * calls - begin
    both = (calls >= 0) & (calls < count) & (rows >= 0) & (rows < len(vectors))
    if not both.any():
        raise UsageError(
            f"{file}: from {vectors.t0_s:.9g} s to {vectors.end_s:.9g} s, and the inputs from {t0_s:.9g} s to"
            f" {t0_s + (count - 1) * sample_time_s:.9g} s: no sample is in both"
        )
    return Meeting(calls[both], rows[both])
