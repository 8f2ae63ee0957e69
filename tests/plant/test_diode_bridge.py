import cmath
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from pvlvrt_compliance.plant.diode_bridge import (
    blocked_dc_current,
    blocked_flow,
    blocked_voltage,
    conducting,
)
from pvlvrt_compliance.plant.line import design
from pvlvrt_compliance.vectors import Phases, phases_of, vector_of

L, T_S = 0.15e-3, 5.1196e-6
vectors = st.complex_numbers(max_magnitude=2e3)
LOSSLESS = design(L, 0.0, 0.0, 0.0, T_S)
VERY_LARGE = 1e9
"""Capacitance of a link whose voltage stays (F)."""


@pytest.fixture(scope="module")
def until(in_python):
    """Advance a blocked bridge for a time (s): ``until(t, i, v_dc, e=..., C=..., i_pv=...) -> (i, v_dc)``."""
    step = in_python(blocked_flow)

    def run(t, i, v_dc, e=0j, C=VERY_LARGE, i_pv=0.0, v_drop=0.0, w=0.0):
        for n in range(round(t / T_S)):
            source = e * cmath.exp(1j * w * (n + 0.5) * T_S)
            found = step(i, v_dc, i_pv, source, LOSSLESS, C, T_S, v_drop)
            i, v_dc = found.i, found.v_dc
        return i, v_dc

    return run


@given(vectors, st.complex_numbers(max_magnitude=500), st.floats(600, 1100))
def test_the_link_takes_what_the_line_gives(in_python, i, e, v_dc):
    """While all three phases carry current, v_DC i_DC = Re(u_inv conj(i)) <= 0: the bridge loses no power."""
    if min(map(abs, in_python(phases_of)(i))) < 1e-3:
        return
    u = in_python(blocked_voltage)(i, e, v_dc, 0.0)
    power = (u * i.conjugate()).real
    assert power <= 0
    assert in_python(blocked_dc_current)(i) * v_dc == pytest.approx(power, rel=1e-9, abs=1e-6)


@pytest.mark.parametrize(("back", "share"), [((-0.5, -0.5), 2 / 3), ((-1.0, 0.0), 1 / 2)])
def test_a_current_ends_against_the_link(in_python, until, back, share):
    """Without a source a current falls with share v_DC / L to nothing, and stays there."""
    i0 = in_python(vector_of)(Phases(1000.0, *(1000.0 * x for x in back)))
    v = 800.0
    ends = 1000.0 * L / (share * v)
    half = in_python(phases_of)(until(ends / 2, i0, v)[0]).a
    assert half == pytest.approx(1000 * (1 - round(ends / 2 / T_S) * T_S / ends), rel=1e-9)
    assert until(ends - 2 * T_S, i0, v)[0] != 0
    assert until(ends + T_S, i0, v)[0] == 0
    assert until(2 * ends, i0, v)[0] == 0


def test_phases_end_one_after_another(in_python, until):
    """The smallest current ends first; the other two go on against each other, and the charge reaches the link."""
    i0 = in_python(vector_of)(Phases(900.0, -800.0, -100.0))
    C, v0 = 10e-3, 800.0
    first = 100 * L / (v0 / 3)  # b and c rise against a with a third of the link each
    i, _ = until(1.05 * first, i0, v0)
    a, b, c = in_python(phases_of)(i)
    assert (c, a) == pytest.approx((0.0, -b), abs=1e-9)
    assert a == pytest.approx(
        900 - first * 2 / 3 * v0 / L - (round(1.05 * first / T_S) * T_S - first) * v0 / 2 / L, rel=1e-3
    )
    energy = 0.5 * L * abs(i0) ** 2
    i, v = until(5e-4, i0, v0, C=C)
    assert i == 0
    # Second order in the step, hence not to rounding.
    assert 0.5 * C * (v**2 - v0**2) == pytest.approx(energy, rel=2e-3)


@pytest.mark.parametrize(("above", "conducts"), [(1.01, False), (0.99, True)])
def test_it_rectifies_only_above_the_link(until, above, conducts):
    """No current begins while the line-to-line peak is below v_DC; above it, one does."""
    u = 398.4
    found = until(0.02, 0j, above * math.sqrt(2) * u, e=complex(u), w=2 * math.pi * 50)[0]
    peaks = [abs(until(t, 0j, above * math.sqrt(2) * u, e=complex(u), w=2 * math.pi * 50)[0]) for t in (0.004, 0.0083)]
    assert (found != 0 or max(peaks) > 0) is conducts


@given(st.floats(0, 2 * math.pi), st.floats(100, 800))
def test_the_drop_is_the_links_for_two_diodes(in_python, angle, v_drop):
    """A drop of the devices acts as twice as much link voltage between two phases."""
    e = 398.4 * cmath.exp(1j * angle)
    with_drop, without = (
        in_python(blocked_voltage)(0j, e, v, d) for v, d in ((400.0, v_drop), (400.0 + 2 * v_drop, 0.0))
    )
    assert with_drop == without


@given(vectors, st.complex_numbers(max_magnitude=600), st.floats(0, 900), st.floats(-800, 800))
def test_no_current_reverses_in_a_step(in_python, i, e, v_dc, i_pv):
    """In a step each phase's current keeps its sign, ends, or begins from none; all sum to zero, all is finite."""
    found = in_python(blocked_flow)(i, v_dc, i_pv, e, LOSSLESS, 65e-3, T_S, 0.0)
    before, after = (in_python(phases_of)(x) for x in (i, found.i))
    for x, y in zip(before, after, strict=True):
        # One that ends within the step may begin the other way only where the source drives it.
        assert x * y >= 0 or abs(y) <= T_S / L * (abs(e) + v_dc)
    assert math.isfinite(found.v_dc + found.i.real + found.i.imag)
    assert found.v_dc >= 0


def test_an_ideal_rectifier_gives_the_textbook_voltage(until):
    """At little load the link stays at the peak of the line-to-line voltage; without a source, it falls."""
    for e, expected in ((398.4, math.sqrt(2) * 398.4), (0.0, 563.0 - 3 * 0.1 / 2e-3)):
        _, v = until(0.1, 0j, 563.0, e=complex(e), C=2e-3, i_pv=-3.0, w=2 * math.pi * 50)
        assert v == pytest.approx(expected, rel=0.01)


def test_it_is_what_an_integrator_with_soft_diodes_gives(in_python, until):
    """Scipy on three phases with legs of a steep but smooth characteristic: the same currents within 1 % of nominal."""
    e, v, i0 = 398.4, 420.0, in_python(vector_of)(Phases(600.0, -450.0, -150.0))
    w, end = 2 * math.pi * 50, 0.012

    def slopes(t, i):
        u = np.array([math.cos(w * t - k * 2 * math.pi / 3) for k in range(3)]) * e * math.sqrt(2 / 3)
        legs = -0.5 * v * np.tanh(i / 2.0)  # +-v/2 beyond a few amperes
        d = legs - u
        return (d - d.mean()) / L

    theirs = solve_ivp(slopes, (0, end), in_python(phases_of)(i0), method="Radau", rtol=1e-6, atol=1e-3).y[:, -1]
    n = round(end / T_S)
    ours = in_python(phases_of)(until(n * T_S, i0, v, e=complex(e), w=w)[0])
    assert np.abs(np.array(ours) - theirs).max() < 0.01 * 1025


def test_a_third_phase_joins_where_its_potential_leaves_the_link(in_python):
    """With a and b conducting, c's potential is 1.5 e_c against the middle of the link."""

    def diodes(e_c, v):
        return in_python(conducting)(Phases(100.0, -100.0, 0.0), Phases(-e_c / 2, -e_c / 2, e_c), v)

    assert diodes(199.0, 600.0).c == 0
    assert diodes(201.0, 600.0).c == 1
    assert diodes(-201.0, 600.0).c == -1
