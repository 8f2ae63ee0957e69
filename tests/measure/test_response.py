import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from draws import draws
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.response import Tolerance, step_response

T_S = np.arange(-0.1, 1.0, 1e-4)
TEN = Tolerance(short=0.1, beyond=0.1)
levels = st.floats(-5, 5)


@given(levels, levels.filter(lambda x: abs(x) > 0.1), st.floats(0.005, 0.1))
@draws(40)
def test_a_first_order_lag(initial, change, tau):
    """10 % after tau ln(1/0.9), 90 % after tau ln 10, in the band from then on; up or down alike."""
    x = initial + change * np.where(T_S < 0, 0, 1 - np.exp(-T_S / tau))
    found = step_response(T_S, x, 0.0, initial, initial + change, TEN)
    assert found.reaction_s == pytest.approx(tau * np.log(1 / 0.9), abs=2e-6)
    assert found.response_s == pytest.approx(tau * np.log(10), abs=2e-6)
    assert found.rise_s == pytest.approx(tau * np.log(9), abs=4e-6)
    assert found.settling_s == found.response_s
    assert found.overshoot == 0


@pytest.mark.parametrize("damping", [0.2, 0.5])
def test_the_overshoot_of_a_second_order_lag(damping):
    """exp(-pi z / sqrt(1 - z^2)), and settled where the last swing enters the band."""
    w = 100.0
    wd, t = w * np.sqrt(1 - damping**2), np.maximum(T_S, 0)
    x = 1 - np.exp(-damping * w * t) * (np.cos(wd * t) + damping * w / wd * np.sin(wd * t))
    found = step_response(T_S, x, 0.0, 0.0, 1.0, Tolerance(0.05, 0.05))
    assert found.overshoot == pytest.approx(np.exp(-np.pi * damping / np.sqrt(1 - damping**2)), abs=1e-5)
    after = found.settling_s + 1e-4 < T_S
    assert np.abs(x[after] - 1).max() <= 0.05
    assert abs(np.interp(found.settling_s, T_S, x) - 1) == pytest.approx(0.05, abs=1e-6)


def test_the_band_may_be_asymmetric():
    """What stays 15 % beyond is settled in a band of +20 / -10 % and never in one of +10 / -20 %, up and down."""
    for sign in (1, -1):
        x = sign * np.where(T_S < 0.02, 0, 1.15)
        assert step_response(T_S, x, 0.0, 0.0, sign, Tolerance(0.1, 0.2)).settling_s == pytest.approx(0.02, abs=1e-4)
        assert step_response(T_S, x, 0.0, 0.0, sign, Tolerance(0.2, 0.1)).settling_s is None
        assert step_response(T_S, x, 0.0, 0.0, sign, Tolerance(0.1, 0.2)).overshoot == pytest.approx(0.15)


def test_what_never_gets_there():
    """Half of the change has a reaction and nothing else; none has not even that."""
    half = step_response(T_S, np.where(T_S < 0.1, 0.0, 0.5), 0.0, 0.0, 1.0, TEN)
    assert half.reaction_s == pytest.approx(0.1, abs=1e-4)
    assert (half.rise_s, half.response_s, half.settling_s, half.overshoot) == (None, None, None, 0)
    assert step_response(T_S, 0 * T_S, 0.0, 0.0, 1.0, TEN) == (None, None, None, None, 0)


def test_the_way_there_counts_from_the_event():
    """The event may lie anywhere; what was before it does not count, even where it had the final value."""
    x = np.where(T_S < 0.3, 1.0, np.where(T_S < 0.35, 0.0, 1.0))
    found = step_response(T_S, x, 0.3, 0.0, 1.0, TEN)
    assert found.response_s == pytest.approx(0.05, abs=2e-4)
    assert found.settling_s == pytest.approx(0.05, abs=2e-4)


def test_what_is_there_already():
    """A quantity that has its final value at the event and keeps it takes no time."""
    assert step_response(T_S, 1 + 0 * T_S, 0.0, 0.0, 1.0, TEN) == pytest.approx((0, 0, 0, 0, 0), abs=1e-4)


def test_what_cannot_be_measured():
    """No change, no record after the event, a gap in it, or a band without width."""
    with pytest.raises(MeasurementError, match="no change"):
        step_response(T_S, T_S, 0.0, 1.0, 1.0, TEN)
    with pytest.raises(MeasurementError, match="ends before"):
        step_response(T_S, T_S, 2.0, 0.0, 1.0, TEN)
    with pytest.raises(MeasurementError, match="not finite"):
        step_response(T_S, np.where(T_S > 0.5, np.nan, 0), 0.0, 0.0, 1.0, TEN)
    with pytest.raises(MeasurementError, match="no width"):
        step_response(T_S, T_S, 0.0, 0.0, 1.0, Tolerance(0, 0))


@pytest.mark.parametrize("after", [1, 4095, 4096, 9000])
def test_a_level_that_is_reached_late(after):
    """It is found wherever it is, and none that is never reached."""
    t_s = 1e-4 * np.arange(10_000)
    found = step_response(t_s, np.where(t_s < t_s[after] - 1e-9, 0.0, 0.95), 0.0, 0.0, 1.0, TEN)
    assert found.response_s == pytest.approx(t_s[after - 1] + 0.9 / 0.95 * 1e-4, abs=1e-9)
    assert step_response(t_s, np.full(len(t_s), 0.5), 0.0, 0.0, 1.0, TEN).response_s is None
