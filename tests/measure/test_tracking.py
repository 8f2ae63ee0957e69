import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from draws import draws
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure import tracking
from pvlvrt_compliance.measure.sequences import sequence_phasors
from pvlvrt_compliance.measure.tracking import steering_frequency, tracked_frequency, tracked_sequences
from pvlvrt_compliance.space_vectors import phases
from pvlvrt_compliance.waveforms import Segment

SHIFT = 2 * np.pi / 3
grids = st.one_of(
    st.tuples(st.just(50.0), st.floats(47, 52)),
    st.tuples(st.just(60.0), st.floats(57, 62)),
)
harmonics = st.dictionaries(
    st.integers(2, 13), st.tuples(*[st.complex_numbers(max_magnitude=20)] * 3), min_size=0, max_size=4
)


def voltages(t_s, frequency_hz, sequences, distortion):
    """Three phase voltages at any instants, shape (3, n): written out with cosines, not by the code under test."""
    waves = np.zeros((3, len(t_s)))
    for order, parts in ({1: sequences} | distortion).items():
        for phasor, turn in zip(parts, (-SHIFT, SHIFT, 0), strict=True):
            for phase in range(3):
                angle = 2 * np.pi * frequency_hz * order * t_s + np.angle(phasor) + phase * turn
                waves[phase] += abs(phasor) * np.cos(angle)
    return waves


def fft_sequences(frequency_hz, sequences, distortion, noise):
    """Amplitudes of the sequences from the FFT of ten whole cycles on a grid that fits them."""
    n = 10 * 512
    waves = voltages(np.arange(n) / (512 * frequency_hz), frequency_hz, sequences, distortion)
    a, b, c = np.fft.rfft(waves + noise.normal(scale=1e-9, size=waves.shape), axis=-1)[:, 10] * 2 / n
    turn = np.exp(1j * SHIFT)
    return np.abs([a + turn * b + turn**2 * c, a + turn**2 * b + turn * c, a + b + c]) / 3


def record(waves, dt_s, kind="u"):
    """Segment of three waves."""
    return Segment(
        0.0, dt_s, dict(zip([f"{kind}_{p}_{'a' if kind == 'i' else 'v'}" for p in "abc"], waves, strict=True))
    )


@given(
    grids,
    st.complex_numbers(min_magnitude=60, max_magnitude=350),
    st.complex_numbers(max_magnitude=1),
    st.complex_numbers(max_magnitude=60),
    harmonics,
    st.floats(0, 3),
)
@draws(40)
def test_sequences_are_those_of_an_fft(dt_s, grid, positive, unbalance, zero, distortion, noise_v):
    """With harmonics, noise and unbalance, off nominal: 0.1 % of the largest sequence, and what the noise explains."""
    nominal_hz, frequency_hz = grid
    sequences = (positive, 0.6 * positive * unbalance, zero)
    random = np.random.default_rng(7)
    expected = fft_sequences(frequency_hz, sequences, distortion, random)
    waves = voltages(dt_s * np.arange(4500), frequency_hz, sequences, distortion)
    found = tracked_sequences(record(waves + random.normal(scale=noise_v, size=waves.shape), dt_s), "u", nominal_hz)
    samples_a_cycle = 1 / (frequency_hz * dt_s)
    # Of a sequence phasor: sqrt(2/N) of the noise in each phase, and sqrt(3) less for the three of them.
    explained = 6 * noise_v * np.sqrt(2 / samples_a_cycle / 3)
    for phasor, amplitude in zip(found, expected, strict=True):
        assert np.nanmax(np.abs(np.abs(phasor) - amplitude)) < 1e-3 * abs(positive) + explained


@given(grids, st.complex_numbers(max_magnitude=0.6), harmonics)
@draws(30)
def test_without_noise_the_figures_are_far_better(dt_s, grid, unbalance, distortion):
    """In a steady state without noise: sequences to 1e-5 of nominal and the frequency to 10 mHz."""
    nominal_hz, frequency_hz = grid
    sequences = (325, 325 * unbalance, 30)
    segment = record(voltages(dt_s * np.arange(4000), frequency_hz, sequences, distortion), dt_s)
    for phasor, expected in zip(tracked_sequences(segment, "u", nominal_hz), sequences, strict=True):
        assert np.nanmax(np.abs(np.abs(phasor) - abs(expected))) < 1e-5 * 325
    assert np.nanmax(np.abs(tracked_frequency(segment, nominal_hz) - frequency_hz)) < 0.01


@pytest.mark.parametrize(("nominal_hz", "frequency_hz"), [(50, 47), (50, 50), (50, 52), (60, 57), (60, 62)])
def test_values_begin_after_two_cycles(dt_s, nominal_hz, frequency_hz):
    """Two cycles of the slower of nominal and true frequency, and three samples; then at every sample."""
    segment = record(voltages(dt_s * np.arange(3000), frequency_hz, (300, 30, 0), {}), dt_s)
    two_cycles = 2 / (min(nominal_hz, frequency_hz) * dt_s)
    for found in (tracked_frequency(segment, nominal_hz), tracked_sequences(segment, "u", nominal_hz).negative):
        first = int(np.flatnonzero(np.isfinite(found))[0])
        assert two_cycles < first <= two_cycles + 4
        assert np.isfinite(found[first:]).all()
        assert np.isnan(found[:first]).all()


@pytest.mark.parametrize("rate_hz_s", [-4.0, 0.5, 4.0])
def test_a_ramp_is_followed_one_cycle_late(dt_s, rate_hz_s):
    """f(t) = 50 + r t reads 50 + r (t - T), within a millihertz for each hertz a second."""
    t = dt_s * np.arange(12000)
    theta = 2 * np.pi * (50 * t + 0.5 * rate_hz_s * t**2)
    waves = 300 * np.cos([theta, theta - SHIFT, theta + SHIFT]) + 60 * np.cos([theta, theta + SHIFT, theta - SHIFT])
    found = tracked_frequency(record(waves, dt_s), 50)
    assert np.nanmax(np.abs(found - (50 + rate_hz_s * (t - 0.02)))[2500:]) < 1e-3 * abs(rate_hz_s) * 1.5


def test_a_ramp_leaves_the_sequences_as_they_are(dt_s):
    """At 4 Hz/s the window is 0.28 Hz behind: 0.1 % of error in V+, and df / (2 f) = 0.28 % of V+ in V-."""
    t = dt_s * np.arange(12000)
    theta = 2 * np.pi * (50 * t - 2 * t**2)
    waves = 300 * np.cos([theta, theta - SHIFT, theta + SHIFT]) + 30 * np.cos([theta, theta + SHIFT, theta - SHIFT])
    found = tracked_sequences(record(waves, dt_s), "u", 50)
    assert np.nanmax(np.abs(np.abs(found.positive) - 300)) < 0.3
    assert np.nanmax(np.abs(np.abs(found.negative) - 30)) < 0.0028 * 300


@pytest.mark.parametrize("jump_deg", [60, -20])
def test_a_phase_jump(dt_s, jump_deg):
    """A jump by a reads about a / (2 pi T) at most and is over after two cycles; the sequences see it for one."""
    t = dt_s * np.arange(9000)
    jump = np.deg2rad(jump_deg) * (t >= 0.2)
    waves = 300 * np.cos([2 * np.pi * 50 * t + jump + k * SHIFT for k in (0, -1, 1)])
    segment = record(waves, dt_s)
    off = np.abs(tracked_frequency(segment, 50) - 50)
    peak = abs(jump_deg) / 360 / 0.02
    assert np.nanmax(off) == pytest.approx(peak, rel=0.1)
    assert off[t > 0.2 + 0.042].max() < 0.01
    assert off[t > 0.2 + 0.121].max() < 1e-4
    positive = np.abs(tracked_sequences(segment, "u", 50).positive)
    assert np.nanmin(positive) == pytest.approx(300 * np.cos(np.deg2rad(jump_deg / 2)), rel=1e-3)
    assert np.abs(positive[t > 0.2 + 0.0201] - 300).max() < 0.01


@pytest.mark.parametrize("frequency_hz", [49.0, 50.0, 50.4])
@pytest.mark.parametrize("sag", [(0.1, 0, 0), (0.7, 0.3, 0.3), (0.7, -0.3j, 0), (0.5 + 0.4j, 0.5, 0)])
def test_a_sag_is_seen_as_with_the_true_frequency(dt_s, sag, frequency_hz):
    """Through a sag and its end the sequences are those taken at the true frequency, within 0.1 % of nominal."""
    t = dt_s * np.arange(16000)
    whole, low = (voltages(t, frequency_hz, s, {}) for s in ((1, 0, 0), sag))
    segment = record(300 * np.where((t >= 0.2) & (t < 0.4), low, whole), dt_s)
    found, expected = tracked_sequences(segment, "u", 50), sequence_phasors(segment, "u", frequency_hz)
    for a, b in zip(found, expected, strict=True):
        assert np.nanmax(np.abs(np.abs(a) - np.abs(b))) < 0.001 * 300


def test_the_last_frequency_is_held_without_voltage(dt_s):
    """Under the floor the estimate stays where it was, within the 2 mHz that the fall itself does to it."""
    t = dt_s * np.arange(9000)
    waves = np.where(t < 0.2, 1, 0) * voltages(t, 49.6, (300, 0, 0), {})
    found = tracked_frequency(record(waves, dt_s), 50)
    assert found[-1] == pytest.approx(49.6, abs=2e-3)


def test_a_record_that_starts_dead(dt_s):
    """Before any voltage there is no frequency; sequences go by the nominal one until there is."""
    t = dt_s * np.arange(12000)
    segment = record(np.where(t > 0.1, 1, 0) * voltages(t, 51, (300, 20, 0), {}), dt_s)
    found = tracked_frequency(segment, 50)
    assert np.isnan(found[t < 0.1]).all()
    assert found[-1] == pytest.approx(51, abs=1e-3)
    positive = np.abs(tracked_sequences(segment, "u", 50).positive)
    assert np.nanmax(positive[t < 0.1]) == 0
    assert np.isfinite(positive[t > 0.055]).all()
    assert positive[-1] == pytest.approx(300, abs=0.01)


@given(st.integers(1200, 3900), st.floats(-300, 300))
@draws(20)
def test_no_value_depends_on_the_future(dt_s, instant, step):
    """Changing the samples from an instant on leaves frequency and sequences before it as they were."""
    waves = voltages(dt_s * np.arange(4000), 48.3, (300, 90, 20), {5: (0, 30, 0)})
    changed = waves.copy()
    changed[0, instant:] += step
    before, after = record(waves, dt_s), record(changed, dt_s)
    pairs = [(tracked_frequency(s, 50), *tracked_sequences(s, "u", 50)) for s in (before, after)]
    for x, y in zip(*pairs, strict=True):
        assert np.array_equal(x[:instant], y[:instant], equal_nan=True)


def test_voltages_and_currents_share_their_angles(dt_s):
    """A current 30 degrees behind its voltage is that at every sample, also once it has been switched off and on."""
    t = dt_s * np.arange(9000)
    flowing = np.where((t > 0.1) & (t < 0.2), 0, 1)
    lagging = flowing * voltages(t, 48.7, (1000 * np.exp(-1j * np.pi / 6), 0, 0), {})
    segment = Segment(
        0.0, dt_s, record(voltages(t, 48.7, (300, 0, 0), {}), dt_s).channels | record(lagging, dt_s, "i").channels
    )
    u, i = (tracked_sequences(segment, kind, 50).positive for kind in "ui")
    late = t > 0.3
    assert np.angle(u[late] * i[late].conj()) == pytest.approx(np.pi / 6, abs=1e-5)


def test_currents_alone(dt_s):
    """A record without voltages goes by the frequency of its currents."""
    segment = record(voltages(dt_s * np.arange(3000), 61.2, (1000, 100, 0), {}), dt_s, "i")
    assert np.abs(tracked_sequences(segment, "i", 60).negative[-1]) == pytest.approx(100, abs=1e-2)


def test_a_gap_is_not_filled(dt_s):
    """From a sample on that is no number, neither frequency nor sequences are stated."""
    waves = voltages(dt_s * np.arange(4000), 50, (300, 0, 0), {})
    waves[1, 2000] = np.nan
    segment = record(waves, dt_s)
    assert np.isnan(tracked_frequency(segment, 50)[2000:]).all()
    assert np.isnan(tracked_sequences(segment, "u", 50).positive[2000:]).all()


def test_short_and_missing(dt_s):
    """A record under two cycles has no value; a missing channel is named."""
    short = record(voltages(dt_s * np.arange(900), 50, (300, 0, 0), {}), dt_s)
    assert np.isnan(tracked_frequency(short, 50)).all()
    assert np.isnan(tracked_sequences(short, "u", 50).zero).all()
    assert np.isfinite(steering_frequency(short, "u", 50)[0]).all()
    with pytest.raises(MeasurementError, match="i_a_a"):
        tracked_sequences(short, "i", 50)


def test_the_phasors_are_fortescues(dt_s):
    """At the segment's first sample the angle is nil: the phasors themselves come back at nominal frequency."""
    parts = (300j, 40 - 10j, 5)
    waves = [(p * np.exp(2j * np.pi * 50 * dt_s * np.arange(3000))).real for p in phases(*parts)]
    for found, expected in zip(tracked_sequences(record(waves, dt_s), "u", 50), parts, strict=True):
        assert np.nanmax(np.abs(found - expected)) < 1e-3


DISTORTED = {5: (0, 32.5, 0), 7: (32.5j, 0, 0), 3: (0, 0, 20), 11: (0, 10, 0)}
UNBALANCED = (325, 97.5, 30)


@pytest.mark.parametrize("nominal_hz", [50, 60])
@pytest.mark.parametrize("off_hz", [-3, -1.3, 0, 0.7, 2])
def test_the_figures_of_the_page_in_a_steady_state(dt_s, nominal_hz, off_hz):
    """5e-8 of U+ in the sequences; 0.6 mHz from the first value on and 0.03 mHz later."""
    frequency_hz = nominal_hz + off_hz
    segment = record(voltages(dt_s * np.arange(6000), frequency_hz, UNBALANCED, DISTORTED), dt_s)
    for phasor, expected in zip(tracked_sequences(segment, "u", nominal_hz), UNBALANCED, strict=True):
        assert np.nanmax(np.abs(np.abs(phasor) - expected)) < 5e-8 * 325
    off = np.abs(tracked_frequency(segment, nominal_hz) - frequency_hz)
    assert np.nanmax(off) < 0.6e-3
    assert off[3000:].max() < 0.03e-3


def test_the_figures_of_the_page_with_noise(dt_s):
    """Noise of 1 % in every phase for a second: 0.13 % of U+ in the sequences, 13 mHz, 4 mHz of deviation."""
    waves = voltages(dt_s * np.arange(24000), 49.3, UNBALANCED, DISTORTED)
    noisy = record(waves + np.random.default_rng(1).normal(scale=3.25, size=waves.shape), dt_s)
    for phasor, expected in zip(tracked_sequences(noisy, "u", 50), UNBALANCED, strict=True):
        assert np.nanmax(np.abs(np.abs(phasor) - expected)) < 0.0013 * 325
    off = tracked_frequency(noisy, 50) - 49.3
    assert np.nanmax(np.abs(off)) < 0.013
    assert np.nanstd(off) < 0.004


def test_windows_go_by_a_frequency_above_the_floor_that_is_given(dt_s):
    """A voltage under the floor steers nothing: windows then go by the nominal frequency."""
    faint = record(voltages(dt_s * np.arange(4000), 49, (2.0, 0, 0), {}), dt_s)
    assert steering_frequency(faint, "u", 50, floor=1.0)[0][-1] == pytest.approx(49, abs=1e-3)
    assert steering_frequency(faint, "u", 50, floor=3.0)[0][-1] == 50


@pytest.mark.parametrize("width", [5, 80])
def test_the_sliding_median_is_that_of_every_window(width: int) -> None:
    """Each value is what numpy's median gives of its window, with numbers that occur twice and an odd or even count."""
    x = np.round(np.random.default_rng(3).normal(50.0, 0.5, 400), 1)
    expected = [np.median(x[k : k + width]) for k in range(len(x) - width + 1)]
    assert tracking._sliding_median(x.tolist(), width) == expected
