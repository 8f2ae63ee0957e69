import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance import sogi
from pvlvrt_compliance.control import current_regulator
from pvlvrt_compliance.sogi import SogiState, in_steady_state
from pvlvrt_compliance.vectors import Rotation

W = 2 * math.pi * 50
T_REG = 40.9568e-6
K = math.sqrt(2)


@pytest.fixture(scope="module")
def sogi_step(in_python):
    """The cell in Python."""
    return in_python(sogi.sogi_step)


@pytest.fixture(scope="module")
def resonator_step(in_python):
    """The resonator of eq (6) in Python."""
    return in_python(current_regulator.resonator_step)


def turn(angle: float) -> Rotation:
    """Turn by an angle (rad)."""
    return Rotation(c=math.cos(angle), s=math.sin(angle))


def state_space(step) -> tuple[np.ndarray, np.ndarray]:
    """Matrices A (2, 2) and B (2,) of a linear block, from its steps out of unit vectors."""
    columns = [step(SogiState(u=1 + 0j, qu=0j), 0j), step(SogiState(u=0j, qu=1 + 0j), 0j)]
    driven = step(SogiState(u=0j, qu=0j), 1 + 0j)
    return np.array([[c.u for c in columns], [c.qu for c in columns]]), np.array([driven.u, driven.qu])


def response(step, w: float, T: float) -> np.ndarray:
    """Frequency response of both outputs of a block at an angular frequency, shape (2,)."""
    A, B = state_space(step)
    return np.linalg.solve(np.exp(1j * w * T) * np.eye(2) - A, B)


def generator(sogi_step, T: float, h: int = 1):
    """Quadrature signal generator of Fig. 3(a) for harmonic h, gain K/h."""
    return lambda x, v: sogi_step(x, K / h * (v - x.u), turn(h * W * T))


@pytest.mark.parametrize("h", [1, 5, 7, 11, 13])
def test_quadrature_generator_is_exact_at_its_frequency(sogi_step, h):
    """At resonance the outputs are the input and its quadrature, in both directions of turning."""
    cell = generator(sogi_step, T_REG, h)
    assert np.allclose(response(cell, h * W, T_REG), [1, -1j], atol=1e-9)
    assert np.allclose(response(cell, -h * W, T_REG), [1, 1j], atol=1e-9)


@pytest.mark.parametrize("w", [0.2 * W, 0.8 * W, 1.3 * W, 3 * W, -2 * W])
def test_quadrature_generator_has_the_transfer_function_of_the_paper(sogi_step, w):
    """D = K w0 s / (s^2 + K w0 s + w0^2) and Q = K w0^2 / (the same), to the first order of the sample time."""
    s, T = 1j * w, 1e-7
    D = s**2 + K * W * s + W**2
    assert np.allclose(response(generator(sogi_step, T), w, T), [K * W * s / D, K * W**2 / D], rtol=1e-3)


@pytest.mark.parametrize(("h", "w_c"), [(1, 1.0), (5, 1.0), (13, 1.0), (1, 10.0)])
def test_resonator_has_the_transfer_function_of_eq_6(resonator_step, h, w_c):
    """2 w_c s / (s^2 + 2 w_c s + w^2): 1 at resonance, 1/sqrt(2) w_c beside it, little elsewhere."""
    w_h = h * W

    def step(x, e):
        return resonator_step(x, e, 2 * w_c / w_h, turn(w_h * T_REG))

    assert response(step, w_h, T_REG)[0] == pytest.approx(1, abs=1e-6)
    for w in (w_h - w_c, w_h + w_c, 0.5 * w_h, 2 * w_h):
        s = 1j * w
        expected = 2 * w_c * s / (s**2 + 2 * w_c * s + w_h**2)
        # The forcing is held over a sample, which is a delay of half of one.
        assert response(step, w, T_REG)[0] == pytest.approx(expected, rel=0.6 * abs(w) * T_REG)


@given(st.floats(-10, 10), st.complex_numbers(max_magnitude=1e3), st.complex_numbers(max_magnitude=1e3))
def test_an_undamped_pair_stays_on_the_unit_circle(sogi_step, angle, u, qu):
    """Without forcing a cell keeps its energy at any step, however long."""
    x = sogi_step(SogiState(u=u, qu=qu), 0j, turn(angle))
    assert math.hypot(abs(x.u), abs(x.qu)) == pytest.approx(math.hypot(abs(u), abs(qu)), rel=1e-12, abs=1e-300)
    A, _ = state_space(lambda s, g: sogi_step(s, g, turn(angle)))
    assert np.allclose(np.abs(np.linalg.eigvals(A)), 1, atol=1e-12)


@given(st.sampled_from([1, 5, 7, 11, 13]), st.floats(40, 70), st.floats(5e-6, 1e-4))
def test_the_generator_is_stable_over_the_guarded_frequencies(sogi_step, h, frequency, T):
    """The poles of every quadrature generator are inside the unit circle."""
    angle = 2 * math.pi * h * frequency * T
    A, _ = state_space(lambda x, v: sogi_step(x, K / h * (v - x.u), turn(angle)))
    assert np.abs(np.linalg.eigvals(A)).max() < 1


def test_the_discrete_generator_converges_with_order_one(sogi_step):
    """Halving the sample time halves the error off resonance; what is held over a sample is its error."""
    s = 0.7j * W
    exact = K * W * s / (s**2 + K * W * s + W**2)
    errors = [abs(response(generator(sogi_step, T), 0.7 * W, T)[0] - exact) for T in (8e-5, 4e-5, 2e-5, 1e-5)]
    assert np.allclose(np.log2(np.divide(errors[:-1], errors[1:])), 1, atol=0.02)


@given(st.complex_numbers(max_magnitude=1e3), st.complex_numbers(max_magnitude=1e3))
def test_sequences_are_told_apart_by_their_quadrature(in_python, u_pos, u_neg):
    """A quadrature 90 degrees behind is -j u+ and +j u-: the sum and the difference give both back."""
    found = in_python(sogi.sequences)(SogiState(u=u_pos + u_neg, qu=-1j * u_pos + 1j * u_neg))
    assert np.allclose(found, (u_pos, u_neg), atol=1e-9)


def test_a_locked_cell_has_positive_sequence_only(in_python):
    """The state that a run starts from belongs to a positive-sequence vector."""
    assert np.allclose(in_python(sogi.sequences)(in_steady_state(3 + 4j)), (3 + 4j, 0))


@given(st.floats(-1, 1))
def test_turns_of_harmonics_come_from_one_sine(in_python, angle):
    """The recurrence gives cosine and sine of every multiple."""
    expected = [turn(h * angle) for h in (1, 5, 7, 11, 13)]
    assert np.allclose(np.array(in_python(sogi.harmonic_turns)(angle)), np.array(expected), atol=1e-13)


@pytest.mark.parametrize("lead", [0, 1, 2, 5])
def test_a_leading_output_is_the_resonator_left_alone(in_python, sogi_step, lead):
    """The output ahead is what as many samples without error would give."""
    x = ahead = SogiState(u=2 - 1j, qu=0.5 + 3j)
    for _ in range(lead):
        ahead = sogi_step(ahead, 0j, turn(0.05))
    found = in_python(current_regulator.leading_output)(x, turn(0.05), lead)
    assert found == pytest.approx(ahead.u, abs=1e-12)
