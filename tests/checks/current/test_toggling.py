"""Support that toggles, on both sides of each level and of its limit."""

import numpy as np
import pytest

from pvlvrt_compliance.checks.current.toggling import activations
from pvlvrt_compliance.results import Status

TOGGLING = {
    "clause": "2.3",
    "source": "a test",
    "on_pu": 0.15,
    "off_pu": 0.05,
    "most_activations": 1,
    "settling_s": 0.1,
}


def pulses(times, level_kvar=100.0):
    """Reactive power in pulses of 60 ms that begin at times after the start."""
    return lambda t: level_kvar * sum(((t > at) & (t < at + 0.06)) * 1.0 for at in times)


@pytest.mark.parametrize(
    ("times", "count"),
    [([], 0), ([0.3], 1), ([0.2, 0.4], 2), ([0.02, 0.3], 1), ([0.2, 0.4, 0.6], 3), ([0.3, 1.2], 1), ([1.2, 1.4], 2)],
)
def test_activations_between_two_steps(bench, profile_with, times, count):
    """Each stretch between steps of the voltage counts alone, what follows a step within the settling time does not."""
    made = bench(
        depth=0.2, duration_s=0.9, profile=profile_with("toggling", TOGGLING), p_sag_kw=100, q_kvar=pulses(times)
    )
    check = made.check("toggling")
    assert check.measured == count
    assert check.status is (Status.PASS if count <= 1 else Status.FAIL)
    assert check.margin == 1 - count
    if count > 1:
        assert check.at_s == pytest.approx(0.3 + times[1], abs=0.02)


@pytest.mark.parametrize(("level_kvar", "count"), [(0.155 * 0.8 * 500, 2), (0.145 * 0.8 * 500, 0)])
def test_level_that_is_on(bench, profile_with, level_kvar, count):
    """Reactive current up to the level is not on."""
    made = bench(depth=0.2, duration_s=0.9, profile=profile_with("toggling", TOGGLING), p_sag_kw=100,
                 q_kvar=pulses([0.3, 0.5], level_kvar))  # fmt: skip
    assert made.check("toggling").measured == count


@pytest.mark.parametrize(("rest_pu", "count"), [(0.045, 1), (0.055, 0)])
def test_level_that_is_off(bench, profile_with, rest_pu, count):
    """What has not been below the lower level was never off."""
    rest = rest_pu * 0.8 * 500
    made = bench(depth=0.2, duration_s=0.9, profile=profile_with("toggling", TOGGLING), p_sag_kw=100,
                 q_kvar=lambda t: np.where((t > 0.2) & (t < 0.5), rest, 100.0))  # fmt: skip
    check = made.check("toggling")
    assert check.measured == count


def test_nothing_toggles_without_a_step(bench, profile_with):
    """A test that leaves the voltage alone is not judged."""
    made = bench(depth=0, duration_s=0.9, profile=profile_with("toggling", TOGGLING), p_sag_kw=500)
    assert made.check("toggling").status is Status.NOT_APPLICABLE


def test_hysteresis_of_a_sequence():
    """Between the levels the state stays as it was."""
    current = np.array([0.3, 0.1, 0.2, 0.0, 0.1, 0.2, 0.1, 0.2, 0.0, 0.16])
    assert activations(current, 0.15, 0.05).tolist() == [5, 9]
