import cmath

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from draws import draws
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.fourier import component, components, mean, one_cycle_mean, one_cycle_phasor
from pvlvrt_compliance.waveforms import Segment

frequencies = st.floats(45, 66)
angles = st.floats(-3.1, 3.1)


def first_value(frequency_hz, dt_s):
    """Index of the first sample that has a whole cycle, and a sample, behind it."""
    return int(np.ceil(1 / (frequency_hz * dt_s))) + 1


@given(frequencies, angles, st.floats(0.01, 1e3))
@draws(40)
def test_a_steady_sinusoid_has_a_constant_phasor(sinusoid, dt_s, frequency_hz, angle, amplitude):
    """A cos(wt + phi) gives A exp(j phi) at every sample after the first cycle, though a cycle is no whole number."""
    x = sinusoid(cmath.rect(amplitude, angle), frequency_hz, 1500)
    phasor = one_cycle_phasor(x, dt_s, frequency_hz)[first_value(frequency_hz, dt_s) :]
    assert np.abs(phasor - cmath.rect(amplitude, angle)).max() < 1e-8 * amplitude


@given(frequencies, angles, st.integers(2, 13))
@draws(40)
def test_other_harmonics_are_rejected(sinusoid, dt_s, frequency_hz, angle, order):
    """A harmonic of unit amplitude, or a mean, leaves less than 2e-6 in the phasor of the fundamental."""
    x = 1 + sinusoid(cmath.rect(1, angle), order * frequency_hz, 1500)
    assert np.nanmax(np.abs(one_cycle_phasor(x, dt_s, frequency_hz))) < 2e-6


@pytest.mark.parametrize("order", [2, 5, 13])
def test_a_harmonic_is_measured_by_its_order(sinusoid, dt_s, order):
    """The component of an order is found beside a fundamental ten times as large."""
    x = sinusoid(10, 50, 1500) + sinusoid(1j, 50 * order, 1500)
    phasor = one_cycle_phasor(x, dt_s, 50, order)
    assert np.nanmax(np.abs(phasor - 1j)) < 1e-5


def test_a_whole_number_of_samples_agrees_with_the_fft():
    """Where the cycle is a whole number of samples, the phasor is the bin of the cycle's discrete Fourier transform."""
    cycle, x = 40, np.random.default_rng(1).normal(size=200)
    # Noise is not smooth, so the trapezoids' end points count: the FFT is told the mean of both ends.
    window = x[-cycle - 1 :].copy()
    window[0] = 0.5 * (window[0] + window[-1])
    expected = 2 / cycle * np.fft.fft(window[:-1])[1] * np.exp(-2j * np.pi * (len(x) - 1 - cycle) / cycle)
    assert one_cycle_phasor(x, 1 / (50 * cycle), 50)[-1] == pytest.approx(expected, abs=1e-12)


def test_the_first_cycle_has_no_phasor(sinusoid, dt_s):
    """Values begin when a cycle has passed; before that both parts are NaN, and nothing raises on a short record."""
    phasor = one_cycle_phasor(sinusoid(1, 50, 1000), dt_s, 50)
    assert np.isnan(phasor[:490].real).all()
    assert np.isnan(phasor[:490].imag).all()
    assert np.isfinite(phasor[490:]).all()
    assert np.isnan(one_cycle_phasor(np.ones(3), dt_s, 50)).all()


@given(st.integers(600, 1400), st.floats(-10, 10))
@draws(30)
def test_no_value_depends_on_the_future(sinusoid, dt_s, instant, step):
    """Changing the samples from an instant on leaves every value before it as it was."""
    x = sinusoid(1, 50, 1500)
    changed = x.copy()
    changed[instant:] += step
    for measured in (one_cycle_phasor, one_cycle_mean):
        before, after = measured(x, dt_s, 50), measured(changed, dt_s, 50)
        assert np.array_equal(before[:instant], after[:instant], equal_nan=True)


def test_a_step_of_amplitude_is_a_ramp_of_one_cycle(dt_s):
    """After a step of a constant, the one-cycle mean rises in a straight line and is settled after one cycle."""
    x = np.where(np.arange(2000) < 1000, 0.0, 1.0)
    ramp = one_cycle_mean(x, dt_s, 50)
    since = (np.arange(2000) - 999.5) * dt_s * 50
    assert np.nanmax(np.abs(ramp - np.clip(since, 0, 1))) < 1e-3


@given(frequencies, st.floats(-5, 5))
@draws(30)
def test_the_one_cycle_mean_rejects_what_turns(sinusoid, dt_s, frequency_hz, level):
    """The mean over a cycle is the level; fundamental and double frequency leave nothing."""
    x = level + sinusoid(1, frequency_hz, 1500) + sinusoid(1j, 2 * frequency_hz, 1500)
    assert np.nanmax(np.abs(one_cycle_mean(x, dt_s, frequency_hz) - level)) < 1e-8


def test_two_samples_a_cycle_are_too_few():
    """A record without the sampling for its fundamental is refused."""
    with pytest.raises(MeasurementError, match="samples a cycle"):
        one_cycle_phasor(np.ones(100), 0.02, 50)


@given(frequencies, angles, st.integers(1, 12), st.floats(0, 0.01))
@draws(60)
def test_a_window_of_whole_cycles_wherever_it_starts(sinusoid, dt_s, frequency_hz, angle, cycles, start_s):
    """A window cut out of a record at whole cycles gives phasor and mean exactly, one sample more or fewer."""
    x = 2 + sinusoid(cmath.rect(3, angle), frequency_hz, 8000)
    window = Segment(0.0, dt_s, {"x": x}).slice(start_s, start_s + cycles / frequency_hz)
    turned = cmath.rect(3, angle + 2 * np.pi * frequency_hz * window.t0_s)
    assert abs(component(window["x"], dt_s, frequency_hz) - turned) < 2e-5
    assert mean(window["x"], dt_s, frequency_hz) == pytest.approx(2, abs=1e-5)


def test_components_of_a_coherent_window_are_those_of_the_fft():
    """Over whole cycles of whole samples every order is the bin of the FFT, noise and all."""
    x = np.random.default_rng(2).normal(size=400)
    spectrum = 2 / 400 * np.fft.rfft(x)
    for order in range(1, 9):
        assert component(x, 1 / (50 * 80), 50, order=order) == pytest.approx(spectrum[5 * order], abs=1e-12)
    assert mean(x, 1 / (50 * 80), 50) == pytest.approx(x.mean(), abs=1e-12)


def test_a_straight_line_leaves_nothing_when_detrended(dt_s):
    """The double-frequency component of a ramp is nil after detrending, and far from it before."""
    ramp = 800 + 50 * dt_s * np.arange(9000)
    assert abs(component(ramp, dt_s, 50, detrend=True, order=2)) < 1e-9
    assert abs(component(ramp, dt_s, 50, order=2)) > 0.01


def test_a_ripple_on_a_ramp_is_measured(sinusoid, dt_s):
    """A ripple of 1 V on a slope of 200 V/s reads 1 V within what a fitted line takes of ten cycles, 6 / (20 pi)^2."""
    n = 9000
    x = 800 + 200 * dt_s * np.arange(n) + sinusoid(1j, 100, n)
    assert abs(component(x, dt_s, 50, detrend=True, order=2)) == pytest.approx(1, abs=2e-3)


def test_several_signals_at_once(sinusoid, dt_s):
    """Stacked signals give what each gives alone."""
    x = np.stack([sinusoid(1 + 1j, 50, 2500), sinusoid(2j, 50, 2500) + 3])
    for detrend in (False, True):
        alone = [component(signal, dt_s, 50, detrend) for signal in x]
        assert list(components(x, dt_s, 50, detrend=detrend)) == pytest.approx(alone)


def test_less_than_a_cycle_is_refused(sinusoid, dt_s):
    """A window that holds no whole cycle has no component and no mean."""
    for measured in (component, mean):
        with pytest.raises(MeasurementError, match="shorter than one cycle"):
            measured(sinusoid(1, 50, 480), dt_s, 50)
