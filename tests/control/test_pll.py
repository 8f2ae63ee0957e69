"""The blocks that the phase-locked loops are made of, against their transfer functions."""

import cmath
import math

import numba
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.control import dsc_pll, pll, srf_pll
from pvlvrt_compliance.sogi import SogiState
from pvlvrt_compliance.vectors import Rotation

W = 2 * math.pi * 50
T_REG = 40.9568e-6
U = math.sqrt(3) * 230


def follow(step, angle, n, p):
    """Angle by which the frame of a loop is off, from a start ``angle`` (rad) behind a steady vector; shape (n,)."""
    x = pll.PllState(theta=0.0, w=W)
    off = np.empty(n)
    for k in range(n):
        off[k] = cmath.phase(cmath.exp(1j * (angle + W * k * T_REG - x.theta)))
        x = step(x, U * cmath.exp(1j * off[k]), p, T_REG)
    return off


@pytest.mark.parametrize(("bandwidth_hz", "damping"), [(10, 2**-0.5), (20, 0.9), (5, 0.5)])
def test_a_small_jump_of_the_angle_decays_as_designed(in_python, bandwidth_hz, damping):
    """The error follows s^2 / (s^2 + 2 zeta w_n s + w_n^2), to the first order of the sample time."""
    p = pll.design(bandwidth_hz, damping, 40, 70, U)
    w_n = 2 * math.pi * bandwidth_hz
    w_d = w_n * math.sqrt(1 - damping**2)
    t = T_REG * np.arange(3000)
    ratio = damping / math.sqrt(1 - damping**2)
    expected = np.exp(-damping * w_n * t) * (np.cos(w_d * t) - ratio * np.sin(w_d * t))
    found = follow(in_python(pll.pll_step), 0.01, len(t), p) / 0.01
    assert np.abs(found - expected).max() < 2 * w_n * T_REG


@given(st.floats(-math.pi, math.pi), st.floats(0, 2 * math.pi * 100), st.complex_numbers(max_magnitude=1e6))
def test_the_frame_stays_on_the_circle_and_the_frequency_in_its_guard(in_python, theta, w, u):
    """Whatever it sees, the angle stays within a turn and the estimate within 40 to 70 Hz."""
    p = pll.design(10, 0.7, 40, 70, U)
    x = in_python(pll.pll_step)(pll.PllState(theta=theta, w=w), u, p, T_REG)
    assert -math.pi <= x.theta <= math.pi
    assert p.w_min <= x.w <= p.w_max


@pytest.mark.parametrize("K", [2**0.5, 0.5])
@pytest.mark.parametrize("w", [0.0, 0.2 * W, 2 * W, -2 * W, 6 * W])
def test_the_notch_has_its_transfer_function(in_python, K, w):
    """(s^2 + (2w)^2) / (s^2 + K (2w) s + (2w)^2): all of what stands, nothing of what turns at 2w."""
    T = 1e-7
    step, turn = in_python(srf_pll.band_step), Rotation(c=math.cos(2 * W * T), s=math.sin(2 * W * T))
    columns = [step(SogiState(u=1 + 0j, qu=0j), 0j, K, turn), step(SogiState(u=0j, qu=1 + 0j), 0j, K, turn)]
    driven = step(SogiState(u=0j, qu=0j), 1 + 0j, K, turn)
    A = np.array([[c.u for c in columns], [c.qu for c in columns]])
    band = np.linalg.solve(cmath.exp(1j * w * T) * np.eye(2) - A, [driven.u, driven.qu])[0]
    s = 1j * w
    expected = (s**2 + 4 * W**2) / (s**2 + K * 2 * W * s + 4 * W**2)
    assert 1 - band == pytest.approx(expected, abs=1e-3 if abs(w) != 2 * W else 1e-6)


@given(st.floats(1.0, 140.0), st.integers(0, 155), st.complex_numbers(max_magnitude=1e3))
def test_a_delay_reads_between_samples(in_python, samples, k, slope):
    """A signal on a straight line comes back as it was, by a delay of any length, wherever the ring begins."""
    n = dsc_pll.samples_of_line(2 * math.pi * 40, T_REG)
    line = np.empty(n, complex)
    for back in range(n):
        line[(k - back) % n] = slope * -back
    found = in_python(dsc_pll.delayed)(line, k % n, samples)
    assert found == pytest.approx(-slope * samples, abs=1e-9 * (abs(slope) * n + 1))


@numba.njit
def _delayed(line, k, samples):
    return dsc_pll.delayed(line, k, samples)


@pytest.mark.skipif(bool(numba.config.DISABLE_JIT), reason="no number is an index only when compiled")
@pytest.mark.parametrize("samples", [math.nan, math.inf, -math.inf, -5.0, 0.0, 1e9])
@pytest.mark.parametrize("k", [0, 154])
def test_no_delay_reads_outside_the_line(k, samples):
    """A number that is none, or no delay of this line, still reads a place of it: beside it stand other numbers."""
    memory = np.full(1155, 7.0 + 0j)
    memory[500:655] = 1
    found = _delayed(memory[500:655], k, samples)
    assert found == 1 or (math.isnan(samples) and cmath.isnan(found))


def test_the_ring_holds_a_quarter_of_the_slowest_cycle():
    """At 40 Hz and the default sample time a quarter of a cycle is 152.6 samples."""
    assert dsc_pll.samples_of_line(2 * math.pi * 40, T_REG) == math.ceil(0.25 / 40 / T_REG) + 2
