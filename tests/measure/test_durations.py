"""Statistics over time."""

import numpy as np
import pytest

from pvlvrt_compliance.measure.durations import is_one_step, mean_over_time, median_over_time


def test_samples_count_as_long_as_they_last():
    """One of three steps is as three of one."""
    x, step_s = np.array([5.0, 1.0, 2.0]), np.array([3.0, 1.0, 1.0])
    assert mean_over_time(x, step_s) == pytest.approx(18 / 5)
    assert median_over_time(x, step_s) == 5.0


@pytest.mark.parametrize("count", [1, 2, 9, 10])
def test_the_median_of_even_samples_is_the_one_in_the_middle(count):
    """Of an even number, the lower of the two there."""
    x = np.random.default_rng(count).permutation(count).astype(float)
    assert median_over_time(x, np.full(count, 0.5)) == (count - 1) // 2


def test_one_number_may_stand_for_the_step_of_all_samples():
    """Mean and median are those of as many equal steps, and a part of such steps is known for one, too."""
    x, step_s = np.random.default_rng(3).normal(size=1001), np.broadcast_to(4e-5, 1001)
    for part in (slice(None), slice(7, 400), slice(5, 6)):
        assert is_one_step(step_s[part])
        steps = np.full(len(x[part]), 4e-5)
        assert not is_one_step(steps)
        assert mean_over_time(x[part], step_s[part]) == pytest.approx(mean_over_time(x[part], steps), rel=1e-12)
        assert median_over_time(x[part], step_s[part]) == median_over_time(x[part], steps)
