"""The step of a file beside a sample time, and which rows meet which calls."""

from pathlib import Path

import numpy as np
import pytest

from pvlvrt_compliance.controllers.replay.steps import Steps, meeting, steps_of
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.waveforms.container import Segment

FILE = Path("x.csv")


def rows(count, dt_s, t0_s=0.0):
    """A file of so many rows."""
    return Segment(t0_s, dt_s, {"x": np.arange(count, dtype=float)})


@pytest.mark.parametrize(
    ("dt_s", "steps"),
    [
        (1e-4, Steps(1, 1)),
        (1.00001e-4, Steps(1, 1)),
        (3e-4, Steps(3, 1)),
        (1e-5, Steps(1, 10)),
        (1e-4 / 3, Steps(1, 3)),
    ],
)
def test_one_step_is_a_multiple_of_the_other(dt_s, steps):
    """Whichever is longer; what rounding of times makes of them counts as the same."""
    assert steps_of(FILE, rows(10, dt_s), 1e-4) == steps


@pytest.mark.parametrize("dt_s", [1.001e-4, 1.5e-4, 0.7e-4, 2.01e-4])
def test_all_else_is_refused(dt_s):
    """With both steps."""
    with pytest.raises(UsageError, match=r"x.csv: a row every .* us does not go with .* sample time, 100 us"):
        steps_of(FILE, rows(10, dt_s), 1e-4)


@pytest.mark.parametrize("sample_time_s", [0.0, -1e-4, 1e-300, float("nan"), float("inf")])
def test_what_is_no_sample_time_is_refused(sample_time_s):
    """Whoever says it, with what is allowed."""
    with pytest.raises(UsageError, match=r"sample time is .* s; it must be from 1e-09 s to 1e\+06 s"):
        steps_of(FILE, rows(10, 1e-4), sample_time_s)


def test_too_many_samples_are_refused():
    """Before memory is taken for them."""
    with pytest.raises(UsageError, match=r"x\.csv: 100000000000 samples are too many; 20000000 can be"):
        steps_of(FILE, rows(10, 1e6), 1e-4)


def test_what_is_done_is_told():
    """Nothing of one row a call."""
    assert Steps(1, 1).words(FILE, 1e-4, 1e-4) == ""
    assert Steps(4, 1).words(FILE, 4e-4, 1e-4).endswith("sample time is 100 us: each row is held for 4 samples")
    assert Steps(1, 4).words(FILE, 25e-6, 1e-4) == (
        "x.csv: a row every 25 us, the controller's sample time is 100 us: one row of 4 is taken"
    )


@pytest.mark.parametrize(
    ("count", "dt_s", "t0_s", "calls", "of_rows"),
    [
        (5, 1e-4, 0.0, [0, 1, 2, 3, 4], [0, 1, 2, 3, 4]),
        (3, 1e-4, 2e-4, [2, 3, 4], [0, 1, 2]),
        (9, 1e-4, -2e-4, [0, 1, 2, 3, 4], [2, 3, 4, 5, 6]),
        (3, 2e-4, 0.0, [0, 2, 4], [0, 1, 2]),
        (2, 2e-4, 1e-4, [1, 3], [0, 1]),
        (20, 5e-5, 0.0, [0, 1, 2, 3, 4], [0, 2, 4, 6, 8]),
        (5, 5e-5, 1.5e-4, [2, 3], [1, 3]),
    ],
)
def test_rows_meet_calls_at_the_same_instants(count, dt_s, t0_s, calls, of_rows):
    """Of five calls at 1 s and 100 us apart."""
    found = meeting(FILE, rows(count, dt_s, 1.0 + t0_s), 1.0, 5, 1e-4)
    assert (found.calls.tolist(), found.rows.tolist()) == (calls, of_rows)
    instants = 1.0 + 1e-4 * found.calls
    assert instants == pytest.approx(1.0 + t0_s + dt_s * found.rows, abs=1e-12)


@pytest.mark.parametrize(
    ("t0_s", "words"), [(3e-5, "between two samples"), (5e-3, "no sample is in both"), (-5e-3, "no sample is in both")]
)
def test_what_never_meets_is_refused(t0_s, words):
    """Instants in between, and files of another time."""
    with pytest.raises(UsageError, match=words):
        meeting(FILE, rows(5, 1e-4, t0_s), 0.0, 5, 1e-4)
