"""Swings of P and Q after each step of the grid, against swings that are known."""

import math

import numpy as np
import pytest

from pvlvrt_compliance.results import Status

NUMBERS = {"limit_fraction": 0.05, "settling_s": 0.1, "array_settling_s": 0.2, "least_cycles": 2}
LIMIT_KW = 25.0
TWO_SAGS = {"events": [{"kind": "sag", "t_s": 0.8, "duration_s": 0.4, "sag": {"depth": 0.3}}]}
SIDES = [(0.99, Status.PASS), (1.01, Status.FAIL)]


def passed_on(frequency_hz: float) -> float:
    """What the mean of half a cycle of 50 Hz leaves of a sinusoid."""
    x = math.pi * frequency_hz * 0.01
    return math.sin(x) / x


def swinging(level_kw, size, from_s, to_s, frequency_hz=51.0, damping_ratio=0.0):
    """A level with a swing of so many times the limit as half-cycle means show it, between two instants."""
    amplitude = 0.5 * LIMIT_KW * size / passed_on(frequency_hz)
    w = 2 * np.pi * frequency_hz

    def power(t: np.ndarray) -> np.ndarray:
        since = t - from_s
        tone = amplitude * np.exp(-damping_ratio * w * since) * np.sin(w * since)
        return level_kw + np.where((t >= from_s) & (t < to_s), tone, 0.0)

    return power


@pytest.fixture
def swing(bench, demanding):
    """Make a record of sags at 0 and 0.8 s, of 0.4 s each, and judge it by this check."""

    def make(**settings):
        made = bench(
            duration_s=0.4, profile=demanding(oscillation=NUMBERS), scenario=TWO_SAGS | {"after_s": 1.5}, **settings
        )
        return made.check("oscillation")

    return make


@pytest.mark.parametrize(("size", "status"), SIDES)
@pytest.mark.parametrize(
    ("from_s", "to_s", "stretch"),
    [
        (0.05, 0.4, "first sag"),
        (0.45, 0.8, "first time of normal voltage"),
        (0.85, 1.2, "second sag"),
        (1.25, 1.9, "second time of normal voltage"),
    ],
)
@pytest.mark.parametrize("which", ["p_kw", "q_kvar"])
def test_each_stretch(swing, which, from_s, to_s, stretch, size, status):
    """A swing of P or Q is judged in each stretch, in gaps and after the last sag too, which the verdict names."""
    check = swing(**({"p_kw": lambda t: 480 + 0 * t} | {which: swinging(480, size, from_s, to_s)}))
    assert check.status is status, check.message
    assert check.measured == pytest.approx(size * LIMIT_KW, rel=4e-3)
    assert check.margin == pytest.approx(LIMIT_KW - check.measured)
    assert (check.bound, check.tolerance, check.limit, check.uncertainty) == ("at_most", 0, LIMIT_KW, 2.5)
    assert check.stretch.startswith(stretch)
    assert from_s < check.at_s - 0.3 < to_s


@pytest.mark.parametrize(("ratio", "words"), [(0.0, "undamped"), (0.02, "with a damping ratio of 0.02")])
def test_frequency_and_damping_are_told(swing, ratio, words):
    """What fails is told with its frequency and its damping."""
    check = swing(p_kw=swinging(480, 6, 1.25, 1.9, 39.0, ratio))
    assert check.status is Status.FAIL
    assert f"at 39 Hz, {words}," in check.message


def test_double_frequency_does_not_count(bench, demanding):
    """Negative-sequence current swings P at 2f, which half a cycle leaves out."""

    def negative(t: np.ndarray) -> np.ndarray:
        angle = 2 * np.pi * 50 * t + np.array([0, 2, -2])[:, np.newaxis] * np.pi / 3
        return 0.5 * np.cos(angle)

    check = bench(profile=demanding(oscillation=NUMBERS), extra_current_pu=negative, p_sag_kw=100.0).check(
        "oscillation"
    )
    assert check.measured == pytest.approx(0, abs=0.05)


@pytest.mark.parametrize("ramp_s", [0.3, 1.0])
def test_recovery_is_no_swing(bench, demanding, ramp_s):
    """P that comes back along a ramp after a sag does not swing."""
    made = bench(
        profile=demanding(oscillation=NUMBERS), p_after_kw=lambda t: 500 * np.minimum(t / ramp_s, 1), q_sag_kvar=250
    )
    check = made.check("oscillation")
    assert (check.status, check.measured) == (Status.PASS, pytest.approx(0, abs=1e-4))


@pytest.mark.parametrize(
    "event",
    [
        {"kind": "frequency_ramp", "t_s": 0, "rate_hz_s": 0.5, "duration_s": 0.6},
        {"kind": "voltage_profile", "points": [(0, 1), (0.6, 0.8)]},
        {"kind": "irradiance", "t_s": 0, "to_w_m2": 500, "ramp_s": 0.6},
    ],
)
def test_what_ramps_is_not_judged(bench, demanding, event):
    """While voltage, frequency or irradiance move a swing is no oscillation; afterwards it is."""
    made = lambda from_s, to_s: bench(  # noqa: E731
        depth=0,
        profile=demanding(oscillation=NUMBERS),
        scenario={"events": [event], "after_s": 1.5},
        p_kw=swinging(480, 6, from_s, to_s),
    ).check("oscillation")
    assert made(0.15, 0.5).status is Status.PASS
    assert made(0.85, 1.5).status is Status.FAIL


def test_up_to_a_trip(swing):
    """What swings before a trip has failed; what would follow it is not looked at."""
    check = swing(p_kw=swinging(480, 6, 0.05, 0.35), disconnected_after_s=0.36)
    assert check.status is Status.FAIL
    assert swing(p_kw=swinging(480, 6, 0.85, 1.2), disconnected_after_s=0.5).status is Status.PASS


def test_short_stretch(bench, demanding):
    """Where nothing settles for two cycles, nothing is judged."""
    settings = {"duration_s": 0.11, "scenario": {"after_s": 0.12}, "profile": demanding(oscillation=NUMBERS)}
    check = bench(**settings).check("oscillation")
    assert check.status is Status.NOT_APPLICABLE
    assert "less than 2 cycles" in check.message
