import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.plant.protection import DC_OVERVOLTAGE, FREQUENCY, NO_TRIP, OVERCURRENT, UNDERVOLTAGE, exceeds

T_S = 5.1196e-6
U = np.sqrt(3) * 230
I_PU = np.sqrt(2) * 500e3 / (3 * 230)


def turning(frequency_hz: float, seconds: float) -> np.ndarray:
    """Unit vectors at the plant step."""
    return np.exp(2j * np.pi * frequency_hz * T_S * np.arange(round(seconds / T_S)))


@given(st.floats(-np.pi, np.pi), st.floats(0.2, 3))
def test_overcurrent_looks_at_the_largest_phase(in_python, angle, size):
    """The limit is met by the phase that is largest at that instant, whichever it is."""
    phases = [size * I_PU * np.cos(angle - 2 * np.pi * k / 3) for k in range(3)]
    vector = complex(np.sqrt(1.5) * size * I_PU * np.exp(1j * angle))
    peak = max(abs(x) for x in phases)
    assert in_python(exceeds)(vector, peak * (1 - 1e-9))
    assert not in_python(exceeds)(vector, peak * (1 + 1e-9))


@pytest.mark.parametrize(("size", "code"), [(1.999, NO_TRIP), (2.001, OVERCURRENT)])
@pytest.mark.parametrize("phase", [None, 0, 1, 2])
def test_overcurrent_trips_beyond_two_per_unit(watch, phase, size, code):
    """A balanced current, or one that pulsates along one phase, trips just above 2.0 pu peak and not just below."""
    i = np.sqrt(1.5) * size * I_PU * turning(50, 0.02)
    if phase is not None:
        # A current along the axis of one phase: that phase has 2/3 of sqrt(3/2) times the vector's length.
        i = i.real * np.exp(2j * np.pi * phase / 3)
    assert watch(i=i)[1] == code


@pytest.mark.parametrize(("v", "code"), [(1099.9, NO_TRIP), (1100.1, DC_OVERVOLTAGE)])
def test_dc_overvoltage_trips_at_once(watch, v, code):
    """A DC voltage beyond 1100 V trips, one below does not."""
    assert watch(v_dc=np.full(50, v))[1] == code


@pytest.mark.parametrize("residual", [0.0, 0.1, 0.3, 0.5, 0.7, 0.8])
@pytest.mark.many_samples
def test_undervoltage_rides_through_to_the_envelope_and_not_far_beyond(watch, residual):
    """A sag that clears exactly on the envelope does not trip; one that stays trips within 60 ms after it."""
    envelope_s = 0.15 + 1.35 * residual / 0.85
    u = U * turning(50, envelope_s + 0.3)
    n = len(u)
    t = T_S * np.arange(n) - 0.1
    stays = np.where(t >= 0, residual, 1.0)
    clears = np.where((t >= 0) & (t < envelope_s), residual, 1.0)
    assert watch(u=clears * u) == (None, NO_TRIP)
    at_s, code = watch(u=stays * u)
    assert code == UNDERVOLTAGE
    assert 0.1 + envelope_s + 0.04 < at_s < 0.1 + envelope_s + 0.06


@pytest.mark.many_samples
def test_above_the_threshold_a_sag_may_last(watch):
    """0.86 pu is no sag to the relay, however long."""
    assert watch(u=0.86 * U * turning(50, 2.0)) == (None, NO_TRIP)


def test_an_unbalanced_sag_counts_by_its_positive_sequence(watch):
    """Phase c at 10 % leaves V+ = 0.7: the relay waits for the envelope of 0.7, not of 0.1."""
    w = turning(50, 1.6)
    at_s, code = watch(u=U * (0.7 * w + 0.3 * w.conj()))
    assert code == UNDERVOLTAGE
    assert at_s == pytest.approx(0.15 + 1.35 * 0.7 / 0.85 + 0.05, abs=0.015)


@pytest.mark.parametrize(
    ("nominal_hz", "frequency_hz", "code"),
    [
        (50, 44.8, FREQUENCY),
        (50, 45.2, NO_TRIP),
        (50, 54.8, NO_TRIP),
        (50, 55.2, FREQUENCY),
        (60, 54.8, FREQUENCY),
        (60, 55.2, NO_TRIP),
        (60, 64.8, NO_TRIP),
        (60, 65.2, FREQUENCY),
    ],
)
@pytest.mark.many_samples
def test_frequency_trips_after_200_ms_outside_its_band(watch, nominal_hz, frequency_hz, code):
    """The band is 5 Hz to either side of nominal; a trip comes 200 ms after leaving it and not before."""
    at_s, found = watch(u=U * turning(frequency_hz, 0.5), frequency_hz=nominal_hz)
    assert found == code
    if code == FREQUENCY:
        assert 0.2 <= at_s < 0.4


def test_a_frequency_back_in_time_does_not_trip(watch):
    """150 ms far outside the band, 20 ms of filter included, are ridden through."""
    f = np.where(T_S * np.arange(round(0.8 / T_S)) % 0.4 < 0.12, 60.0, 50.0)
    assert watch(u=U * np.exp(2j * np.pi * np.cumsum(f) * T_S)) == (None, NO_TRIP)


def test_frequency_is_held_off_in_a_sag(watch):
    """Below 0.85 pu the turning of the voltage trips nothing: 42 Hz at half voltage ends by the undervoltage curve."""
    at_s, code = watch(u=0.5 * U * turning(42, 1.2))
    assert code == UNDERVOLTAGE
    assert at_s > 0.9
