import cmath
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.control.dc_voltage_regulator import (
    DcVoltageRegulatorState,
    dc_voltage_regulator_step,
    settled,
)
from pvlvrt_compliance.kernel import plain

V_REF = 800.0
step = plain(dc_voltage_regulator_step)


def test_phase_of_the_regulator_at_its_bandwidth(params):
    """atan(K_P w / K_I) = 63.5 degrees at 12.208 Hz, from the block's own pulse response."""
    p, T = params.dc_voltage, params.T
    offset = 100e3  # away from both limits, where the block is linear
    x = DcVoltageRegulatorState(integral=offset)
    outputs = []
    for n in range(3):
        x, P_ref, _ = step(x, V_REF + (1.0 if n == 0 else 0.0), V_REF, 1e9, p, T)
        outputs.append(P_ref - offset)
    direct, held = outputs[0], outputs[1]
    assert outputs[2] == pytest.approx(held)
    s = 2j * math.pi * 12.208
    gain = direct + held / (cmath.exp(s * T) - 1)
    assert math.degrees(cmath.phase(gain)) + 90 == pytest.approx(63.5, abs=0.1)


@pytest.mark.parametrize(("e", "limit"), [(100.0, 200e3), (-100.0, 0.0)])
def test_the_integral_does_not_wind_up(params, e, limit):
    """After long saturation P* leaves its limit in the first sample whose error goes back."""
    p, T = params.dc_voltage, params.T
    x = DcVoltageRegulatorState(integral=100e3)
    for _ in range(5000):
        x, P_ref, limited = step(x, V_REF + e, V_REF, 200e3, p, T)
        assert P_ref == limit
        assert limited == (e > 0)
    back = 0.9 * e
    _, P_ref, limited = step(x, V_REF + back, V_REF, 200e3, p, T)
    assert P_ref == pytest.approx(limit + p.K_P * (back - e) + p.K_I * e * T)
    assert not limited


@given(st.floats(-50, 50), st.floats(1e3, 400e3), st.floats(0, 400e3))
def test_lifting_the_limit_is_bumpless(params, e, low, start):
    """When a limit is lifted P* goes on from where it was: by K_I e T, not by a step."""
    p, T = params.dc_voltage, params.T
    x, before, _ = step(DcVoltageRegulatorState(integral=start), V_REF + e, V_REF, low, p, T)
    _, after, _ = step(x, V_REF + e, V_REF, 1e9, p, T)
    assert abs(after - before) <= p.K_I * abs(e) * T + 1e-6


@given(st.floats(700, 1000), st.floats(0, 500e3))
def test_the_settled_state_puts_out_what_it_was_settled_for(params, v_dc, P):
    """A run starts without a step of P*."""
    _, P_ref, limited = step(
        settled(P, v_dc, V_REF, params.dc_voltage), v_dc, V_REF, 600e3, params.dc_voltage, params.T
    )
    assert P_ref == pytest.approx(P, abs=1e-6)
    assert not limited


@given(st.floats(-1e3, 1e3), st.floats(-1e7, 1e7), st.floats(0, 500e3))
def test_power_stays_within_its_limits(params, e, integral, limit):
    """P* is never negative and never above its limit."""
    _, P_ref, _ = step(DcVoltageRegulatorState(integral=integral), V_REF + e, V_REF, limit, params.dc_voltage, params.T)
    assert 0 <= P_ref <= limit
