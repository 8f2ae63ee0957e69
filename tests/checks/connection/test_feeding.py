"""An inverter that stays connected and feeds nothing, or too little, on both sides of each limit."""

import numpy as np
import pytest

from pvlvrt_compliance.results import Status
from pvlvrt_compliance.scenario.sag import Sag

KIND = "ride_through"
SECOND = {"kind": "sag", "t_s": 1.0, "duration_s": 0.3, "sag": {"depth": 0.25}}
MANDATORY = [
    {"voltage_pu": (0.0, 0.3), "mode": "permissive", "ride_s": 1.0},
    {"voltage_pu": (0.3, 0.88), "mode": "mandatory", "ride_s": 5.0},
    {"voltage_pu": (0.88, 1.1), "mode": "continuous"},
]


def away(begin_s, length_s):
    """A factor on the current that is none for a time."""
    return lambda t: 1.0 - ((t > begin_s) & (t < begin_s + length_s))


@pytest.mark.parametrize("begin_s", [0.05, 1.05, 0.5])
@pytest.mark.parametrize(("length_s", "status"), [(0.019, Status.PASS), (0.024, Status.FAIL)])
def test_a_pause_longer_than_a_cycle(bench, iec, begin_s, length_s, status):
    """In the first sag, in the second, and between them: current is due as long as connection is."""
    made = bench(depth=0.25, duration_s=0.3, profile=iec, scenario={"events": [SECOND]}, p_kw=lambda t: 500 + 0 * t,
                 flows=away(begin_s, length_s))  # fmt: skip
    check = made.check(KIND)
    assert check.status is status, check.message
    if status is Status.FAIL:
        assert f"no current from {0.3 + begin_s:.3f} s" in check.message
        assert check.limit == pytest.approx(0.02)


@pytest.mark.parametrize(("room", "status"), [(0.098, Status.PASS), (0.102, Status.FAIL)])
def test_where_eq_8_leaves_no_room_none_is_due(bench, iec, room, status):
    """With V+ - V- below 0.10 pu without the inverter's current nothing has to flow."""
    made = bench(asked=Sag(depth=1 - room), duration_s=0.15, profile=iec, flows=away(0.0, 0.15))
    found = made.check(KIND)
    assert found.status is status, found.message


def test_at_night_none_is_due_but_support(bench, iec):
    """Without power available nothing flows in a healthy grid; in a sag support is due all the same."""
    settings = {"available_power_w": 0.0, "p_before_kw": 0.0, "p_after_kw": 0.0, "p_sag_kw": 0.0, "profile": iec}
    made = bench(depth=0.5, duration_s=0.3, q_sag_kvar=250, **settings)
    assert "no current" not in made.check(KIND).message
    dead = bench(depth=0.5, duration_s=0.3, q_sag_kvar=0.0, **settings)
    assert "no current" in dead.check(KIND).message or dead.check(KIND).status is Status.NOT_EVALUATED


@pytest.fixture
def least(profile_with):
    """Make a profile of regions with a least current."""

    def make(fraction=0.8, of="apparent", settling_s=None, **more):
        number = {"value": fraction, "confidence": "code", "source": "a test"}
        table = {
            "low_quantity": "lowest_phase",
            "high_quantity": "highest_phase",
            "rows": MANDATORY,
            "clause": "T",
            "least_current_fraction": number,
            "least_current_of": of,
            "confidence": "code",
            "source": "a test",
        }
        if settling_s is not None:
            table["least_current_settling_s"] = number | {"value": settling_s}
        return profile_with(KIND, {"clause": "6.4", "source": "a test", "regions": table,
                                   "envelope_tolerance_pu": 0.001} | more)  # fmt: skip

    return make


def power_for(share, level, begin_s=0.0, end_s=0.3):
    """Active power (kW) of a share of the current before, at a voltage, for a time; 500 kW before and after."""
    return lambda t: np.where((t >= begin_s) & (t < end_s), 500 * level * share, 500.0)


@pytest.mark.parametrize("of", ["apparent", "largest_phase"])
@pytest.mark.parametrize("begin_s", [0.0, 1.0])
@pytest.mark.parametrize(("share", "status"), [(0.805, Status.PASS), (0.795, Status.FAIL)])
def test_least_current_in_mandatory_operation(bench, least, share, status, begin_s, of):
    """A share of the current before, in the first sag and in the second, of balanced currents alike."""
    full = power_for(1.0, 0.75, 1.0 - begin_s, 1.3 - begin_s)
    weak = power_for(share, 0.75, begin_s, begin_s + 0.3)
    made = bench(depth=0.25, duration_s=0.3, profile=least(of=of), scenario={"events": [SECOND]},
                 p_kw=lambda t: np.minimum(full(t), weak(t)))  # fmt: skip
    check = made.check(KIND)
    assert check.status is status, check.message
    if status is Status.FAIL:
        assert (check.measured, check.limit) == (pytest.approx(share, abs=2e-3), pytest.approx(0.8, abs=1e-3))
        assert check.bound == "at_least"


@pytest.mark.parametrize("begin_s", [0.0, 1.0])
@pytest.mark.parametrize(
    ("settling_s", "weak_s", "status"),
    [(None, 0.01, Status.FAIL), (0.05, 0.028, Status.PASS), (0.05, 0.06, Status.FAIL), (0.001, 0.01, Status.FAIL)],
)
def test_least_current_settles(bench, least, settling_s, weak_s, status, begin_s):
    """It counts from the profile's time after each step on, and never before a one-cycle quantity has settled."""
    weak = power_for(0.3, 0.75, begin_s, begin_s + weak_s)
    full = power_for(1.0, 0.75, begin_s, begin_s + 0.3)
    other = power_for(1.0, 0.75, 1.0 - begin_s, 1.3 - begin_s)
    made = bench(depth=0.25, duration_s=0.3, profile=least(settling_s=settling_s), scenario={"events": [SECOND]},
                 p_kw=lambda t: np.minimum(np.minimum(full(t), weak(t)), other(t)))  # fmt: skip
    check = made.check(KIND)
    assert check.status is status, check.message


@pytest.mark.parametrize(("back_s", "status"), [(0.38, Status.PASS), (0.45, Status.FAIL)])
def test_after_a_region_that_lets_feeding_pause(bench, least, back_s, status):
    """Mandatory operation after a permissive region counts from the time of recovery on."""
    points = [(0, 1), (0, 0.2), (0.2, 0.2), (0.2, 0.75), (1.0, 0.75), (1.0, 1)]
    profile = least(recovery_fraction={"value": 0.8, "confidence": "code", "source": "a test"},
                    recovery_time_s={"value": 0.4, "confidence": "code", "source": "a test"})  # fmt: skip
    made = bench(depth=0, duration_s=1.0, profile=profile,
                 scenario={"events": [{"kind": "voltage_profile", "points": points}]},
                 p_kw=lambda t: np.where(t < 0, 500.0, np.where(t < 1.0, 375.0, 500.0)),
                 flows=away(0.02, 0.18 + back_s))  # fmt: skip
    check = made.check(KIND)
    assert check.status is status, check.message
