"""How far a series swings, how fast and with what damping, against signals whose numbers are known."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from draws import draws
from pvlvrt_compliance.measure.swing import swing, to_and_fro, tone

STEP_S = 1e-4


def sampled(seconds: float) -> tuple[np.ndarray, np.ndarray]:
    """Instants and how long each lasts."""
    t = STEP_S * np.arange(round(seconds / STEP_S))
    return t, np.full(len(t), STEP_S)


@pytest.mark.parametrize("slope", [-200.0, 0.0, 30.0])
def test_a_sinusoid_on_a_straight_line(slope):
    """Peak to peak is twice the amplitude, and no straight line changes it."""
    t, step = sampled(1.0)
    found = swing(t, 70 + slope * t + 20 * np.cos(2 * np.pi * 50 * t), step)
    # Half a period of a slope is missing from a rise, or a fall.
    assert found.peak_to_peak == pytest.approx(40 - abs(slope) / 100, rel=2e-3)
    assert found.mean == pytest.approx(70 + slope / 2, abs=0.5)


@pytest.mark.parametrize("course", [lambda t: np.where(t < 0.4, 0.0, 500.0), lambda t: 500 * (1 - np.exp(-t / 0.1))])
def test_what_goes_one_way_does_not_swing(course):
    """A step, and what settles without overshoot, are no swing, in either direction."""
    t, step = sampled(1.0)
    for sign in (-1, 1):
        assert swing(t, sign * course(t), step).peak_to_peak == pytest.approx(0, abs=1e-9)


def test_an_overshoot_counts_by_its_height():
    """Of a rise to 530 and a return to 500, 30 is to and fro."""
    assert to_and_fro(np.array([0.0, 300.0, 530.0, 510.0, 500.0, 500.0])) == pytest.approx(30)


def test_samples_count_as_long_as_they_last():
    """A straight line is found through samples of two steps."""
    t = np.concatenate([np.arange(0, 0.5, 1e-3), np.arange(0.5, 1.0, 1e-2)])
    step = np.concatenate([np.full(500, 1e-3), np.full(50, 1e-2)])
    assert swing(t, 3 * t, step).peak_to_peak == pytest.approx(0, abs=1e-9)
    assert swing(t, 3 * t, step).mean == pytest.approx(1.5, rel=1e-2)


@pytest.mark.parametrize("frequency_hz", [5.0, 39.0, 51.3])
@pytest.mark.parametrize("ratio", [-0.01, 0.0, 0.02])
def test_frequency_and_damping(frequency_hz, ratio):
    """A decaying, lasting or growing sinusoid is told by its own numbers."""
    t, step = sampled(1.0)
    decay = 2 * np.pi * frequency_hz * ratio / np.sqrt(1 - ratio**2)
    found = tone(t, 100 + np.exp(-decay * t) * 30 * np.cos(2 * np.pi * frequency_hz * t + 0.3), step)
    assert found.frequency_hz == pytest.approx(frequency_hz, abs=0.3)
    assert found.damping_ratio == pytest.approx(ratio, abs=3e-3)


def test_nothing_that_swings():
    """A constant, and a handful of samples, have no frequency."""
    t, step = sampled(0.5)
    assert tone(t, np.full(len(t), 3.0), step) is None
    assert tone(t[:20], np.cos(t[:20]), step[:20]) is None


@pytest.mark.parametrize("seed", range(5))
def test_to_and_fro_is_the_smaller_of_the_largest_rise_and_fall(seed):
    """Over all pairs of an earlier and a later sample."""
    x = np.random.default_rng(seed).normal(size=60).cumsum()
    rises = [later - earlier for k, earlier in enumerate(x) for later in x[k:]]
    assert to_and_fro(x) == pytest.approx(min(max(rises), -min(rises)), abs=1e-12)


def test_the_middle_of_a_swing_lies_between_its_extremes():
    """A sinusoid on a straight line, whose middle is that line."""
    t_s, step_s = sampled(1.0)
    found = swing(t_s, 3 + 2 * t_s + np.sin(2 * np.pi * 5 * t_s), step_s)
    assert found.ends == pytest.approx((3.0, 5.0), abs=0.5)


@given(
    st.integers(0, 2**32 - 1), st.sampled_from([1, 2, 255, 256, 257, 512, 1500, 9000]), st.sampled_from([-1, 0, 1, 3])
)
@draws(60)
def test_the_largest_rise_and_fall_are_those_between_any_two_samples(seed, count, digits):
    """However they lie, in one piece of the series or in several, and where many samples are equal."""
    x = np.round(np.random.default_rng(seed).normal(size=count).cumsum(), digits)
    rise, fall = (x - np.minimum.accumulate(x)).max(), (np.maximum.accumulate(x) - x).max()
    assert to_and_fro(x) == min(rise, fall)
    assert to_and_fro(np.full(count, x[0])) == 0.0
