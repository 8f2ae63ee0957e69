import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from draws import draws
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.frequency import frequency_before, fundamental_frequency, rocof_hz_s
from pvlvrt_compliance.waveforms import Segment, Waveforms

HARMONICS = {5: (0, 30, 0), 7: (30j, 0, 0), 3: (0, 0, 20)}


@given(
    st.floats(45, 66),
    st.sampled_from([50.0, 60.0]),
    st.complex_numbers(min_magnitude=30, max_magnitude=330),
    st.complex_numbers(max_magnitude=25),
)
@draws(60)
def test_the_frequency_of_a_distorted_unbalanced_record(three_phase, segment, frequency_hz, nominal_hz, u_pos, u_neg):
    """Within 1e-3 Hz from 45 to 66 Hz, from either nominal frequency, with unbalance and 10 % of harmonics."""
    harmonics = {h: tuple(x * abs(u_pos) / 300 for x in s) for h, s in HARMONICS.items()}
    record = segment(three_phase("u", (u_pos, u_neg, 40), frequency_hz, 3500, harmonics))
    assert fundamental_frequency(record, nominal_hz) == pytest.approx(frequency_hz, abs=1e-3)


@pytest.mark.parametrize("cycles", [1.6, 2, 10])
def test_short_records(three_phase, segment, dt_s, cycles):
    """One and a half cycles are enough."""
    n = int(cycles / (49.3 * dt_s)) + 2
    record = segment(three_phase("i", (100, 50, 0), 49.3, n))
    assert fundamental_frequency(record, 50, "i") == pytest.approx(49.3, abs=1e-3)


def test_noise(three_phase, segment):
    """Noise of 1 % moves the frequency of a 0.2 s record by less than 5 mHz."""
    channels = three_phase("u", (325, 0, 0), 50.2, 4900)
    noise = np.random.default_rng(5)
    record = segment({name: x + noise.normal(scale=3.25, size=len(x)) for name, x in channels.items()})
    assert fundamental_frequency(record, 50) == pytest.approx(50.2, abs=5e-3)


@pytest.mark.parametrize("sequences", [(0, 0, 0), (0.5, 0, 0), (0, 200, 0)])
def test_no_positive_sequence_no_frequency(three_phase, segment, sequences):
    """Without voltage, or with a negative sequence only, there is no frequency to measure."""
    with pytest.raises(MeasurementError):
        fundamental_frequency(segment(three_phase("u", sequences, 50, 3000)), 50)


def test_one_cycle_is_too_short(three_phase, segment):
    """A record of one cycle is refused with the reason."""
    with pytest.raises(MeasurementError, match="too short"):
        fundamental_frequency(segment(three_phase("u", (325, 0, 0), 50, 600)), 50)


def test_not_a_number_is_no_frequency(three_phase, segment):
    """A gap in the recording is refused, not turned into a number."""
    channels = three_phase("u", (325, 0, 0), 50, 3000)
    channels["u_a_v"][100] = np.nan
    with pytest.raises(MeasurementError):
        fundamental_frequency(segment(channels), 50)


def test_the_record_before_an_instant(three_phase, dt_s):
    """What happens from the instant on does not count, and the last segment with enough record is taken."""
    first = Segment(0.0, dt_s, three_phase("u", (325, 0, 0), 50.4, 6000))
    second = Segment(6000 * dt_s, 2 * dt_s, three_phase("u", (30, 0, 0), 47, 3000, dt_s=2 * dt_s))
    record = Waveforms((first, second))
    assert frequency_before(record, 0.2, 50) == pytest.approx(50.4, abs=1e-3)
    assert frequency_before(record, second.t0_s + 0.01, 50) == pytest.approx(50.4, abs=1e-3)
    assert frequency_before(record, second.t0_s + 0.1, 50) == pytest.approx(47, abs=1e-3)
    with pytest.raises(MeasurementError, match="too short"):
        frequency_before(record, 0.01, 50)


@given(st.floats(-20, 20), st.floats(0.02, 0.5))
@draws(30)
def test_the_rate_of_a_ramp(dt_s, rate_hz_s, window_s):
    """A straight line has its slope at every instant once the window has passed."""
    t = dt_s * np.arange(20000)
    found = rocof_hz_s(t, 50 + rate_hz_s * t, window_s)
    assert np.isnan(found[t < window_s - 1e-9]).all()
    assert np.abs(found[t > window_s + 1e-9] - rate_hz_s).max() < 1e-9


def test_the_rate_of_a_step(dt_s):
    """A step by 1 Hz is 1 Hz over the window while the window holds it; gaps and the first cycles stay open."""
    t = dt_s * np.arange(20000)
    frequency = np.where(t < 0.4, 50.0, 51.0)
    frequency[t < 0.04] = np.nan
    found = rocof_hz_s(t, frequency, 0.1)
    assert np.isnan(found[t < 0.14]).all()
    assert found[(t > 0.401) & (t < 0.499)] == pytest.approx(10)
    assert found[(t > 0.141) & (t < 0.399)] == pytest.approx(0)
    assert found[t > 0.501] == pytest.approx(0)


def test_the_rate_across_a_change_of_step():
    """Instants need not be evenly spaced."""
    t = np.concatenate([np.arange(0, 1, 0.001), np.arange(1, 3, 0.01)])
    assert rocof_hz_s(t, 50 - 2 * t, 0.25)[-1] == pytest.approx(-2)


def test_a_window_of_nothing_has_no_rate():
    """A window must have a length."""
    with pytest.raises(MeasurementError, match="rate of change"):
        rocof_hz_s(np.arange(3.0), np.ones(3), 0)
