import cmath
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.plant import line

L, R, T_S = 0.15e-3, 1e-3, 5.1196e-6
voltages = st.complex_numbers(max_magnitude=1e3)


@given(voltages, voltages, voltages, st.sampled_from([0.0, 1e-3, 0.5]), st.floats(1e-6, 1e-3))
def test_a_step_is_the_exact_solution(in_python, i, u_inv, e, resistance, T):
    """Under constant voltages the current is i0 exp(-Rt/L) + (u/R)(1 - exp(-Rt/L)), at any step."""
    p = line.design(L, resistance, 0.0, 0.0, T)
    u = u_inv - e
    if resistance:
        decay = math.exp(-resistance * T / L)
        expected = i * decay + u / resistance * (1 - decay)
    else:
        expected = i + u * T / L
    assert in_python(line.line_step)(i, u_inv, e, p) == pytest.approx(expected, rel=1e-9, abs=1e-6)


def test_many_steps_are_one_long_step(in_python):
    """Steps compose: a hundred of one hundredth are one."""
    fine, coarse = (line.design(L, R, 5e-5, 3e-3, T) for T in (T_S, 100 * T_S))
    step = in_python(line.line_step)
    i = 100 + 20j
    for _ in range(100):
        i = step(i, 480 + 10j, 470j, fine)
    assert i == pytest.approx(step(100 + 20j, 480 + 10j, 470j, coarse), rel=1e-12)


@given(voltages, voltages, voltages, st.floats(0, 1e-3), st.floats(0, 0.1))
def test_the_voltage_between_filter_and_grid(in_python, i, u_inv, e, L_g, R_g):
    """u_PCC = e + R_g i + L_g di/dt, and seen from the inverter u_inv - R i - L di/dt: both are one voltage."""
    found = in_python(line.pcc_voltage)(i, u_inv, e, line.design(L, R, L_g, R_g, T_S))
    slope = (u_inv - e - (R + R_g) * i) / (L + L_g)
    assert found == pytest.approx(e + R_g * i + L_g * slope, abs=1e-9)
    assert found == pytest.approx(u_inv - R * i - L * slope, abs=1e-9)


@given(st.sampled_from([0.0, 1e-3, 0.5]), st.lists(st.floats(0, 1), min_size=1, max_size=5))
def test_parts_of_a_step_are_the_step(in_python, resistance, shares):
    """A step cut into parts of any lengths, under the same voltages, ends where the whole one ends."""
    p = line.design(L, resistance, 5e-5, 0.0, T_S)
    i = 100 + 20j
    for share in (*shares, max(1 - sum(shares), 0.0)):
        i = in_python(line.line_part)(i, 480 + 10j, 470j, share, p)
    T = T_S * max(sum(shares), 1.0)
    whole = in_python(line.line_step)(100 + 20j, 480 + 10j, 470j, line.design(L, resistance, 5e-5, 0.0, T))
    assert i == pytest.approx(whole, rel=1e-9)


def test_a_stiff_grid_is_the_source_itself(in_python):
    """Without grid impedance neither current nor inverter move the voltage at the terminals."""
    p = line.design(L, R, 0.0, 0.0, T_S)
    assert in_python(line.pcc_voltage)(1000j, 700 + 0j, 398 + 5j, p) == 398 + 5j


def test_the_settled_current_is_that_of_phasors(in_python):
    """Under a sinusoidal source the current settles to e / (R + jwL), within the second order of the step."""
    p, w = line.design(L, 0.1, 0.0, 0.0, T_S), 2 * math.pi * 50
    i = 0j
    steps = 8000
    for n in range(steps):
        i = in_python(line.line_step)(i, 100 * cmath.exp(1j * w * (n + 0.5) * T_S), 0j, p)
    assert i == pytest.approx(100 * cmath.exp(1j * w * steps * T_S) / complex(0.1, w * L), rel=1e-5)
