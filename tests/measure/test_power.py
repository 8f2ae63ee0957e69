import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from draws import draws
from pvlvrt_compliance.measure.fourier import component, mean
from pvlvrt_compliance.measure.power import (
    instantaneous_power,
    negative_sequence_current,
    sequence_current,
    sequence_powers,
)
from pvlvrt_compliance.space_vectors import Sequences

phasors = st.complex_numbers(max_magnitude=400)


@given(phasors, phasors, phasors, phasors, phasors)
@draws(40)
def test_mean_powers_of_sequences(three_phase, segment, dt_s, u_pos, u_neg, u_zero, i_pos, i_neg):
    """Mean p + jq = 3/2 (U+ conj(I+) + conj(U-) I-) in peak phasors; the zero sequence of u adds nothing."""
    channels = three_phase("u", (u_pos, u_neg, u_zero), 50, 2500) | three_phase("i", (i_pos, i_neg, 0), 50, 2500)
    p, q = instantaneous_power(segment(channels))
    expected = 1.5 * (u_pos * i_pos.conjugate() + u_neg.conjugate() * i_neg)
    assert abs(mean(p, dt_s, 50) - expected.real) < 0.02
    assert abs(mean(q, dt_s, 50) - expected.imag) < 0.02


@given(phasors, phasors, phasors, phasors)
@draws(40)
def test_oscillating_active_power_of_sequences(three_phase, segment, dt_s, u_pos, u_neg, i_pos, i_neg):
    """The double-frequency part of p is the phasor 3/2 (U+ I- + U- I+)."""
    channels = three_phase("u", (u_pos, u_neg, 0), 50, 2500) | three_phase("i", (i_pos, i_neg, 0), 50, 2500)
    p, _ = instantaneous_power(segment(channels))
    assert abs(component(p, dt_s, 50, order=2) - 1.5 * (u_pos * i_neg + u_neg * i_pos)) < 0.05


def test_balanced_power_is_constant(three_phase, segment):
    """Balanced voltages and a current 90 degrees behind give no p and a constant positive q."""
    p, q = instantaneous_power(
        segment(three_phase("u", (300, 0, 0), 50, 900) | three_phase("i", (-20j, 0, 0), 50, 900))
    )
    assert np.abs(p).max() < 1e-8
    assert np.abs(q - 1.5 * 300 * 20).max() < 1e-8


def sequences(positive, negative):
    """Sequence phasors of one sample."""
    return Sequences(*(np.array([x], dtype=complex) for x in (positive, negative, 0)))


@given(phasors, phasors, phasors, phasors)
@draws(40)
def test_powers_of_sequences_add_to_the_mean(three_phase, segment, dt_s, u_pos, u_neg, i_pos, i_neg):
    """P+ + P- and Q+ + Q- are the means of p and q, each 3/2 |U| times its current where that has a direction."""
    record = segment(three_phase("u", (u_pos, u_neg, 0), 50, 2500) | three_phase("i", (i_pos, i_neg, 0), 50, 2500))
    p, q = instantaneous_power(record)
    u, i = sequences(u_pos, u_neg), sequences(i_pos, i_neg)
    positive, negative = sequence_powers(u, i)
    assert positive.p + negative.p == pytest.approx(mean(p, dt_s, 50), abs=0.02)
    assert positive.q + negative.q == pytest.approx(mean(q, dt_s, 50), abs=0.02)
    for power, current, voltage in (
        (positive, sequence_current(u.positive, i.positive), abs(u_pos)),
        (negative, negative_sequence_current(u.negative, i.negative), abs(u_neg)),
    ):
        if voltage >= 1:
            assert 1.5 * voltage * current.active == pytest.approx(power.p, abs=1e-6)
            assert 1.5 * voltage * current.reactive == pytest.approx(power.q, abs=1e-6)


@given(st.complex_numbers(min_magnitude=10, max_magnitude=400), st.floats(1, 300))
def test_support_behind_an_inductive_grid(source, current):
    """Positive reactive current raises |U+| and lowers |U-| by X I, whatever the angle of the voltage."""
    x = 0.01
    for measured, sign in ((sequence_current, 1), (negative_sequence_current, -1)):
        u = source * (1 + sign * x * current / abs(source))
        i = (u - source) / (1j * x)  # what flows from the inverter through jX when the voltage is this
        active, reactive = measured(np.array([u]), np.array([i]))
        assert reactive[0] == pytest.approx(current, rel=1e-6)
        assert active[0] == pytest.approx(0, abs=1e-6 * current)


def test_resistance_takes_active_current():
    """A current in phase with its voltage is active in both sequences."""
    for measured in (sequence_current, negative_sequence_current):
        active, reactive = measured(np.array([3j]), np.array([50j]))
        assert (active[0], reactive[0]) == pytest.approx((50, 0))


def test_no_voltage_no_direction():
    """Under the floor, and where a phasor is not known, the currents are not numbers."""
    u, i = np.array([0, 0.5j, np.nan, 300, 300]), np.array([10, 10, 10, np.nan, 10j])
    for measured in (sequence_current, negative_sequence_current):
        active, reactive = measured(u, i)
        assert np.isnan(active).tolist() == np.isnan(reactive).tolist() == [True, True, True, True, False]
    assert sequence_current(u, i, floor=0.1).active[1] == 0
