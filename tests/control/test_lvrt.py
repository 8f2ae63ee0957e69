import cmath
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.control.lvrt import lvrt_step, reactive_power_of_voltage

S = 500e3


@pytest.fixture(scope="module")
def order(in_python, params):
    """What the logic asks for at these sequences (pu)."""
    u_nom = params.lvrt.u_nom

    def decide(V_pos, V_neg, angle=0.0):
        return in_python(lvrt_step)(cmath.rect(V_pos * u_nom, angle), complex(V_neg * u_nom), params.lvrt)

    return decide


@pytest.mark.parametrize(
    ("V_pos", "V_neg", "Q_kvar", "P_kw"),
    [
        (0.1, 0, 50, 0),
        (0.7, 0.3, 160.714, 119.044),
        (0.83333333, 0.16666667, 17.857, 332.855),
        (0.8, 0, 53.571, 396.396),
        (0.2, 0, 100, 0),
        (0.5, 0, 250, 0),
        (0.6, 0.4, 100, 0),
        (0.75, 0.25, 107.143, 225.877),
    ],
)
def test_powers_asked_for_in_a_sag(order, V_pos, V_neg, Q_kvar, P_kw):
    """Sags of the paper and of the drop tables, worked out by hand from eqs (7) to (10) and the clip."""
    found = order(V_pos, V_neg)
    assert found.fault
    assert found.V_fault == pytest.approx(V_pos)
    assert found.Q_ref == pytest.approx(1e3 * Q_kvar, abs=5)
    assert found.P_limit == pytest.approx(1e3 * P_kw, abs=5)


@given(st.floats(0, 0.849), st.floats(0, 1), st.floats(-math.pi, math.pi))
def test_the_apparent_power_of_a_fault_is_used_in_full(order, V_pos, share, angle):
    """P_fault^2 + Q*^2 = S_fault^2 = ((V+ - V-) S)^2 in every sag, whatever the angle of the voltage."""
    found = order(V_pos, share * V_pos, angle)
    assert math.hypot(found.P_limit, found.Q_ref) == pytest.approx((1 - share) * V_pos * S, abs=1e-2)
    assert found.P_limit >= 0
    assert found.Q_ref >= 0


@given(st.floats(0.8500001, 1.5), st.floats(0, 1))
def test_normal_operation_from_the_threshold_on(order, V_pos, share):
    """At and above 0.85 pu no fault is flagged: nominal power, no reactive power."""
    found = order(V_pos, share * V_pos)
    assert (found.fault, found.P_limit, found.Q_ref) == (False, S, 0)


@pytest.mark.parametrize(("V", "Q_pu"), [(0, 0.75), (0.3, 0.75), (0.5, 0.75), (0.675, 0.375), (0.85, 0), (1.1, 0)])
def test_reactive_power_by_voltage(in_python, params, V, Q_pu):
    """Eq (9): a plateau of 0.75 below half voltage, a straight line to 0 at 0.85 pu."""
    assert in_python(reactive_power_of_voltage)(V, params.lvrt) == pytest.approx(Q_pu * S, abs=1e-6)


def test_more_negative_than_positive_sequence_asks_for_nothing(order):
    """V- above V+ leaves no apparent power; the root of a negative number is never taken."""
    found = order(0.2, 0.5)
    assert (found.P_limit, found.Q_ref) == (0, 0)
