import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from draws import draws
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.rms import half_cycle_rms, sliding_rms


@given(st.floats(45, 66), st.complex_numbers(min_magnitude=1, max_magnitude=400), st.floats(-50, 50), st.floats(0, 40))
@draws(40)
def test_the_rms_of_a_distorted_wave(sinusoid, dt_s, frequency_hz, phasor, level, harmonic):
    """sqrt(level^2 + half the squares of the amplitudes), at every sample although a cycle is no whole number."""
    x = level + sinusoid(phasor, frequency_hz, 1500) + sinusoid(harmonic, 5 * frequency_hz, 1500)
    expected = np.sqrt(level**2 + (abs(phasor) ** 2 + harmonic**2) / 2)
    for measured in (sliding_rms, half_cycle_rms):
        assert np.nanmax(np.abs(measured(x, dt_s, frequency_hz) - expected)) < 1e-5 * expected


def test_a_whole_number_of_samples_agrees_with_the_sum():
    """Over 40 samples of noise the rms is the root of the mean square, both ends counting half."""
    x = np.random.default_rng(3).normal(size=(2, 200))
    squares = x[:, -41:] ** 2
    expected = np.sqrt((squares[:, 1:-1].sum(axis=1) + 0.5 * (squares[:, 0] + squares[:, -1])) / 40)
    assert sliding_rms(x, 1 / 2000, 50)[:, -1] == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("frequency_hz", [47.3, 50.0, 60.0])
def test_it_is_refreshed_each_half_cycle(sinusoid, dt_s, frequency_hz):
    """The value changes at the first sample at or after each half cycle, and is the sliding one there."""
    growing = sinusoid(1, frequency_hz, 5000) * np.linspace(1, 2, 5000)
    held, sliding = half_cycle_rms(growing, dt_s, frequency_hz), sliding_rms(growing, dt_s, frequency_hz)
    first = int(np.flatnonzero(np.isfinite(held))[0])
    assert first == int(np.flatnonzero(np.isfinite(sliding))[0])
    changes = np.flatnonzero(np.diff(held[first:])) + first + 1
    half = 0.5 / (frequency_hz * dt_s)
    assert changes.tolist() == [int(np.ceil(k * half - 1e-6)) for k in range(3, 2 + len(changes) + 1)]
    assert np.array_equal(held[changes], sliding[changes])


def test_a_sag_is_settled_within_a_cycle_and_a_half(sinusoid, dt_s):
    """From one and a half cycles after a step on the value is the new one; before the step it is the old one."""
    n = 3000
    t = dt_s * np.arange(n)
    found = half_cycle_rms(np.where(t < 0.06, 1, 0.3) * sinusoid(np.sqrt(2), 50, n), dt_s, 50)
    assert np.nanmax(np.abs(found[t < 0.06] - 1)) < 1e-6
    assert np.abs(found[t > 0.06 + 0.0301] - 0.3).max() < 1e-6


def test_with_a_frequency_at_each_sample(dt_s):
    """The window follows: at 47.5 Hz for half of the record and 52 Hz after it, the rms does not ripple."""
    frequency_hz = np.where(np.arange(6000) < 3000, 47.5, 52.0)
    x = np.cos(2 * np.pi * dt_s * np.cumsum(frequency_hz))
    for measured in (sliding_rms, half_cycle_rms):
        found = measured(x, dt_s, frequency_hz)
        away = np.abs(np.arange(6000) - 3300) > 500
        assert np.nanmax(np.abs(found[away] - np.sqrt(0.5))) < 1e-5


def test_nothing_is_exactly_nothing(sinusoid, dt_s):
    """After a trip the current is zero and so is its rms, never the root of something negative."""
    x = np.where(np.arange(3000) < 1000, 1, 0) * sinusoid(1000, 50, 3000)
    found = sliding_rms(x, dt_s, 50)
    assert np.isfinite(found[600:]).all()
    assert found[-1] < 1e-3


@given(st.integers(600, 1400), st.floats(-10, 10))
@draws(20)
def test_no_value_depends_on_the_future(sinusoid, dt_s, instant, step):
    """Changing the samples from an instant on leaves every value before it as it was."""
    x = sinusoid(1, 50, 1500)
    changed = x.copy()
    changed[instant:] += step
    before, after = half_cycle_rms(x, dt_s, 50), half_cycle_rms(changed, dt_s, 50)
    assert np.array_equal(before[:instant], after[:instant], equal_nan=True)


def test_short_records(dt_s):
    """Under a cycle there is no value; two samples a cycle are too few."""
    assert np.isnan(half_cycle_rms(np.ones((3, 100)), dt_s, 50)).all()
    with pytest.raises(MeasurementError, match="samples a cycle"):
        half_cycle_rms(np.ones(100), 0.02, 50)
