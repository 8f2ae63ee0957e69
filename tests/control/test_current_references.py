import cmath
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from draws import draws
from pvlvrt_compliance.control.current_references import current_references
from pvlvrt_compliance.control.lvrt import lvrt_step
from pvlvrt_compliance.units import Nominal

ANGLES = np.linspace(0, 2 * math.pi, 48, endpoint=False)
sequences = st.tuples(st.floats(0.15, 1.1), st.floats(0, 0.95), st.floats(-math.pi, math.pi))


@pytest.fixture(scope="module")
def references(in_python):
    """The block in Python."""
    return in_python(current_references)


@pytest.fixture(scope="module")
def logic(in_python):
    """The LVRT logic in Python."""
    return in_python(lvrt_step)


def over_a_cycle(references, V_pos, V_neg, angle, P, Q, params):
    """Voltage and reference (V, A) at angles of a cycle; sequences in pu, powers in W and var."""
    u_nom = params.lvrt.u_nom
    u_pos = V_pos * u_nom * np.exp(1j * ANGLES)
    u_neg = V_neg * u_nom * np.exp(-1j * ANGLES) * cmath.exp(1j * angle)
    i = [references(complex(a), complex(b), P, Q, params.references) for a, b in zip(u_pos, u_neg, strict=True)]
    return u_pos + u_neg, np.array(i)


@given(sequences, st.floats(0, 500e3), st.floats(0, 375e3))
@draws(50)
def test_active_power_is_constant_and_the_mean_reactive_power_scaled(references, params, voltage, P, Q):
    """Eq (5) gives P = P* at every instant, and mean Q = Q* (V+^2 + V-^2)/(V+^2 - V-^2)."""
    V_pos, share, angle = voltage
    u, i = over_a_cycle(references, V_pos, share * V_pos, angle, P, Q, params)
    s = u * i.conj()
    largest = abs(u).max() * abs(i).max() + 1
    assert np.allclose(s.real, P, atol=1e-9 * largest)
    assert s.imag.mean() == pytest.approx(Q * (1 + share**2) / (1 - share**2), abs=1e-9 * largest)


@given(st.floats(0.02, 0.849), st.floats(0, 0.95), st.floats(-math.pi, math.pi))
@draws(50)
def test_the_long_axis_of_the_current_is_nominal_in_every_fault(references, logic, params, V_pos, share, angle):
    """With the powers of the LVRT logic |i+| + |i-| is the nominal current, so no phase exceeds it."""
    V_neg = share * V_pos
    u_nom = params.lvrt.u_nom
    order = logic(complex(V_pos * u_nom), V_neg * u_nom * cmath.exp(1j * angle), params.lvrt)
    _, i = over_a_cycle(references, V_pos, V_neg, angle, order.P_limit, order.Q_ref, params)
    positive, negative = (abs((i * np.exp(-1j * turn * ANGLES)).mean()) for turn in (1, -1))
    if V_pos - V_neg > 0.005 + 1e-9:  # on the guard itself rounding decides
        assert positive + negative == pytest.approx(Nominal().current_ab_a, rel=1e-9)


@pytest.mark.parametrize("V_neg", [0.4951, 0.5, 0.51])
def test_no_current_is_asked_for_below_the_guard(references, params, V_neg):
    """Within 0.005 pu of V+ = V- eq (5) is 0/0 or nearly so: the reference is zero."""
    _, i = over_a_cycle(references, 0.5, V_neg, 0.3, 1e5, 1e5, params)
    assert (i == 0).all()


def test_lagging_current_is_positive_reactive_power(references, params):
    """Q* alone on a balanced grid puts the current 90 degrees behind the voltage."""
    u, i = over_a_cycle(references, 1, 0, 0, 0, 100e3, params)
    assert np.allclose(np.angle(i / u), -math.pi / 2)
