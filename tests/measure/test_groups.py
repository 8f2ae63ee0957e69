import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from draws import draws
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.groups import (
    Spectrum,
    dc_component,
    group_windows,
    harmonic_groups,
    harmonic_subgroups,
    interharmonic_groups,
    interharmonic_subgroups,
    spectrum,
    thd,
    trd,
    window_cycles,
)
from pvlvrt_compliance.measure.harmonics import harmonic_amplitudes

grids = st.one_of(
    st.tuples(st.just(50.0), st.floats(47, 52)),
    st.tuples(st.just(60.0), st.floats(57, 62)),
)


def samples(frequency_hz, cycles, dt_s):
    """Number of samples of a window."""
    return int(np.ceil(cycles / (frequency_hz * dt_s)))


def of_one_line(line, cycles, highest=50):
    """A spectrum of one line of rms 1."""
    lines = np.zeros((highest + 1) * cycles + 1)
    lines[line] = 1
    return Spectrum(lines, cycles)


def test_ten_cycles_or_twelve():
    """A window is 200 ms at either nominal frequency."""
    assert (window_cycles(50), window_cycles(60)) == (10, 12)


@given(grids, st.dictionaries(st.integers(1, 505), st.complex_numbers(max_magnitude=30), max_size=8), st.floats(-9, 9))
@draws(25)
def test_every_line_comes_back(sinusoid, dt_s, grid, content, level):
    """Lines are exact whatever the measured frequency, the synchronised window being no whole number of samples."""
    nominal_hz, frequency_hz = grid
    cycles = window_cycles(nominal_hz)
    n = samples(frequency_hz, cycles, dt_s)
    x = level + sum((sinusoid(c, k * frequency_hz / cycles, n) for k, c in content.items()), np.zeros(n))
    expected = np.zeros(51 * cycles + 1)
    expected[0] = abs(level)
    expected[list(content)] = np.abs(list(content.values())) / np.sqrt(2)
    assert np.abs(spectrum(x, dt_s, frequency_hz, nominal_hz).lines - expected).max() < 1e-9


def test_a_coherent_window_agrees_with_the_fft():
    """Over ten cycles of 256 samples the lines of noise are those of the FFT."""
    x = np.random.default_rng(8).normal(size=(3, 2560))
    expected = np.sqrt(2) / 2560 * np.abs(np.fft.rfft(x))[:, 1:511]
    assert np.abs(spectrum(x, 1 / (50 * 256), 50, 50).lines[:, 1:] - expected).max() < 1e-12


@pytest.mark.parametrize("cycles", [10, 12])
def test_each_line_belongs_to_the_groups_that_the_standard_says(cycles):
    """Line by line around the 7th harmonic: how much of its square each kind of group takes."""
    half = cycles // 2
    for k in range(-half, half + 1):
        found = of_one_line(7 * cycles + k, cycles)
        group, subgroup = harmonic_groups(found), harmonic_subgroups(found)
        assert group[7] ** 2 == pytest.approx(0.5 if abs(k) == half else 1)
        assert np.sum(group**2) == pytest.approx(1)
        assert subgroup[7] == (1 if abs(k) <= 1 else 0)
        between, order = interharmonic_groups(found), 7 if k > 0 else 6
        assert between[order] == (0 if k == 0 else 1)
        assert interharmonic_subgroups(found)[order] == (0 if abs(k) <= 1 else 1)
        assert np.count_nonzero(between) == (0 if k == 0 else 1)


def test_groups_and_gaps_share_out_all_power():
    """Harmonics, and the interharmonic groups between them, hold the square of every line up to the last order."""
    lines = np.random.default_rng(9).uniform(0, 1, 511)
    found = Spectrum(lines, 10)
    harmonics = lines[10:501:10]
    total = lines[0] ** 2 + np.sum(harmonics**2) + np.sum(interharmonic_groups(found) ** 2)
    assert total == pytest.approx(np.sum(lines[:510] ** 2))
    assert harmonic_groups(found)[0] == lines[0]
    assert len(harmonic_groups(found)) == 51


def test_subharmonics_are_in_the_first_gap():
    """Lines between the mean and the fundamental are the interharmonic group of order 0."""
    found = of_one_line(4, 10)
    assert interharmonic_groups(found)[0] == 1
    assert harmonic_subgroups(found)[0] == 0


def test_a_flickering_harmonic_is_kept_by_its_group(sinusoid, dt_s):
    """A 5th harmonic that swings by m at 5 Hz has sidebands m/2: its subgroup holds 1 + m^2/2 of its square."""
    n = samples(50, 10, dt_s)
    x = (1 + 0.4 * np.cos(2 * np.pi * 5 * dt_s * np.arange(n))) * sinusoid(10, 250, n)
    found = spectrum(x, dt_s, 50, 50)
    assert harmonic_subgroups(found)[5] ** 2 == pytest.approx(50 * (1 + 0.4**2 / 2))


def test_distortions_of_orders_and_of_groups(sinusoid, dt_s):
    """THD sees harmonics, THDG their neighbourhood too; orders above the highest do not count."""
    n = samples(60, 12, dt_s)
    x = sinusoid(100, 60, n) + sinusoid(3, 300, n) + sinusoid(4, 310, n) + sinusoid(2, 45 * 60, n)
    found = spectrum(x, dt_s, 60, 60)
    assert thd(harmonic_amplitudes(x, dt_s, 60, 50)) == pytest.approx(0.03, abs=1e-3)
    assert thd(harmonic_groups(found)) == pytest.approx(0.05)
    assert thd(harmonic_groups(found), 50) == pytest.approx(np.sqrt(0.05**2 + 0.02**2))
    assert thd(harmonic_subgroups(found)) == pytest.approx(0.03)
    assert np.isnan(thd(np.zeros(51)))


@given(grids, st.floats(0, 20), st.floats(0, 20), st.floats(-20, 20), st.floats(0, 1000))
@draws(40)
def test_total_rated_distortion(sinusoid, dt_s, grid, harmonic, between, level, fundamental):
    """The rms of 5th harmonic, an interharmonic and the mean over the rated current, however small the fundamental."""
    nominal_hz, frequency_hz = grid
    cycles = window_cycles(nominal_hz)
    n = samples(frequency_hz, cycles, dt_s)
    line_hz = frequency_hz / cycles
    x = level + sinusoid(fundamental * 1j, frequency_hz, n) + sinusoid(harmonic, 5 * frequency_hz, n)
    x = x + sinusoid(between, 37 * line_hz, n)
    expected = np.sqrt(level**2 + (harmonic**2 + between**2) / 2) / 700
    assert trd(x, dt_s, frequency_hz, 700) == pytest.approx(expected, abs=3e-5)


def test_distortion_of_three_phases(sinusoid, dt_s):
    """Stacked phases have a distortion and a mean each."""
    n = samples(50, 10, dt_s)
    x = np.stack([sinusoid(100, 50, n) + sinusoid(k, 350, n) - k for k in range(3)])
    assert trd(x, dt_s, 50, 100) == pytest.approx([np.sqrt(1.5) * k / 100 for k in range(3)], abs=1e-5)
    assert dc_component(x, dt_s, 50) == pytest.approx([0, -1, -2], abs=1e-4)


def test_windows_follow_each_other(sinusoid, dt_s):
    """A record of one second holds five windows without gaps; each has the same lines, and 0.9 s four."""
    n = samples(49.7, 50, dt_s)
    windows = group_windows(n, dt_s, 49.7, 50)
    assert len(windows) == 5
    assert [w.start for w in windows[1:]] == [w.stop for w in windows[:-1]]
    x = sinusoid(100, 49.7, n) + sinusoid(5, 7 * 49.7, n)
    for window in windows:
        assert spectrum(x[window], dt_s, 49.7, 50).lines[[10, 70]] == pytest.approx([100 / 2**0.5, 5 / 2**0.5])
    assert len(group_windows(samples(49.7, 49, dt_s), dt_s, 49.7, 50)) == 4
    assert group_windows(1000, dt_s, 50, 50) == ()


def test_less_than_ten_cycles_are_refused(sinusoid, dt_s):
    """Nine cycles have no spectrum."""
    with pytest.raises(MeasurementError, match="shorter"):
        spectrum(sinusoid(1, 50, samples(50, 9, dt_s)), dt_s, 50, 50)


def test_what_is_not_a_number_stays_so(sinusoid, dt_s):
    """A gap in one phase leaves the others measured."""
    x = np.stack([sinusoid(1, 50, samples(50, 10, dt_s))] * 2)
    x[1, 100] = np.nan
    found = spectrum(x, dt_s, 50, 50).lines
    assert np.isnan(found[1]).all()
    assert found[0, 10] == pytest.approx(1 / np.sqrt(2))
