import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from pvlvrt_compliance.measure.fourier import component, mean
from pvlvrt_compliance.measure.power import instantaneous_power

phasors = st.complex_numbers(max_magnitude=400)


@given(phasors, phasors, phasors, phasors, phasors)
@settings(deadline=None, max_examples=40)
def test_mean_powers_of_sequences(three_phase, segment, dt_s, u_pos, u_neg, u_zero, i_pos, i_neg):
    """Mean p + jq = 3/2 (U+ conj(I+) + conj(U-) I-) in peak phasors; the zero sequence of u adds nothing."""
    channels = three_phase("u", (u_pos, u_neg, u_zero), 50, 2500) | three_phase("i", (i_pos, i_neg, 0), 50, 2500)
    p, q = instantaneous_power(segment(channels))
    expected = 1.5 * (u_pos * i_pos.conjugate() + u_neg.conjugate() * i_neg)
    assert abs(mean(p, dt_s, 50) - expected.real) < 0.02
    assert abs(mean(q, dt_s, 50) - expected.imag) < 0.02


@given(phasors, phasors, phasors, phasors)
@settings(deadline=None, max_examples=40)
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
