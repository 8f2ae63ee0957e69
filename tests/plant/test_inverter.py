import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.plant import inverter

vectors = st.complex_numbers(max_magnitude=2e3)


@given(st.complex_numbers(max_magnitude=10), vectors, st.floats(0, 1100))
def test_the_bridge_loses_no_power(in_python, m, i, v_dc):
    """What leaves the DC link enters the line: v_DC i_DC = Re(u_inv conj(i))."""
    bridge = in_python(inverter.modulated)(m, i, v_dc)
    assert bridge.u == pytest.approx(2 / 3 * v_dc * m)
    assert bridge.i_dc * v_dc == pytest.approx((bridge.u * i.conjugate()).real, rel=1e-9, abs=1e-6)


@given(st.complex_numbers(max_magnitude=1e3))
def test_the_linear_range_ends_at_the_link_over_root_two(in_python, m):
    """However large the modulating signal, |u_inv| <= v_DC / sqrt(2)."""
    limited = in_python(inverter.limit_modulation)(m)
    assert abs(in_python(inverter.modulated)(limited, 0j, 834.0).u) <= 834 / math.sqrt(2) * (1 + 1e-12)
