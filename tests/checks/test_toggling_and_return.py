"""Support that toggles, and the state at the end, each on both sides of its limit."""

import numpy as np
import pytest

from pvlvrt_compliance.checks.results import Status
from pvlvrt_compliance.checks.toggling import activations

TOGGLING = {
    "clause": "2.3",
    "source": "a test",
    "on_pu": 0.15,
    "off_pu": 0.05,
    "most_activations": 1,
    "settling_s": 0.1,
}
RETURN = {"clause": "5.11", "source": "a test", "active_fraction": 0.05, "reactive_fraction": 0.02}


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


@pytest.mark.parametrize(
    ("p_kw", "q_kvar", "status"),
    [
        (500 - 24, 0, Status.PASS),
        (500 - 26, 0, Status.FAIL),
        (500 + 26, 0, Status.FAIL),
        (500, 9.9, Status.PASS),
        (500, -10.1, Status.FAIL),
        (500 - 26, -9, Status.FAIL),
    ],
)
def test_return_to_prefault(bench, profile_with, p_kw, q_kvar, status):
    """P and Q must come back within their fractions of rated power; the one with the least margin is told."""
    made = bench(
        profile=profile_with("return_to_prefault", RETURN), p_after_kw=p_kw, q_kvar=lambda t: q_kvar * (t > 0.6)
    )
    check = made.check("return_to_prefault")
    assert check.status is status, check.message
    assert check.message.startswith("Q" if abs(q_kvar) > 5 and abs(p_kw - 500) < 20 else "P")


@pytest.mark.parametrize(
    "event",
    [
        {"kind": "irradiance", "t_s": 0.1, "to_w_m2": 800},
        {"kind": "voltage_profile", "points": [(0.0, 1.0), (0.5, 0.85)]},
        {"kind": "frequency_step", "t_s": 0.5, "to_hz": 50.5},
    ],
)
def test_tests_that_end_elsewhere(bench, profile_with, event):
    """Where the test itself does not come back, the inverter need not."""
    made = bench(
        depth=0, profile=profile_with("return_to_prefault", RETURN), scenario={"events": [event]}, p_sag_kw=500
    )
    assert made.check("return_to_prefault").status is Status.NOT_APPLICABLE


def test_record_without_an_end(bench, profile_with):
    """A record too short for the window after the sag is not evaluated."""
    made = bench(profile=profile_with("return_to_prefault", RETURN), scenario={"after_s": 0.5})
    assert made.check("return_to_prefault").status is Status.NOT_EVALUATED
