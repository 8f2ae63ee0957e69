"""Active power in a sag, against eq (10) worked out by hand."""

import math

import numpy as np
import pytest

from pvlvrt_compliance.results import Status
from pvlvrt_compliance.scenario.sag import Sag

KIND = "active_power_support"
NUMBERS = {"tolerance_fraction": 0.02, "voltage_pu": 0.005, "settling_s": 0.1}
SUPPORT = {
    "clip_to_capability": {"value": True, "confidence": "chosen", "source": "the test"},
    "no_support_from_pu": 0.85,
    "tolerance_pu": 0.025,
    "curve": {
        "points": [(0.0, 0.75), (0.5, 0.75), (0.85, 0.0), (1.0, 0.0)],
        "clause": "a clause",
        "confidence": "chosen",
        "source": "the test",
    },
}
SIDES = [(0.2, Status.PASS), (-0.2, Status.FAIL)]


def by_hand_kw(v_positive: float, v_negative: float = 0.0) -> float:
    """Eq (10) at a voltage, with V+ 0.005 pu lower."""
    v = v_positive - 0.005
    q = 0.75 if v < 0.5 else 15 / 7 * (0.85 - v)
    return 500 * math.sqrt(max((v - v_negative) ** 2 - min(q, v - v_negative) ** 2, 0))


@pytest.fixture
def feeding(bench, demanding):
    """Make a record of a sag judged by this check and the curve of reactive power."""

    def make(**settings):
        profile = demanding(active_power_support=NUMBERS, reactive_support=SUPPORT)
        return bench(profile=profile, **settings).check(KIND)

    return make


@pytest.mark.parametrize(("off_kw", "status"), SIDES)
@pytest.mark.parametrize("depth", [0.2, 0.3, 0.4, 0.45, 0.9])
def test_eq_10_in_a_balanced_sag(feeding, depth, off_kw, status):
    """P may be 10 kW below what eq (10) leaves 0.005 pu further down; nothing is due where Q takes all."""
    due_kw = by_hand_kw(1 - depth)
    check = feeding(depth=depth, p_sag_kw=due_kw - 10 + off_kw)
    assert check.status is status, check.message
    assert check.limit == pytest.approx(due_kw, abs=0.02)
    assert check.margin == pytest.approx(off_kw, abs=0.03)
    assert check.margin == pytest.approx(check.measured - (check.limit - check.tolerance))
    assert (check.bound, check.tolerance, check.uncertainty) == ("at_least", 10, 2.5)


def test_where_q_meets_s_fault(feeding):
    """At 0.5795 pu Q = S_fault; 0.005 pu above nothing is demanded yet, as the slope there is infinite."""
    assert by_hand_kw(0.5795 + 0.005) == pytest.approx(0, abs=12)
    assert feeding(depth=1 - 0.5795, p_sag_kw=0.0).limit == 0


@pytest.mark.parametrize(("off_kw", "status"), SIDES)
def test_eq_10_in_an_unbalanced_sag(feeding, off_kw, status):
    """S_fault is (V+ - V-) S: 0.70 pu and 0.30 pu leave 200 kVA."""
    check = feeding(asked=Sag(depth=0.9, phases="c"), p_sag_kw=by_hand_kw(0.7, 0.3) - 10 + off_kw)
    assert check.status is status, check.message


@pytest.mark.parametrize(("off_kw", "status"), SIDES)
def test_from_the_no_support_voltage_on(feeding, off_kw, status):
    """At 0.87 pu no reactive power is wanted and all of (V+ - V-) S is due."""
    assert feeding(depth=0.13, p_sag_kw=0.87 * 500 - 10 + off_kw).status is status


@pytest.mark.parametrize(("off_kw", "status"), SIDES)
def test_no_more_than_before(feeding, off_kw, status):
    """An inverter that fed 100 kW need not feed more."""
    assert feeding(depth=0.2, p_before_kw=100, available_power_w=100e3, p_sag_kw=90 + off_kw).status is status


@pytest.mark.parametrize(("off_kw", "status"), SIDES)
def test_no_more_than_the_array_gives(feeding, off_kw, status):
    """Half of the light gives half of the power."""
    darker = {"events": [{"kind": "irradiance", "t_s": 0.0, "to_w_m2": 500}]}
    check = feeding(depth=0.2, scenario=darker, p_sag_kw=240 + off_kw)
    assert check.status is status
    assert "available" in check.message


@pytest.mark.parametrize("power_kw", [0.0, -50.0])
@pytest.mark.parametrize("depth", [0.3, 0.9])
def test_nothing_and_less(feeding, depth, power_kw):
    """No power fails where some is due, power taken from the grid always does."""
    passes = depth == 0.9 and power_kw == 0
    assert feeding(depth=depth, p_sag_kw=power_kw).status is (Status.PASS if passes else Status.FAIL)


@pytest.mark.parametrize(("off_kw", "status"), SIDES)
def test_second_sag(feeding, off_kw, status):
    """Each sag has its own due, and the gap between has none."""
    due_kw = by_hand_kw(0.7)
    levels = lambda t: np.where(t < 0.4, by_hand_kw(0.8), np.where(t < 0.8, 0.0, due_kw - 10 + off_kw))  # noqa: E731
    second = {"events": [{"kind": "sag", "t_s": 0.8, "duration_s": 0.4, "sag": {"depth": 0.3}}], "after_s": 1.5}
    check = feeding(
        depth=0.2, duration_s=0.4, scenario=second, p_kw=lambda t: np.where((t < 0) | (t > 1.2), 500.0, levels(t))
    )
    assert check.status is status
    assert check.stretch.startswith("second sag, 0.70 pu")


@pytest.mark.parametrize(("off_kw", "status"), SIDES)
def test_swell(feeding, off_kw, status):
    """In a swell what was fed before stays due."""
    swell = {"events": [{"kind": "voltage_profile", "points": [(0, 1), (0, 1.15), (0.4, 1.15), (0.4, 1)]}]}
    assert feeding(depth=0, scenario=swell, p_sag_kw=490 + off_kw, p_after_kw=500.0).status is status


def test_without_a_curve(bench, demanding):
    """Without a demand on the reactive power all of (V+ - V-) S is due."""
    check = bench(depth=0.4, profile=demanding(active_power_support=NUMBERS), p_sag_kw=280.0).check(KIND)
    assert (check.status, check.limit) == (Status.FAIL, pytest.approx(300))


def test_after_a_trip(feeding):
    """What a tripped inverter does not feed is no matter of this check."""
    assert feeding(depth=0.3, p_sag_kw=0.0, disconnected_after_s=0.05).status is Status.NOT_APPLICABLE
    assert feeding(depth=0.3, p_sag_kw=0.0, disconnected_after_s=0.2).status is Status.FAIL


@pytest.mark.parametrize(("p_kw", "status"), [(439.0, Status.FAIL), (441.0, Status.PASS)])
def test_a_shallow_sag_is_a_sag(feeding, p_kw, status):
    """At 0.95 pu of V+ and 0.05 of V- all is normal, and (V+ - V-) S less the tolerance are due all the same."""
    asked = Sag(depth=0.1, phases="bc", two_phase=True)
    check = feeding(asked=asked, p_sag_kw=p_kw)
    assert check.status is status, check.message


def test_normal_voltage_is_let_off(feeding):
    """Without a sag nothing is due."""
    assert feeding(depth=0, p_sag_kw=0.0).status is Status.NOT_APPLICABLE


@pytest.mark.parametrize(
    "event",
    [
        {"kind": "frequency_step", "t_s": 0.0, "to_hz": 50.7},
        {"kind": "phase_jump", "t_s": 0.0, "angle_deg": 20.0},
    ],
)
def test_what_leaves_the_voltage_alone_is_let_off(feeding, event):
    """A power that follows the frequency owes nothing to this check; that V- of the grid is rounded is no sag."""
    check = feeding(depth=0, duration_s=0.8, scenario={"events": [event]}, p_sag_kw=250.0)
    assert check.status is Status.NOT_APPLICABLE, check.message
