"""Recovery by depth, consumption by zone and ripple of the active power, at both sides of every limit."""

import numpy as np
import pytest
from demands import CONTROL_STEP_S, MARK

from pvlvrt_compliance.results import Status
from pvlvrt_compliance.scenario.sag import Sag

CYCLE_S = 0.02
RECOVERY = {
    "return_pu": 0.85,
    "first_fraction": 0.95,
    "tolerance_fraction": 0.02,
    "rows": MARK
    | {
        "rows": [
            {"residual_pu": [0.5, 0.85], "first_s": 0.2, "final_extra_s": 0.3},
            {"residual_pu": [0.2, 0.5], "first_s": 0.4, "final_extra_s": 0.3},
            {"residual_pu": [0.0, 0.2], "first_s": 0.6, "final_extra_s": 0.3},
        ]
    },
}
ALL_ZONES = {
    "transient_s": 0.15,
    "reactive_power_a": 0.15,
    "reactive_energy_a_s": 0.01,
    "active_power_b": 0.1,
    "reactive_power_b": 0.05,
    "active_energy_b_s": 0.045,
    "reactive_energy_b_s": 0.04,
    "reactive_energy_c_s": 0.09,
    "reactive_current_c_pu": 1.5,
}
TWO_PHASE = Sag(depth=0.5, phases="bc", two_phase=True)
FAIL_AND_PASS = [(-1, Status.FAIL), (1, Status.PASS)]


@pytest.fixture
def recovering(bench, demanding):
    """Make a record of a sag of all phases after which P is a function of the time since clearing (kW)."""

    def make(p_after_kw, depth=0.4, changed=None, **settings):
        profile = demanding(active_power_recovery=RECOVERY | (changed or {}))
        return bench(depth=depth, profile=profile, p_after_kw=p_after_kw, **settings)

    return make


def returned_s(depth: float) -> float:
    """Time from clearing until V+ over a cycle is back at 0.85 pu."""
    return CYCLE_S * (0.85 - (1 - depth)) / depth


@pytest.mark.parametrize(
    ("depth", "first_s"), [(0.16, 0.2), (0.49, 0.2), (0.51, 0.4), (0.79, 0.4), (0.81, 0.6), (1.0, 0.6)]
)
@pytest.mark.parametrize(("side", "status"), FAIL_AND_PASS)
def test_first_recovery_by_depth(recovering, depth, first_s, side, status):
    """P over a cycle is at 95 % of what it was 0.95 cycles after it came back; the depth chooses the time."""
    come_s = first_s + returned_s(depth) - 0.95 * CYCLE_S - side * 1e-3
    made = recovering(lambda t: np.where(t < come_s, 0.0, 500.0), depth=depth, dt_s=CONTROL_STEP_S)
    check = made.check("active_power_recovery")
    assert check.status is status
    assert check.limit == pytest.approx(first_s)
    assert check.margin == pytest.approx(side * 1e-3, abs=0.1e-3)
    assert check.at_s == pytest.approx(0.6 + returned_s(depth) + check.measured, abs=1e-4)


@pytest.mark.parametrize("level_kw", [480.0, 520.0])
@pytest.mark.parametrize(("side", "status"), FAIL_AND_PASS)
def test_final_value(recovering, level_kw, side, status):
    """From 20 kW off on either side, P over a cycle is within 10 kW half a cycle after the step."""
    come_s = 0.5 + returned_s(0.4) - 0.5 * CYCLE_S - side * 1e-3
    check = recovering(lambda t: np.where(t < come_s, level_kw, 500.0)).check("active_power_recovery")
    assert check.status is status
    assert check.limit == pytest.approx(0.5)
    assert check.margin == pytest.approx(side * 1e-3, abs=0.1e-3)


def test_power_that_falls_again(recovering):
    """What comes back and is lost again has not recovered."""
    check = recovering(lambda t: np.where(t < 0.9, 500.0, 400.0)).check("active_power_recovery")
    assert check.status is Status.FAIL
    assert "not back" in check.message


@pytest.mark.parametrize(("come_s", "status"), [(0.1, Status.PASS), (0.35, Status.FAIL), (0.5, Status.NOT_EVALUATED)])
def test_record_shorter_than_the_times(recovering, come_s, status):
    """P that is back before the record ends has passed or failed; P that is missing may still have come in time."""
    changed = RECOVERY["rows"] | {"rows": [{"residual_pu": [0.0, 1.0], "first_s": 0.3, "final_extra_s": 0.4}]}
    if status is Status.NOT_EVALUATED:
        changed["rows"] = [{"residual_pu": [0.0, 1.0], "first_s": 0.6, "final_extra_s": 0.4}]
    made = recovering(
        lambda t: np.where(t > come_s, 500.0, 50.0), changed={"rows": changed}, scenario={"after_s": 0.45}
    )
    assert made.check("active_power_recovery").status is status


def test_first_recovery_too_late_in_a_short_record(recovering):
    """A record that ends before the final value is due still shows that 95 % came too late."""
    made = recovering(lambda t: np.where(t > 0.25, 480.0, 0.0), scenario={"after_s": 0.45})
    assert made.check("active_power_recovery").status is Status.FAIL


def test_shallow_sag_has_no_row(recovering):
    """A depth that the table leaves out is let off."""
    assert recovering(0.0, depth=0.14).check("active_power_recovery").status is Status.NOT_APPLICABLE


@pytest.mark.parametrize("off_pu", [-1e-5, 0.0, 1e-5])
def test_depth_on_the_edge_of_two_rows(recovering, off_pu):
    """A sag to the edge of two rows is one of the row that begins there, whichever way its voltage is rounded."""
    made = recovering(lambda t: 500.0 * (t > 0.19), depth=0.5 + off_pu)
    assert made.check("active_power_recovery").limit == pytest.approx(0.2)


@pytest.mark.parametrize(("depth", "limit_s"), [(0.45, 0.2), (0.55, 0.4)])
def test_depth_of_a_sag_without_a_window(recovering, depth, limit_s):
    """Of a sag of two cycles the lowest V+ over a cycle is its depth."""
    made = recovering(lambda t: 500.0 * (t > 0.19), depth=depth, duration_s=0.04)
    assert made.check("active_power_recovery").limit == pytest.approx(limit_s)


@pytest.fixture
def consuming(bench, demanding):
    """Make a record of a sag of 0.4 s to 0.5 pu, judged by one limit on what is taken from the grid."""

    def make(limit, asked=None, unbalanced=None, **settings):
        zones = {name: MARK | {"value": ALL_ZONES[name]} for name in ("transient_s", *limit)}
        judged = {"balanced": zones, "unbalanced_from_pu": 0.1} | ({"unbalanced": unbalanced} if unbalanced else {})
        profile = demanding(consumption=judged)
        return bench(asked=asked or Sag(depth=0.5), duration_s=0.4, profile=profile, **settings)

    return make


def taken(size: float, from_s: float, to_s: float):
    """Power taken from the grid between two instants."""
    return lambda t: np.where((t >= from_s) & (t < to_s), -size, 0.0)


@pytest.mark.parametrize(
    ("limit", "channel", "size", "span_s", "at_s"),
    [
        # 75 kvar; 5 kvar s in 0.15 s; 50 kW; 25 kvar; 22.5 kW s and 20 kvar s in 0.25 s; 45 kvar s in 0.15 s; 1.5 pu
        ("reactive_power_a", "q_sag_kvar", 75, (0.04, 0.1), (0.36, 0.4)),
        ("reactive_energy_a_s", "q_sag_kvar", 5 / 0.15, (0, 0.15), (0.3, 0.45)),
        ("active_power_b", "p_sag_kw", 50, (0.2, 0.3), (0.52, 0.6)),
        ("reactive_power_b", "q_sag_kvar", 25, (0.2, 0.3), (0.52, 0.6)),
        ("active_energy_b_s", "p_sag_kw", 90, (0.15, 0.4), (0.45, 0.7)),
        ("reactive_energy_b_s", "q_sag_kvar", 80, (0.15, 0.4), (0.45, 0.7)),
        ("reactive_energy_c_s", "q_after_kvar", 300, (0, 0.15), (0.7, 0.85)),
        ("reactive_current_c_pu", "q_after_kvar", 750, (0.05, 0.1), (0.77, 0.8)),
    ],
)
@pytest.mark.parametrize(("side", "status"), FAIL_AND_PASS)
def test_limits_of_the_zones(consuming, limit, channel, size, span_s, at_s, side, status):
    """Each limit is kept by 0.5 % less than it allows and broken by 0.5 % more."""
    made = consuming((limit,), dt_s=CONTROL_STEP_S, **{channel: taken(size * (1 - 0.005 * side), *span_s)})
    check = made.check("consumption")
    assert check.status is status
    assert check.margin == pytest.approx(side * 0.005 * check.limit, abs=1e-3 * check.limit)
    assert at_s[0] <= check.at_s <= at_s[1] + 1e-9


@pytest.mark.parametrize(
    ("limit", "channel", "span_s"),
    [
        (("reactive_power_a", "reactive_energy_a_s"), "q_sag_kvar", (0.15, 0.4)),
        (("reactive_power_b", "reactive_energy_b_s"), "q_sag_kvar", (0, 0.15)),
        (("active_power_b", "active_energy_b_s"), "p_sag_kw", (0, 0.15)),
        (("reactive_energy_c_s", "reactive_current_c_pu"), "q_after_kvar", (0.15, 0.5)),
    ],
)
def test_other_zones_do_not_count(consuming, limit, channel, span_s):
    """What is taken outside of a zone is not the zone's, but for the half sample that a step may fall in."""
    check = consuming(limit, dt_s=CONTROL_STEP_S, **{channel: taken(1000, *span_s)}).check("consumption")
    assert check.status is Status.PASS
    assert check.measured == pytest.approx(0, abs=1000 * 0.5 * CONTROL_STEP_S / CYCLE_S)


def test_what_is_fed_makes_up_for_nothing(consuming):
    """Cycles that feed reactive energy are not set against cycles that take it."""
    made = consuming(("reactive_energy_a_s",), q_sag_kvar=lambda t: np.where(t < 0.08, -100.0, 200.0))
    assert made.check("consumption").measured == pytest.approx(8.0, abs=0.02)


def test_nearest_limit_is_reported(consuming):
    """Of several limits the one with the least margin for its size is reported."""
    q = lambda t: np.where(t < 0.15, -20.0, -24.0)  # noqa: E731
    check = consuming(tuple(ALL_ZONES)[1:], q_sag_kvar=q).check("consumption")
    assert check.message.startswith("zone B: reactive power")
    assert check.margin == pytest.approx(1.0, abs=0.01)


def test_unbalanced_fault_has_limits_of_its_own(consuming):
    """V- of 0.25 pu makes a fault unbalanced; without limits for those nothing is judged."""
    settings = {"asked": TWO_PHASE, "q_sag_kvar": taken(30, 0.2, 0.3)}
    assert consuming(("reactive_power_b",), **settings).check("consumption").status is Status.NOT_APPLICABLE
    for fraction, status in ((0.0599, Status.FAIL), (0.0601, Status.PASS)):
        zones = {"transient_s": MARK | {"value": 0.15}, "reactive_power_b": MARK | {"value": fraction}}
        assert consuming((), unbalanced=zones, **settings).check("consumption").status is status


@pytest.mark.parametrize(("taken_kvar", "status"), [(0.0, Status.PASS), (0.1, Status.FAIL)])
def test_limit_of_nothing_at_all(bench, demanding, taken_kvar, status):
    """A limit of zero is kept by nothing taken, whatever rounding says."""
    zones = {"transient_s": MARK | {"value": 0.15}, "reactive_power_b": MARK | {"value": 0.0}}
    profile = demanding(consumption={"balanced": zones, "unbalanced_from_pu": 0.1})
    made = bench(profile=profile, duration_s=0.4, p_sag_kw=0.0 if taken_kvar == 0 else 100.0, q_sag_kvar=-taken_kvar)
    assert made.check("consumption").status is status


def test_record_that_ends_in_a_zone(consuming):
    """The transient after clearing must be in the record."""
    made = consuming(("reactive_energy_c_s",), scenario={"after_s": 0.14})
    assert made.check("consumption").status is Status.NOT_EVALUATED


@pytest.mark.parametrize(("side", "status"), FAIL_AND_PASS)
def test_constant_power(bench, demanding, side, status):
    """Negative-sequence current n against a V+ of 0.5 pu swings P by 0.5 n S at twice the frequency."""

    def swinging(t: np.ndarray) -> np.ndarray:
        angle = 2 * np.pi * 50 * t + np.array([0, 2, -2])[:, np.newaxis] * np.pi / 3
        return (0.1 - side * 1e-3) * ((t >= 0.3) & (t < 0.6)) * np.cos(angle)

    made = bench(profile=demanding(constant_power={"limit_fraction": 0.05}), extra_current_pu=swinging, p_sag_kw=100.0)
    check = made.check("constant_power")
    assert check.status is status
    assert (check.limit, check.unit) == (25.0, "kW")
    assert check.margin == pytest.approx(side * 0.25, abs=0.01)


def test_constant_power_of_a_short_sag(bench, demanding):
    """Without a window there is no ripple to measure."""
    made = bench(profile=demanding(constant_power={"limit_fraction": 0.05}), duration_s=0.1)
    assert made.check("constant_power").status is Status.NOT_APPLICABLE
