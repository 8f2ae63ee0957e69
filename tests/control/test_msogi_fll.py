import math

import numpy as np
import pytest

U = 400.0
T_REG = 40.9568e-6


def vector(frequency_hz: float, seconds: float, parts: dict[int, complex]) -> np.ndarray:
    """Samples of a sum of turning vectors (V) by signed harmonic order: -1 is the negative sequence."""
    angle = 2 * np.pi * frequency_hz * T_REG * np.arange(round(seconds / T_REG))
    return sum(u * np.exp(1j * h * angle) for h, u in parts.items())


@pytest.mark.parametrize(("nominal_hz", "frequency_hz"), [(50, f) for f in (47, 49, 50, 51, 52)] + [(60, 57), (60, 62)])
@pytest.mark.many_samples
def test_it_locks_to_the_frequency_of_the_grid(track, nominal_hz, frequency_hz):
    """From its nominal frequency it finds any that a grid may have, and the voltage without error."""
    u = vector(frequency_hz, 0.5, {1: U})
    found = track(u, nominal_hz)
    assert found.w[-1] / (2 * np.pi) == pytest.approx(frequency_hz, abs=1e-4)
    assert abs(found.u_pos[-1] - u[-1]) < 1e-4 * U


@pytest.mark.parametrize("frequency_hz", [50, 60])
def test_sequences_of_an_unbalanced_voltage_are_exact(track, frequency_hz):
    """Positive and negative sequence come out separately, with their angles and no ripple of the frequency."""
    positive, negative = 0.7 * U, 0.3 * U * np.exp(0.4j)
    found = track(vector(frequency_hz, 0.6, {1: positive, -1: negative}), frequency_hz)
    last = slice(-600, None)
    assert np.allclose(found.u_pos[last], vector(frequency_hz, 0.6, {1: positive})[last], atol=1e-4 * U)
    assert np.allclose(found.u_neg[last], vector(frequency_hz, 0.6, {-1: negative})[last], atol=1e-4 * U)
    assert np.ptp(found.w[last]) < 2 * np.pi * 1e-3


def test_harmonics_leave_no_ripple(track):
    """10 % each of the 5th, 7th, 11th and 13th harmonic are taken out by the decoupling network."""
    harmonics = {-5: 0.1 * U, 7: 0.1j * U, -11: 0.1 * U, 13: -0.1 * U}
    found = track(vector(50, 1.0, {1: U} | harmonics), 50)
    last = slice(-600, None)
    assert np.ptp(found.w[last]) < 2 * np.pi * 1e-3
    assert np.allclose(found.u_pos[last], vector(50, 1.0, {1: U})[last], atol=1e-4 * U)
    for cell, order in zip(found.state.msogi[1:5], (-5, 7, -11, 13), strict=True):
        assert abs(cell.u) == pytest.approx(abs(harmonics[order]), rel=1e-3)


@pytest.mark.parametrize("frequency_hz", [30, 90])
def test_the_estimate_stays_within_its_guard(track, frequency_hz):
    """A voltage beyond 40 to 70 Hz leaves the estimate at the guard, not beyond it."""
    found = track(vector(frequency_hz, 1.0, {1: U}), 50).w / (2 * np.pi)
    assert found.min() >= 40 - 1e-9
    assert found.max() <= 70 + 1e-9
    assert found[-1] == pytest.approx(40 if frequency_hz < 50 else 70, abs=0.5)


def test_without_voltage_the_estimate_stays_finite_and_guarded(track):
    """A dead grid, 0/0 in the normalisation, gives no number that is not one."""
    found = track(np.zeros(20000, complex), 50)
    assert np.isfinite(found.w).all()
    assert found.w.min() >= 2 * math.pi * 40 * (1 - 1e-12)
    assert abs(found.u_pos[-1]) < 1e-6 * U


def test_the_frequency_follows_with_the_time_constant_of_the_loop(track):
    """A small step of the frequency decays as exp(-Gamma t), where the loop is slow against its filters."""
    found = track(vector(50.1, 0.4, {1: 398.37}), 50, gamma=5.0).w / (2 * np.pi)
    left = 50.1 - found[[round(t / T_REG) for t in (0.1, 0.2, 0.3)]]
    assert np.allclose(np.log(left[:-1] / left[1:]) / 0.1, 5, rtol=0.05)


def test_harmonic_generators_have_the_gain_over_their_order(track):
    """Out of rest a first sample moves each cell by K/h times the sine of its turn."""
    start = 398.37
    found = track(np.array([start + 100]), 50).state.msogi
    # The fundamental is locked to the start, so every cell sees the difference of 100 V.
    angle = 2 * math.pi * 50 * T_REG
    for cell, h in zip(found[1:5], (5, 7, 11, 13), strict=True):
        assert cell.u.real == pytest.approx(100 * math.sqrt(2) / h * math.sin(h * angle), rel=1e-3)
