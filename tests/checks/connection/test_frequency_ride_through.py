"""Connection in bands of the frequency and at rates of change, on both sides of each limit."""

import numpy as np
import pytest
from frequencies import ramp

from pvlvrt_compliance.checks.alone import judge_alone
from pvlvrt_compliance.checks.connection.frequency_ride_through import FrequencyRideThroughCheck
from pvlvrt_compliance.evidence.collect import collect
from pvlvrt_compliance.evidence.evidence import NotApplicable
from pvlvrt_compliance.evidence.frequency import frequency_hz
from pvlvrt_compliance.results import Status
from pvlvrt_compliance.scenario.sag import Sag

BANDS = [{"frequency_hz": (47.0, 49.0), "ride_s": 0.6}, {"frequency_hz": (49.0, 51.0)},
         {"frequency_hz": (51.0, 52.0), "ride_s": 0.4}]  # fmt: skip
KIND = "frequency_ride_through"


@pytest.fixture
def frequency(profile_with, bench):
    """Make a record of events of the frequency, judged by bands and a rate."""
    bands = {"rows": BANDS, "clause": "7.1", "confidence": "code", "source": "a test"}
    demand = {"clause": "7", "source": "a test", "bands": bands, "rocof_hz_s": 2.0, "rocof_window_s": 0.1}
    profile = profile_with(KIND, demand)

    def make(*events, duration_s=1.0, **settings):
        return bench(
            depth=0, duration_s=duration_s, profile=profile, scenario={"events": events}, p_sag_kw=500, **settings
        )

    return make


@pytest.mark.parametrize(("to_hz", "status"), [(50.19, Status.NOT_APPLICABLE), (50.22, Status.PASS)])
def test_normal_frequencies_are_not_judged(frequency, to_hz, status):
    """A frequency within 0.2 Hz of nominal is no disturbance."""
    assert frequency(ramp(to_hz)).check(KIND).status is status


@pytest.mark.parametrize(("to_hz", "band_s", "begun_s"), [(48.5, 0.6, 0.5), (51.5, 0.4, 0.5)])
@pytest.mark.parametrize(("late_s", "status"), [(-0.01, Status.FAIL), (0.05, Status.PASS)])
def test_trip_around_the_time_of_a_band(frequency, to_hz, band_s, begun_s, late_s, status):
    """A band must be ridden through for its time from when the frequency enters it, seen a cycle late."""
    events = [ramp(to_hz, rate_hz_s=2.0)]
    check = frequency(*events, duration_s=2.0, disconnected_after_s=begun_s + band_s + late_s).check(KIND)
    assert check.status is status, check.message
    assert check.limit == pytest.approx(band_s, abs=1e-3)
    assert check.clause == "7.1"
    assert "Hz/s over 0.1 s" in check.message


@pytest.mark.parametrize(
    ("tripped_s", "clause", "confidence"), [(1.0, "7.1", "code"), (1.2, "row", "confirmed"), (None, "row", "confirmed")]
)
def test_beyond_the_time_of_a_band_the_row_demands(frequency, tripped_s, clause, confidence):
    """The band lets the inverter go after 1.1 s of 2 s: what is demanded from then on is the row's."""
    made = frequency(ramp(48.5, rate_hz_s=2.0), duration_s=2.0, disconnected_after_s=tripped_s)
    row = {"expect": "ride_through", "clause": "row", "confidence": "confirmed"}
    made.test = made.test.model_copy(update=row)
    check = made.check(KIND)
    assert check.status is (Status.PASS if tripped_s is None else Status.FAIL), check.message
    assert (check.clause, check.confidence) == (clause, confidence)


def test_trip_in_the_continuous_band(frequency):
    """A trip while every frequency is one to be ridden through for ever fails."""
    check = frequency(ramp(50.9), disconnected_after_s=0.95).check(KIND)
    assert check.status is Status.FAIL
    assert "demands connection" in check.message


@pytest.mark.parametrize(("to_hz", "status"), [(51.995, Status.FAIL), (52.03, Status.NOT_APPLICABLE)])
def test_beyond_all_bands_the_inverter_may_go_at_once(frequency, to_hz, status):
    """The last edge is sharp to the accuracy of the measurement, 10 mHz."""
    events = [ramp(to_hz, rate_hz_s=20.0)]
    made = frequency(*events, duration_s=1.0, disconnected_after_s=0.2)
    made.profile = made.profile.model_copy(update={"requirements": made.profile.requirements.model_copy(update={
        KIND: made.profile.requirements.frequency_ride_through.model_copy(
            update={"rocof_hz_s": None, "rocof_window_s": None})})})  # fmt: skip
    assert made.check(KIND).status is status


@pytest.mark.parametrize(("rate", "status"), [(2.0, Status.FAIL), (2.15, Status.FAIL), (2.3, Status.NOT_APPLICABLE)])
def test_trip_around_the_rate(frequency, rate, status):
    """A trip is let off by a rate beyond the limit, known to 0.2 Hz/s over a window of 0.1 s."""
    assert frequency(ramp(50.8, rate), disconnected_after_s=0.5).check(KIND).status is status


def test_a_jump_of_the_angle_is_no_frequency(frequency):
    """A jump of 60 degrees reads as Hertz for two cycles, which are left out."""
    jump = {"kind": "phase_jump", "t_s": 0.1, "angle_deg": 60}
    assert frequency(jump, disconnected_after_s=0.5).check(KIND).status is Status.NOT_APPLICABLE
    check = frequency(jump, ramp(50.9, t_s=0.2), disconnected_after_s=1.2).check(KIND)
    assert check.status is Status.FAIL
    assert "furthest 50.90 Hz" in check.message


SOURCE = ("u0_a_v", "u0_b_v", "u0_c_v")


def swing(lasts_s, size_rad=0.5, rate_hz=4.0):
    """An angle that swings while a sag lasts, and dies away within five cycles: up to 2 Hz at either side."""
    fading = lambda t: np.where(t < lasts_s, 1.0, np.exp(-(t - lasts_s) / 0.008))  # noqa: E731
    return lambda t: size_rad * (t > 0) * fading(t) * np.sin(2 * np.pi * rate_hz * t)


@pytest.mark.parametrize("phases", ["abc", "bc", "a"])
def test_swinging_terminals_are_no_frequency(profile_with, bench, phases):
    """Behind an impedance the current turns the terminals in a sag; the grid stays at 50 Hz, source recorded or not."""
    bands = {"rows": BANDS, "clause": "7.1", "confidence": "code", "source": "a test"}
    profile = profile_with(KIND, {"clause": "7", "source": "a test", "bands": bands})
    for missing in ((), SOURCE):
        made = bench(asked=Sag(depth=0.8, phases=phases), duration_s=0.6, profile=profile, p_sag_kw=100,
                     terminals_turn_rad=swing(0.6), without=missing)  # fmt: skip
        evidence = collect(profile, made.test, made.waveforms(), made.nominal, made.available_power_w)
        assert np.nanmax(np.abs(frequency_hz(evidence) - 50)) < 0.01
        with pytest.raises(NotApplicable, match="stays within"):
            FrequencyRideThroughCheck().judge(profile.requirements.frequency_ride_through, evidence)
    assert np.nanmax(np.abs(evidence.tracked_frequency_hz - 50)) > 1.5  # what the terminals read


def test_terminals_show_the_frequency_of_a_normal_voltage(frequency):
    """Without the source the frequency after a sag is that of the terminals, and the message says how it was found."""
    sag = {"kind": "sag", "t_s": 0.0, "duration_s": 0.2, "sag": {"depth": 0.5}}
    made = frequency(sag, ramp(50.9, t_s=0.4), duration_s=1.6, without=SOURCE, disconnected_after_s=1.4)
    demand = made.profile.requirements.frequency_ride_through
    check = judge_alone(KIND, demand, made.waveforms(), made.test.scenario)
    assert check.status is Status.FAIL
    assert "furthest 50.90 Hz" in check.message
    assert "held while their voltage was not normal" in check.message


def test_source_with_hardly_any_voltage_has_no_frequency(profile_with, bench):
    """At 0.02 pu a source that turns at 55 Hz for a while is not believed, at 0.2 pu it is."""
    bands = {"rows": BANDS, "clause": "7.1", "confidence": "code", "source": "a test"}
    profile = profile_with(KIND, {"clause": "7", "source": "a test", "bands": bands})
    events = [{"kind": "frequency_step", "t_s": 0.1, "to_hz": 55}, {"kind": "frequency_step", "t_s": 0.4, "to_hz": 50}]
    for depth, seen_hz in ((0.98, 50.0), (0.8, 55.0)):
        made = bench(depth=depth, duration_s=0.6, profile=profile, scenario={"events": events})
        evidence = collect(profile, made.test, made.waveforms(), made.nominal, made.available_power_w)
        assert np.nanmax(frequency_hz(evidence)) == pytest.approx(seen_hz, abs=0.02)


def test_held_frequency_is_no_rate(frequency):
    """A ramp just inside the limit, held for a while after a dip, is not faster when it shows again."""
    dip = {"kind": "sag", "t_s": 0.1, "duration_s": 0.02, "sag": {"depth": 0.05}}
    check = frequency(dip, ramp(50.95, 1.9), duration_s=1.0, disconnected_after_s=0.6).check(KIND)
    assert check.status is Status.FAIL, check.message
    assert "fastest 1.90 Hz/s" in check.message


def test_blocked_bridge_does_not_ride_through(frequency):
    """Staying connected without current is no ride-through."""
    check = frequency(ramp(50.9), blocked_after_s=0.5).check(KIND)
    assert check.status is Status.FAIL
    assert "bridge blocked" in check.message


def test_connected_throughout_says_the_worst(frequency):
    """A pass names the frequency furthest from nominal and the fastest rate."""
    check = frequency(ramp(51.5, 1.5)).check(KIND)
    assert check.status is Status.PASS
    assert "51.50 Hz" in check.message
    assert "1.50 Hz/s" in check.message
