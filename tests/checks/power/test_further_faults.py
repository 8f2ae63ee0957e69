"""What powers and ripple must do in every fault of a record, and up to a trip, on both sides of each limit."""

import numpy as np
import pytest
from demands import MARK

from pvlvrt_compliance.results import Status

SIDES = [(0.99, Status.PASS), (1.01, Status.FAIL)]
SECOND_S = 0.9
"""Start of the second sag; both last 0.4 s."""
TWO_SAGS = {
    "events": [{"kind": "sag", "t_s": SECOND_S, "duration_s": 0.4, "sag": {"depth": 0.4}}],
    "after_s": 1.6,
}


@pytest.fixture
def two_sags(bench, demanding):
    """Make a record of a sag to 0.5 pu and one to 0.6 pu, judged by one requirement."""

    def make(kind, numbers, **settings):
        made = bench(
            duration_s=0.4, profile=demanding(**{kind: numbers}), scenario=TWO_SAGS, p_sag_kw=100.0, **settings
        )
        return made.check(kind)

    return make


def twice_as_fast(from_s: float, to_s: float, size_pu: float):
    """Negative-sequence current between two instants from the start of the first sag."""

    def current(t: np.ndarray) -> np.ndarray:
        angle = 2 * np.pi * 50 * t + np.array([0, 2, -2])[:, np.newaxis] * np.pi / 3
        return size_pu * ((t >= 0.3 + from_s) & (t < 0.3 + to_s)) * np.cos(angle)

    return current


@pytest.mark.parametrize(("times", "status"), SIDES)
@pytest.mark.parametrize(
    ("from_s", "v_pu", "stretch"), [(0.0, 0.5, "first sag"), (SECOND_S, 0.6, "second sag")], ids=["first", "second"]
)
def test_ripple_of_the_power_in_each_sag(two_sags, from_s, v_pu, stretch, times, status):
    """Current n of the negative sequence against V+ swings P by n V+ S."""
    extra = twice_as_fast(from_s, from_s + 0.4, times * 0.05 / v_pu)
    check = two_sags("constant_power", {"limit_fraction": 0.05}, extra_current_pu=extra)
    assert check.status is status
    assert check.measured == pytest.approx(times * 25, rel=2e-3)
    assert check.margin == pytest.approx(25 - check.measured)
    assert check.stretch.startswith(stretch)


@pytest.mark.parametrize(("times", "status"), SIDES)
@pytest.mark.parametrize("from_s", [0.0, SECOND_S])
def test_ripple_of_the_dc_voltage_in_each_sag(bench, demanding, from_s, times, status):
    """The second sag's ripple counts as the first one's."""
    made = bench(duration_s=0.4, profile=demanding(dc_ripple={"limit_percent": 0.15}), scenario=TWO_SAGS)
    record = made.waveforms()
    segment = record.segments[0]
    inside = (segment.t_s >= 0.3 + from_s) & (segment.t_s < 0.7 + from_s)
    segment.channels["v_dc_v"] *= 1 + 0.0015 * times * inside * np.cos(2 * np.pi * 100 * segment.t_s)
    made.waveforms = lambda: record
    check = made.check("dc_ripple")
    assert check.status is status, check.message
    assert check.measured == pytest.approx(0.15 * times, rel=3e-3)


def test_ripple_in_a_gap_is_none_of_a_sag(two_sags):
    """Between two sags at normal voltage no ripple is judged."""
    check = two_sags("constant_power", {"limit_fraction": 0.05}, extra_current_pu=twice_as_fast(0.4, SECOND_S, 0.2))
    assert (check.status, check.measured) == (Status.PASS, pytest.approx(0, abs=0.1))


def test_ripple_before_a_trip(two_sags):
    """A ripple has failed, whatever the inverter does later in the sag."""
    settings = {"extra_current_pu": twice_as_fast(0, 0.4, 0.2), "disconnected_after_s": 0.3}
    assert two_sags("constant_power", {"limit_fraction": 0.05}, **settings).status is Status.FAIL
    settings["disconnected_after_s"] = 0.05
    check = two_sags("constant_power", {"limit_fraction": 0.05}, **settings)
    assert check.status is Status.NOT_APPLICABLE


ZONES = {
    "reactive_power_a": (0.15, 75, (0.04, 0.1), "q_kvar"),
    "active_power_b": (0.1, 50, (0.2, 0.3), "p_kw"),
    "reactive_power_b": (0.05, 25, (0.2, 0.3), "q_kvar"),
    "active_energy_b_s": (0.045, 90, (0.15, 0.4), "p_kw"),
    "reactive_energy_c_s": (0.09, 300, (0.4, 0.55), "q_kvar"),
    "reactive_current_c_pu": (1.5, 750, (0.45, 0.5), "q_kvar"),
}
"""Limit, power that reaches it, where it flows in a fault of 0.4 s, and which power it is."""


@pytest.mark.parametrize(("times", "status"), SIDES)
@pytest.mark.parametrize("from_s", [0.0, SECOND_S])
@pytest.mark.parametrize("limit", ZONES)
def test_zones_of_each_fault(two_sags, limit, from_s, times, status):
    """Each fault has zones A, B and C of its own."""
    value, size, (begin_s, end_s), key = ZONES[limit]
    zones = {name: MARK | {"value": x} for name, x in (("transient_s", 0.15), (limit, value))}
    flat = 500.0 if key == "p_kw" else 0.0
    taken = lambda t: np.where((t >= from_s + begin_s) & (t < from_s + end_s), -times * size, flat)  # noqa: E731
    check = two_sags("consumption", {"balanced": zones, "unbalanced_from_pu": 0.1}, **{key: taken})
    assert check.status is status, check.message
    assert check.measured == pytest.approx(times * check.limit, rel=4e-3)
    assert check.uncertainty > 0
    assert check.stretch.startswith("first" if from_s == 0 else "second")


def test_zones_end_with_a_trip(two_sags):
    """What the breaker leaves is none of the inverter's: neither zone B nor zone C goes on after a trip."""
    zones = {name: MARK | {"value": x} for name, x in (("transient_s", 0.15), ("reactive_energy_c_s", 0.0))}
    taken = {"q_kvar": lambda t: np.where(t > 0.2, -100.0, 0.0), "disconnected_after_s": 0.2}
    check = two_sags("consumption", {"balanced": zones, "unbalanced_from_pu": 0.1}, **taken)
    assert check.status is Status.NOT_APPLICABLE


RECOVERY = {
    "return_pu": 0.85,
    "first_fraction": 0.95,
    "tolerance_fraction": 0.02,
    "rows": MARK | {"rows": [{"residual_pu": [0.0, 0.85], "first_s": 0.2, "final_extra_s": 0.1}]},
}


def coming_back(first_s: float, second_s: float):
    """Power that is missing from each clearing for a time."""
    gone = lambda t, at_s, late_s: (t >= at_s) & (t < at_s + late_s)  # noqa: E731
    return lambda t: np.where(gone(t, 0.4, first_s) | gone(t, SECOND_S + 0.4, second_s), 0.0, 500.0)


@pytest.mark.parametrize(
    ("first_s", "second_s", "status", "stretch"),
    [
        (0.15, 0.10, Status.PASS, "first"),
        (0.10, 0.15, Status.PASS, "second"),
        (0.23, 0.10, Status.FAIL, "first"),
        (0.10, 0.23, Status.FAIL, "second"),
    ],
)
def test_recovery_after_each_sag(two_sags, first_s, second_s, status, stretch):
    """Each clearing begins a time of its own; the worst is told."""
    check = two_sags("active_power_recovery", RECOVERY, p_kw=coming_back(first_s, second_s))
    assert check.status is status, check.message
    assert check.stretch.startswith(stretch)
    assert (check.bound, check.uncertainty) == ("at_most", pytest.approx(0.01))
    assert check.margin == pytest.approx(check.limit - check.measured)


@pytest.mark.parametrize(
    ("gap_s", "back_s", "status"),
    [(0.15, 0.05, Status.PASS), (0.15, 0.2, None), (0.3, 0.4, Status.FAIL)],
)
def test_recovery_in_a_gap(bench, demanding, gap_s, back_s, status):
    """In a gap shorter than its time recovery is judged if it is reached; in a longer one it may be missed."""
    second = {"events": [{"kind": "sag", "t_s": 0.4 + gap_s, "duration_s": 0.1, "sag": {"depth": 0.5}}], "after_s": 1.6}
    p_kw = lambda t: np.where((t >= 0.4) & (t < 0.4 + min(gap_s, back_s)), 0.0, 500.0)  # noqa: E731
    check = bench(duration_s=0.4, profile=demanding(active_power_recovery=RECOVERY), scenario=second, p_kw=p_kw).check(
        "active_power_recovery"
    )
    assert check.status is (status or Status.PASS), check.message
    assert check.stretch.startswith("second" if status is None else "first")


def test_recovery_that_a_trip_cuts_off(two_sags):
    """A trip in a fault, or before the time is over, leaves nothing of recovery to judge."""
    for after_s in (0.3, 0.45):
        check = two_sags("active_power_recovery", RECOVERY, p_kw=coming_back(0.5, 0.1), disconnected_after_s=after_s)
        assert check.status is Status.NOT_APPLICABLE, check.message


@pytest.mark.parametrize(("times", "status"), SIDES)
def test_deepest_level_of_a_fault(bench, demanding, times, status):
    """Of a sag within a sag the deeper level says how much time there is."""
    rows = [{"residual_pu": [0.0, 0.4], "first_s": 0.4, "final_extra_s": 0.1}]
    rows += [{"residual_pu": [0.4, 0.85], "first_s": 0.2, "final_extra_s": 0.1}]
    inner = {"events": [{"kind": "sag", "t_s": 0.2, "duration_s": 0.2, "sag": {"depth": 0.7}}], "after_s": 1.6}
    returned_s = 0.02 * (0.85 - 0.6) / 0.4
    late_s = 0.6 + returned_s + times * 0.4 - 0.95 * 0.02
    check = bench(
        depth=0.4,
        duration_s=0.6,
        scenario=inner,
        profile=demanding(active_power_recovery=RECOVERY | {"rows": MARK | {"rows": rows}}),
        p_kw=lambda t: np.where((t >= 0.6) & (t < late_s), 0.0, 500.0),
    ).check("active_power_recovery")
    assert (check.status, check.limit) == (status, 0.4), check.message


def test_overfrequency_up_to_a_trip(bench, demanding):
    """P beside the droop fails where the inverter trips later; one that trips before it is due is let off."""
    numbers = {"threshold_hz": 50.2, "droop_fraction": 0.05, "activation_s": 0.3, "tolerance_fraction": 0.05}
    made = lambda tripped_s: bench(  # noqa: E731
        depth=0,
        duration_s=1.0,
        profile=demanding(overfrequency_power=numbers),
        scenario={"events": [{"kind": "frequency_step", "t_s": 0.0, "to_hz": 51.0}]},
        p_kw=lambda t: 500 + 0 * t,
        disconnected_after_s=tripped_s,
    ).check("overfrequency_power")
    assert made(0.8).status is Status.FAIL
    check = made(0.2)
    assert check.status is Status.NOT_APPLICABLE
    assert "before the trip at 0.500 s" in check.message


@pytest.mark.parametrize(
    ("numbers", "percent", "status"),
    [({"thd_percent": 3.0}, 2.9, Status.PASS), ({"thd_percent": 3.0}, 3.1, Status.FAIL)],
)
def test_harmonics_before_a_trip(bench, demanding, numbers, percent, status):
    """Harmonics are judged before the disturbance; the end of a record that tripped is not looked at."""

    def fifth(t: np.ndarray) -> np.ndarray:
        return np.stack([percent / 100 * np.cos(2 * np.pi * 250 * t), 0 * t, 0 * t])

    made = bench(profile=demanding(harmonics=numbers), extra_current_pu=fifth, disconnected_after_s=0.2)
    check = made.check("harmonics")
    assert (check.status, check.measured) == (status, pytest.approx(percent, rel=2e-3))


@pytest.mark.parametrize(("times", "status"), SIDES)
@pytest.mark.parametrize("sign", [-1, 1])
@pytest.mark.parametrize("level_pu", [1.0, 0.95])
def test_reactive_power_that_stays(bench, demanding, level_pu, sign, times, status):
    """Q may end 0.025 V+ S from where it was, and nothing is said of P then."""
    limit_kvar = 0.025 * 500 * level_pu
    check = bench(
        profile=demanding(return_to_prefault={"reactive_pu": 0.025}, tolerance_pu=0.2),
        healthy_pu=level_pu,
        p_after_kw=400.0,
        q_after_kvar=sign * times * limit_kvar,
    ).check("return_to_prefault")
    assert check.status is status, check.message
    assert check.limit == pytest.approx(0.025 * level_pu)
    assert check.measured == pytest.approx(times * 0.025 * level_pu, rel=1e-3)


def test_return_is_not_judged_after_a_trip(bench, demanding):
    """An inverter that tripped feeds nothing and need not."""
    made = bench(profile=demanding(return_to_prefault={"reactive_pu": 0.025}), disconnected_after_s=0.2)
    check = made.check("return_to_prefault")
    assert (check.status, check.message) == (Status.NOT_APPLICABLE, "not judged after the trip at 0.500 s")
