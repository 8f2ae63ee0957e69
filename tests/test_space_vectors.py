import cmath
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance import vectors
from pvlvrt_compliance.space_vectors import ROTATION_120, clarke, fortescue, phases

reals = st.floats(-1e4, 1e4)
phasors = st.complex_numbers(max_magnitude=1e4)


@given(phasors, phasors, phasors)
def test_phases_undo_fortescue(a, b, c):
    """Symmetrical components add up to the phasors that they were taken from."""
    assert np.allclose(phases(*fortescue(a, b, c)), (a, b, c), atol=1e-9, rtol=0)


@given(phasors, phasors, phasors)
def test_fortescue_undoes_phases(positive, negative, zero):
    """Phases made of symmetrical components give these components back."""
    assert np.allclose(fortescue(*phases(positive, negative, zero)), (positive, negative, zero), atol=1e-9, rtol=0)


def test_a_balanced_set_is_pure_positive_sequence():
    """Phases b and c 120 and 240 degrees behind phase a have no negative and no zero sequence."""
    positive, negative, zero = fortescue(1, ROTATION_120**2, ROTATION_120)
    assert (positive, abs(negative), abs(zero)) == (pytest.approx(1), pytest.approx(0), pytest.approx(0))


def test_sequences_of_a_single_phase_sag():
    """With r left in phase c: V+ = (2 + r) / 3 and V- = V0 = (1 - r) / 3."""
    sequences = fortescue(1, ROTATION_120**2, 0.1 * ROTATION_120)
    assert [abs(s) for s in sequences] == pytest.approx([0.7, 0.3, 0.3])


@given(st.floats(0, 500), st.floats(-math.pi, math.pi))
def test_a_balanced_set_turns_forward(amplitude, angle):
    """Balanced phases of amplitude A at the angle theta are the space vector sqrt(3/2) A exp(j theta)."""
    a, b, c = (amplitude * math.cos(angle - k * 2 * math.pi / 3) for k in range(3))
    assert abs(clarke(a, b, c) - math.sqrt(1.5) * cmath.rect(amplitude, angle)) < 1e-9


@given(reals, reals, reals)
def test_clarke_keeps_the_length_without_the_zero_sequence(a, b, c):
    """|u|^2 is the sum of the squares less what the zero sequence holds: the transform is power-invariant."""
    expected = a * a + b * b + c * c - (a + b + c) ** 2 / 3
    assert abs(clarke(a, b, c)) ** 2 == pytest.approx(expected, abs=1e-6, rel=1e-9)


@given(reals, reals, reals, reals, reals)
def test_power_of_space_vectors_is_the_power_of_the_phases(u_a, u_b, u_c, i_a, i_b):
    """Re(u conj(i)) is the sum of the phase powers where the currents sum to zero, whatever the zero sequence of u."""
    i_c = -i_a - i_b
    s = clarke(u_a, u_b, u_c) * clarke(i_a, i_b, i_c).conjugate()
    assert s.real == pytest.approx(u_a * i_a + u_b * i_b + u_c * i_c, abs=1e-5, rel=1e-9)


def test_lagging_current_is_positive_reactive_power():
    """A current 90 degrees behind the voltage delivers Q > 0 and no P (eq (3))."""
    u = clarke(1, -0.5, -0.5)
    s = u * (u * -1j).conjugate()
    assert (s.real, s.imag) == (pytest.approx(0), pytest.approx(1.5))


def test_scalars_and_arrays_are_one_formula():
    """The transform of arrays is that of their elements."""
    a, b, c = np.array([1.0, 2.0]), np.array([-3.0, 0.5]), np.array([0.25, 4.0])
    assert list(clarke(a, b, c)) == pytest.approx([clarke(a[k], b[k], c[k]) for k in range(2)])


@given(reals, reals, reals)
def test_the_compiled_forms_are_the_clarke_transform(in_python, a, b, c):
    """Vector of three phases and phases of a vector, as kernels use them: eq (1), and its inverse without zero."""
    z = in_python(vectors.vector_of)(vectors.Phases(a, b, c))
    assert z == pytest.approx(complex(clarke(a, b, c)), abs=1e-9)
    zero = (a + b + c) / 3
    assert in_python(vectors.phases_of)(z) == pytest.approx((a - zero, b - zero, c - zero), abs=1e-9)
