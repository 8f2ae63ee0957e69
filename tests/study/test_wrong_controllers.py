"""Every wrong controller or plant fails the check that is made for it, and no other."""

import pytest

from pvlvrt_compliance.results import Status
from validation.mutations.wrong_controllers import Wrong, wrong_run

SAGS = ("three-phase 90 %", "phase c 90 %", "phase c 50 %")
AFTER_A_TRIP = {"active_power_support", "dc_ripple", "oscillation", "reactive_support", "return_to_prefault"}
"""What a trip within milliseconds leaves nothing of to judge; the current is limited up to it."""


def found(result):
    """Names of the checks by verdict, passes left out."""
    verdicts = {}
    for check in result.checks:
        if check.status is not Status.PASS:
            verdicts.setdefault(check.status, set()).add(check.check)
    return verdicts


@pytest.mark.parametrize("frequency_hz", [50.0, 60.0])
@pytest.mark.parametrize("sag", SAGS)
def test_the_papers_control_passes(judge, sag, frequency_hz):
    """The paper's own control passes every check in its three sags, at 50 and 60 Hz."""
    assert found(judge(sag, frequency_hz=frequency_hz)) == {}


@pytest.mark.parametrize("sag", SAGS)
def test_no_reactive_support(judge, wrong_runs, sag):
    """A controller that spends S_fault on active power alone fails reactive support, whatever the sag."""
    assert found(judge(sag, wrong_runs["no_reactive_support"])) == {Status.FAIL: {"reactive_support"}}


@pytest.mark.parametrize("frequency_hz", [50.0, 60.0])
def test_balanced_currents(judge, frequency_hz):
    """Balanced currents let the active power swing at 2f, and the DC voltage with it."""
    result = judge("phase c 90 %", assignments=["controller.power_strategy=balanced"], frequency_hz=frequency_hz)
    assert found(result) == {Status.FAIL: {"dc_ripple"}}


def test_no_current_limit(judge):
    """All that the array gives at 800 W/m2 is too much current at 0.833 pu, and nothing else is wrong."""
    result = judge("phase c 50 %", wrong_run(Wrong.NO_CURRENT_LIMIT), irradiance_w_m2=800)
    assert found(result) == {Status.FAIL: {"current_limit"}}


def test_no_current_limit_at_full_power(judge):
    """Nominal power at 0.833 pu is too much current, and swings the DC voltage as the closed form says.

    Constant power at the PCC leaves the swing of the filter's energy to the DC link: an amplitude of
    2w L |i+| |i-| / (2w C v_DC) = L |i+| |i-| / (C v_DC), where |i-| / |i+| = V- / V+ by eq (5). It is beyond 0.15 %
    in any plant with this filter and this capacitor.
    """
    result = judge("phase c 50 %", wrong_run(Wrong.NO_CURRENT_LIMIT))
    assert found(result) == {Status.FAIL: {"current_limit", "dc_ripple"}}
    window = result.measurements.during
    v_pos, v_neg = 398.37 * window.voltage_positive_pu, 398.37 * window.voltage_negative_pu
    i_pos = 1e3 * window.active_power_kw * v_pos / (v_pos**2 - v_neg**2)
    swing_v = 0.15e-3 * i_pos * (i_pos * v_neg / v_pos) / (0.065 * window.dc_voltage_mean_v)
    assert window.dc_voltage_2f_percent == pytest.approx(100 * swing_v / window.dc_voltage_mean_v, rel=0.03)


def test_no_current_limit_trips_in_a_deep_sag(judge):
    """Nominal power at 0.1 pu trips the inverter: a failed ride-through, and nothing left to judge."""
    result = judge("three-phase 90 %", wrong_run(Wrong.NO_CURRENT_LIMIT))
    assert found(result) == {
        Status.FAIL: {"ride_through"},
        Status.NOT_APPLICABLE: AFTER_A_TRIP,
    }
    trip = next(check for check in result.checks if check.check == "ride_through")
    assert trip.measured < 0.05
    assert trip.limit == pytest.approx(0.309, abs=5e-4)
    assert trip.margin < 0


def test_overcurrent_relay_set_too_low(judge):
    """A relay at 1.1 pu trips on the first peak of a sag that must be ridden through."""
    result = judge("three-phase 90 %", assignments=["protection.overcurrent_pu=1.1"])
    verdicts = found(result)
    assert verdicts[Status.FAIL] == {"ride_through"}
    assert verdicts[Status.NOT_APPLICABLE] == AFTER_A_TRIP
    last = next(check for check in result.checks if check.check == "return_to_prefault")
    assert "after the trip at 0.30" in last.message


@pytest.mark.parametrize("sag", SAGS)
def test_bridge_blocked_for_good(judge, wrong_runs, sag):
    """A bridge that blocks for good fails ride-through, though the breaker stays closed, and what is due in a sag."""
    due = {"reactive_support"} if sag == "three-phase 90 %" else {"reactive_support", "active_power_support"}
    assert due | {"ride_through"} <= found(judge(sag, wrong_runs["bridge_blocked"]))[Status.FAIL]


@pytest.mark.parametrize("sag", SAGS)
def test_dc_voltage_regulator_with_reversed_sign(judge, sag):
    """An inverter that feeds nothing before the sag is not tested at all: nothing is evaluated."""
    result = judge(sag, wrong_run(Wrong.DC_SIGN_REVERSED))
    assert {check.status for check in result.checks} == {Status.NOT_EVALUATED}


def test_a_number_that_stops_being_finite(judge, wrong_runs):
    """A simulation that breaks down is an error on every check, with the simulated time."""
    result = judge("three-phase 90 %", wrong_runs["not_a_number"])
    assert {check.status for check in result.checks} == {Status.ERROR}
    assert all("finite at 0.5" in check.message for check in result.checks)


def test_sag_longer_than_the_envelope(long_sag):
    """Protection may let go once the envelope has: connected for 0.36 s where 0.309 s are demanded."""
    check = next(c for c in long_sag.checks if c.check == "ride_through")
    assert check.status is Status.PASS
    assert (check.measured, check.limit) == (pytest.approx(0.360, abs=1e-3), pytest.approx(0.309, abs=5e-4))
    assert "connected for 0.360 s; the envelope demands 0.309 s" in check.message


def test_early_trip_in_a_long_sag(long_sag_early_trip):
    """Opening before the envelope lets go is a failure, however long the sag lasts."""
    check = next(c for c in long_sag_early_trip.checks if c.check == "ride_through")
    assert check.status is Status.FAIL
    assert check.limit == pytest.approx(0.309, abs=5e-4)
    assert check.measured < check.limit
