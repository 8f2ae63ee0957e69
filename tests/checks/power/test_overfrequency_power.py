"""Power that follows a frequency above a threshold, on both sides of its tolerance."""

import numpy as np
import pytest
from frequencies import ramp

from pvlvrt_compliance.results import Status

LFSM = {"clause": "5.1", "source": "a test", "threshold_hz": 50.2, "droop_fraction": 0.05, "activation_s": 0.3,
        "tolerance_fraction": 0.05}  # fmt: skip


def droop_kw(off_kw, lag_s=0.0):
    """Power by a droop of 5 % above 50.2 Hz on a ramp of 1 Hz/s to 51 Hz and an offset."""
    return lambda t: 500 * (1 - np.clip(t - lag_s - 0.2, 0, 0.8) / 2.5) + off_kw * (t > 0.2)


@pytest.mark.parametrize(
    ("off_kw", "status"), [(21, Status.PASS), (-21, Status.PASS), (26, Status.FAIL), (-29, Status.FAIL)]
)
def test_power_over_frequency(bench, profile_with, off_kw, status):
    """P must lie within 5 % of rated power of the droop's, on either side (a ramp is seen 4 kW late)."""
    made = bench(depth=0, duration_s=2, profile=profile_with("overfrequency_power", LFSM), p_kw=droop_kw(off_kw),
                 scenario={"events": [ramp(51.0)]})  # fmt: skip
    check = made.check("overfrequency_power")
    assert check.status is status, check.message
    assert check.limit == 25
    assert check.measured == pytest.approx(abs(off_kw), abs=4.1)


@pytest.mark.parametrize(("activated_s", "status"), [(0.49, Status.PASS), (0.54, Status.FAIL)])
def test_power_within_the_time_of_activation(bench, profile_with, activated_s, status):
    """Nothing is judged until the frequency has been above the threshold for the time of activation."""
    power = lambda t: np.where(t < activated_s, 500.0, droop_kw(0)(t))  # noqa: E731
    made = bench(depth=0, duration_s=2, profile=profile_with("overfrequency_power", LFSM), p_kw=power,
                 scenario={"events": [ramp(51.0)]})  # fmt: skip
    assert made.check("overfrequency_power").status is status


@pytest.mark.parametrize(("to_hz", "lasts_s"), [(50.19, 2.0), (50.4, 0.2)])
def test_frequency_that_asks_for_nothing(bench, profile_with, to_hz, lasts_s):
    """A frequency below the threshold, or above it for too short a time, is not judged."""
    events = [ramp(to_hz, 5.0), ramp(50.0, 5.0, lasts_s, to_hz)]
    made = bench(depth=0, duration_s=2.2, profile=profile_with("overfrequency_power", LFSM), p_sag_kw=500,
                 scenario={"events": events})  # fmt: skip
    assert made.check("overfrequency_power").status is Status.NOT_APPLICABLE


def test_droop_is_drawn_over_the_frequency(bench, profile_with):
    """From the threshold to the highest frequency: P before less 40 % a hertz, within 25 kW, nothing below 0."""
    for to_hz, rate in ((51.0, 1.0), (53.0, 4.0)):
        power = lambda t, rate=rate, to_hz=to_hz: 500 * (1 - np.clip((rate * t - 0.2) / 2.5, 0, (to_hz - 50.2) / 2.5))  # noqa: E731
        result = bench(depth=0, duration_s=2, profile=profile_with("overfrequency_power", LFSM), p_kw=power,
                       scenario={"events": [ramp(to_hz, rate)]}).result()  # fmt: skip
        (droop,) = result.characteristics
        assert (droop.over, droop.quantity) == ("frequency_hz", "active_power_kw")
        assert droop.x[0] == 50.2
        assert droop.x[-1] == pytest.approx(to_hz, abs=0.01)
        due = 500 * np.maximum(1 - (np.array(droop.x) - 50.2) / 2.5, 0)
        assert np.array(droop.lower) == pytest.approx(due - 25, abs=0.5)
        assert np.array(droop.upper) == pytest.approx(due + 25, abs=0.5)
        assert (52.7 in droop.x) == (to_hz > 52.7)
