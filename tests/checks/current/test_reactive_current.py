"""Additional reactive current of both sequences, just inside and just outside of its band."""

from typing import Any

import numpy as np
import pytest
from demands import DETECTION, K_FACTOR

from pvlvrt_compliance.checks.current.reactive_current import beyond_dead_band
from pvlvrt_compliance.results import Status
from pvlvrt_compliance.scenario.events import VoltageProfile
from pvlvrt_compliance.scenario.sag import Sag

TWO_PHASE = Sag(depth=0.5, phases="bc", two_phase=True)  # V+ = 0.75, V- = 0.25
INSIDE_AND_OUTSIDE = [(-0.002, Status.FAIL), (0.002, Status.PASS)]


@pytest.fixture
def supporting(bench, demanding):
    """Make a record of a sag through which an additional reactive current of the positive sequence flows (pu)."""

    def make(current_pu: float, asked: Sag, changed: dict[str, Any] | None = None, **settings: Any):
        kinds = settings.pop("kinds", ("reactive_current",))
        profile = demanding(
            detection=settings.pop("detection", None),
            tolerance_pu=settings.pop("tolerance_pu", 0.05),
            **{kind: K_FACTOR | (changed or {}) for kind in kinds},
        )
        shown = settings.get("sag") or asked
        before_kvar = settings.get("q_before_kvar", 0.0)
        v_positive = abs(Sag.phasors_pu(shown)[0]) if shown.phases == "abc" else 0.75
        v_positive = settings.pop("v_positive", v_positive)
        q_kvar = 500 * v_positive * (current_pu + before_kvar / 500)
        return bench(asked=asked, profile=profile, q_sag_kvar=q_kvar, **settings)

    return make


@pytest.mark.parametrize(("inside_by", "status"), INSIDE_AND_OUTSIDE)
@pytest.mark.parametrize(
    ("depth", "changed", "demand"),
    [
        (0.3, {}, 0.6),
        (0.3, {"dead_band_mode": "shift"}, 0.4),
        (0.3, {"dead_band_mode": "step"}, 0.6),
        (0.09, {"dead_band_mode": "step"}, 0.0),
        (0.09, {"dead_band_mode": "shift"}, 0.0),
        (0.7, {}, 1.0),  # 1.4 clipped
        (0.7, {"limit_pu": 1.1}, 1.1),
    ],
)
def test_band_around_the_demand(supporting, depth, changed, demand, inside_by, status):
    """The mean may be 0.1 pu below K f(delta u), clipped at the limit, and 0.2 pu above it."""
    low = supporting(demand - 0.1 + inside_by, Sag(depth=depth), changed).check("reactive_current")
    assert low.status is status
    assert low.limit == pytest.approx(demand - 0.1, abs=1e-3)
    high = supporting(demand + 0.2 - inside_by, Sag(depth=depth), changed).check("reactive_current")
    assert high.status is status
    assert high.limit == pytest.approx(demand + 0.2, abs=1e-3)
    for check in (low, high):
        assert check.margin == pytest.approx(inside_by, abs=1e-3)
        assert check.unit == "pu"
        assert 0.4 <= check.at_s <= 0.6


@pytest.mark.parametrize(("inside_by", "status"), INSIDE_AND_OUTSIDE)
def test_k_of_the_test_counts(supporting, inside_by, status):
    """A test that is run with a K of its own is judged by that."""
    made = supporting(0.3 * 3 - 0.1 + inside_by, Sag(depth=0.3))
    made.test = made.test.model_copy(update={"k_factor": 3.0})
    assert made.check("reactive_current").status is status


@pytest.mark.parametrize(("reference", "demand"), [("prefault", 0.7), ("nominal", 0.6)])
@pytest.mark.parametrize(("inside_by", "status"), INSIDE_AND_OUTSIDE)
def test_reference(supporting, reference, demand, inside_by, status):
    """Delta u counts from the voltage before the sag, here 1.05 pu, or from nominal."""
    made = supporting(demand - 0.1 + inside_by, Sag(depth=0.3), {"reference": reference}, healthy_pu=1.05)
    assert made.check("reactive_current").status is status


@pytest.mark.parametrize(("inside_by", "status"), INSIDE_AND_OUTSIDE)
@pytest.mark.parametrize(("before_kvar", "demand"), [(150, 0.7), (-150, 0.875)])
def test_current_before_the_sag_counts_towards_the_limit(supporting, before_kvar, demand, inside_by, status):
    """With 0.3 pu flowing already, 0.7 pu are left of the limit; with -0.3 pu all that K asks for."""
    made = supporting(demand - 0.1 + inside_by, Sag(depth=0.25), {"k": 3.5}, q_before_kvar=before_kvar)
    assert made.check("reactive_current").status is status


@pytest.mark.parametrize(("inside_by", "status"), INSIDE_AND_OUTSIDE)
def test_both_sequences_are_clipped_in_proportion(supporting, inside_by, status):
    """K = 3.5 asks for 0.875 pu of both sequences; together they have 1 pu, hence 0.5 each."""
    kinds = ("reactive_current", "negative_sequence_current")
    for edge, sign in ((0.4, 1), (0.7, -1)):
        current_pu = edge + sign * inside_by
        made = supporting(current_pu, TWO_PHASE, {"k": 3.5}, kinds=kinds, negative_reactive_pu=current_pu)
        checks = {check.check: check for check in made.result().checks}
        assert {checks[kind].status for kind in kinds} == {status}
        assert [checks[kind].limit for kind in kinds] == pytest.approx([edge, edge], abs=1e-3)


@pytest.mark.parametrize(("inside_by", "status"), INSIDE_AND_OUTSIDE)
def test_positive_sequence_alone(supporting, inside_by, status):
    """A profile that asks nothing of the negative sequence leaves the whole limit to the positive one."""
    made = supporting(0.775 + inside_by, TWO_PHASE, {"k": 3.5})
    assert made.check("reactive_current").status is status


@pytest.mark.parametrize(("inside_by", "status"), INSIDE_AND_OUTSIDE)
def test_negative_sequence(supporting, inside_by, status):
    """V- of 0.25 pu asks for 0.5 pu that lowers V-; the same current the other way round fails."""
    kinds = ("negative_sequence_current",)
    for edge, sign in ((0.4, 1), (0.7, -1)):
        made = supporting(0, TWO_PHASE, kinds=kinds, negative_reactive_pu=edge + sign * inside_by)
        assert made.check(kinds[0]).status is status
    reversed_check = supporting(0, TWO_PHASE, kinds=kinds, negative_reactive_pu=-0.5).check(kinds[0])
    assert reversed_check.measured == pytest.approx(-0.5, abs=1e-3)
    assert reversed_check.status is Status.FAIL


@pytest.mark.parametrize(("inside_by", "status"), INSIDE_AND_OUTSIDE)
@pytest.mark.parametrize(("edge", "sign"), [(-0.1, 1), (0.4, -1)])
def test_without_a_voltage_event(supporting, edge, sign, inside_by, status):
    """At 0.90 pu nothing is demanded and following K is allowed: from -0.1 pu to 0.2 pu above K delta u."""
    made = supporting(edge + sign * inside_by, Sag(depth=0.1), detection=DETECTION)
    check = made.check("reactive_current")
    assert check.status is status
    assert "without a voltage event" in check.message


def test_below_detection_support_is_demanded(supporting):
    """At 0.80 pu the event is one, and no support fails."""
    assert supporting(0.0, Sag(depth=0.2), detection=DETECTION).check("reactive_current").status is Status.FAIL


@pytest.mark.parametrize(("inside_by", "status"), INSIDE_AND_OUTSIDE)
@pytest.mark.parametrize(("edge", "sign"), [(-0.3, -1), (-0.6, 1)])
@pytest.mark.parametrize("detection", [None, DETECTION | {"enter_above_pu": 1.1, "leave_below_pu": 1.1}])
def test_swell(supporting, edge, sign, inside_by, status, detection):
    """At 1.2 pu 0.4 pu of under-excited current are demanded; the wider side of the band is that of more support."""
    voltage = VoltageProfile(points=((0.0, 1.2), (0.3, 1.2), (0.3, 1.0)))
    settings = {"v_positive": 1.2, "scenario": {"events": (voltage,)}, "detection": detection, "p_sag_kw": 400.0}
    made = supporting(edge + sign * inside_by, Sag(depth=0.0), **settings)
    assert made.check("reactive_current").status is status


@pytest.mark.parametrize(("inside_by", "status"), INSIDE_AND_OUTSIDE)
@pytest.mark.parametrize("level", [0.9998, 1.0002])
def test_a_voltage_that_stands_still_has_one_band(supporting, level, inside_by, status):
    """Where the voltage is what it was but for rounding, no noise decides which side is that of more support."""
    voltage = VoltageProfile(points=((0.0, level), (0.3, level), (0.3, 1.0)))
    settings = {"v_positive": level, "scenario": {"events": (voltage,)}, "changed": {"dead_band_mode": "step"}}
    for edge, sign in ((0.2, -1), (-0.1, 1)):
        made = supporting(edge + sign * inside_by, Sag(depth=0.0), **settings)
        assert made.check("reactive_current").status is status


@pytest.mark.parametrize(("depth", "status"), [(0.81, Status.NOT_APPLICABLE), (0.79, Status.FAIL)])
def test_blocked_bridge(supporting, depth, status):
    """No current at all is let off below 0.2 pu and nowhere else."""
    check = supporting(0, Sag(depth=depth), p_sag_kw=0.0).check("reactive_current")
    assert check.status is status
    assert ("blocked" in check.message) == (status is Status.NOT_APPLICABLE)


def test_no_voltage_has_no_reactive_current(supporting):
    """Current into a dead short cannot be told active from reactive; nor can that of a sequence without voltage."""

    def flowing(t: np.ndarray) -> np.ndarray:
        angle = 2 * np.pi * 50 * t + np.array([0, -2, 2])[:, np.newaxis] * np.pi / 3
        return 0.5 * ((t >= 0.3) & (t < 0.6)) * np.cos(angle)

    check = supporting(0, Sag(depth=1), extra_current_pu=flowing).check("reactive_current")
    assert check.status is Status.NOT_APPLICABLE
    kinds = ("negative_sequence_current",)
    assert supporting(0, Sag(depth=0.3), kinds=kinds).check(kinds[0]).status is Status.NOT_APPLICABLE


def test_short_sag_is_not_judged(supporting):
    """A sag without a window has no mean."""
    assert supporting(0, Sag(depth=0.3), duration_s=0.11).check("reactive_current").status is Status.NOT_APPLICABLE


@pytest.mark.parametrize("channel", ["i_b_a", "u_c_v"])
def test_missing_numbers(supporting, channel):
    """A sample that is no number makes the current unknown."""
    made = supporting(0.6, Sag(depth=0.3), spoiled={channel: 0.45})
    assert made.check("reactive_current").status is Status.NOT_EVALUATED


@pytest.mark.parametrize("sign", [-1, 1])
def test_three_readings_of_a_dead_band(sign):
    """Around the edge of the band none goes on, shift begins at zero, step jumps."""
    for du, expected in ((0.05, (0.05, 0, 0)), (0.1, (0.1, 0, 0)), (0.3, (0.3, 0.2, 0.3))):
        found = [beyond_dead_band(sign * du, 0.1, mode) for mode in ("none", "shift", "step")]
        assert found == pytest.approx([sign * x for x in expected])
