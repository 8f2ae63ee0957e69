import cmath
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.control.modulator import modulate

M_MAX = 3 / (2 * math.sqrt(2))


@given(st.complex_numbers(max_magnitude=1e6), st.floats(0, 1100))
def test_the_modulating_signal_stays_in_the_linear_range(in_python, params, m, v_dc):
    """|u_inv| = 2/3 v_DC |m| is at most v_DC/sqrt(2); the direction is kept, and small signals are untouched."""
    found = in_python(modulate)(m, 398 + 0j, v_dc, params.modulator)
    assert abs(found) <= M_MAX * (1 + 1e-12)
    if abs(m) < M_MAX:
        assert found == m
    else:
        assert cmath.isclose(found / M_MAX, m / abs(m), rel_tol=1e-9)


@pytest.mark.parametrize("v_dc", [700.0, 834.0, 1003.0])
def test_feedforward_alone_reproduces_the_grid_voltage(in_python, params, v_dc):
    """With feedforward and no error the inverter's voltage 2/3 v_DC m is the grid's."""
    u = cmath.rect(398.0, 0.7)
    m = in_python(modulate)(0j, u, v_dc, params.modulator._replace(feedforward=1.0))
    assert 2 / 3 * v_dc * m == pytest.approx(u)


def test_feedforward_without_dc_voltage_stays_limited(in_python, params):
    """No DC voltage is no division by zero."""
    assert abs(in_python(modulate)(0j, 398 + 0j, 0.0, params.modulator._replace(feedforward=1.0))) <= M_MAX * (
        1 + 1e-12
    )
