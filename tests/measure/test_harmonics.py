import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from draws import draws
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.harmonics import harmonic_amplitudes, thd_percent

spectra = st.dictionaries(st.integers(2, 40), st.complex_numbers(max_magnitude=0.1), max_size=6)


def window(frequency_hz, cycles, dt_s):
    """Number of samples of a window of whole cycles."""
    return int(np.ceil(cycles / (frequency_hz * dt_s)))


@given(st.floats(45, 66), st.integers(1, 12), spectra, st.integers(-1, 1), st.floats(-2, 2))
@draws(60)
def test_every_harmonic_comes_back(sinusoid, dt_s, frequency_hz, cycles, spectrum, more, level):
    """All orders to the 40th are exact, of a window that is a sample longer or shorter than its whole cycles."""
    n = window(frequency_hz, cycles, dt_s) + more
    x = level + sinusoid(1, frequency_hz, n) + sum(sinusoid(c, h * frequency_hz, n) for h, c in spectrum.items())
    expected = np.zeros(41)
    expected[[0, 1]] = abs(level), 1
    expected[list(spectrum)] = np.abs(list(spectrum.values()))
    assert np.abs(harmonic_amplitudes(x, dt_s, frequency_hz) - expected).max() < 1e-9


@given(st.floats(45, 66), spectra)
@draws(30)
def test_distortion_by_its_definition(sinusoid, dt_s, frequency_hz, spectrum):
    """The distortion is the root of the sum of the harmonics' squares over the fundamental; a mean does not count."""
    n = window(frequency_hz, 10, dt_s)
    x = 5 + sinusoid(2, frequency_hz, n) + sum(sinusoid(2 * c, h * frequency_hz, n) for h, c in spectrum.items())
    expected = 100 * np.sqrt(sum(abs(c) ** 2 for c in spectrum.values()))
    assert thd_percent(x, dt_s, frequency_hz) == pytest.approx(expected, abs=1e-8)


def test_a_square_wave(dt_s):
    """A square wave at the 41st order band limit: harmonics 1/h, hence 100 sqrt(sum of 1/h^2, odd h from 3 to 39)."""
    theta = 2 * np.pi * 60 * dt_s * np.arange(window(60, 10, dt_s))
    x = sum(np.sin(h * theta) / h for h in range(1, 41, 2))
    expected = 100 * np.sqrt(sum(1 / h**2 for h in range(3, 41, 2)))
    assert thd_percent(x, dt_s, 60) == pytest.approx(expected, abs=1e-9)


def test_coherent_sampling_agrees_with_the_fft():
    """Over whole cycles of whole samples, noise included, the amplitudes are those of the FFT."""
    x = np.random.default_rng(3).normal(size=10 * 200)
    spectrum = np.abs(np.fft.rfft(x)) * 2 / len(x)
    found = harmonic_amplitudes(x, 1 / (50 * 200), 50)
    assert np.abs(found[1:] - spectrum[10:401:10]).max() < 1e-12


def test_noise_adds_little(sinusoid, dt_s):
    """Noise of 0.1 % adds to a distortion of 3 % no more than its own part in 39 orders."""
    n = window(50, 10, dt_s)
    x = sinusoid(1, 50, n) + sinusoid(0.03, 250, n) + np.random.default_rng(4).normal(scale=1e-3, size=n)
    assert thd_percent(x, dt_s, 50) == pytest.approx(3, abs=0.02)


@pytest.mark.parametrize("amplitude", [0.0, 1e-9, 9e-4])
def test_no_fundamental_no_distortion(sinusoid, dt_s, amplitude):
    """Below the floor there is no distortion to state: after a trip the currents are zero."""
    assert thd_percent(sinusoid(amplitude, 50, 2000), dt_s, 50) is None


def test_coarse_sampling_measures_what_it_carries(sinusoid):
    """At 1 kHz a recording carries orders up to 9; those above read zero and the others stay exact."""
    x = sinusoid(1, 50.3, 199, 1e-3) + sinusoid(0.2, 7 * 50.3, 199, 1e-3)
    found = harmonic_amplitudes(x, 1e-3, 50.3)
    assert found[[1, 7]] == pytest.approx([1, 0.2])
    assert np.all(found[10:] == 0)


def test_stacked_signals_give_what_each_gives_alone(sinusoid, dt_s):
    """Three phases at once are three times one phase."""
    x = np.stack([sinusoid(k + 1j, 50, 1500) + sinusoid(k, 350, 1500) for k in range(3)])
    alone = [harmonic_amplitudes(phase, dt_s, 50) for phase in x]
    assert np.abs(harmonic_amplitudes(x, dt_s, 50) - alone).max() < 1e-12


def test_less_than_a_cycle_is_refused(dt_s):
    """A window that holds no whole cycle has no harmonics."""
    with pytest.raises(MeasurementError, match="shorter than one cycle"):
        thd_percent(np.ones(400), dt_s, 50)
