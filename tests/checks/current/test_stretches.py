"""Several sags in one record: the bundled control is right in each, and no wrong one passes by its first sag."""

import math

import numpy as np
import pytest

from pvlvrt_compliance.checks.evaluate import evaluate
from pvlvrt_compliance.disturbance.found import Thresholds as FoundThresholds
from pvlvrt_compliance.disturbance.found import disturbance_found
from pvlvrt_compliance.evidence.collect import normal_voltage
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.results import Status
from pvlvrt_compliance.scenario.parameters import Parameters
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.study.run import run_test
from pvlvrt_compliance.waveforms.container import Segment, Waveforms

INNER = {"kind": "sag", "t_s": 0.2, "duration_s": 0.15, "sag": {"depth": 0.8}}
LEVELS = [(0.0, 0.7), (0.2, 0.7), (0.2, 0.2), (0.35, 0.2), (0.35, 0.7), (0.6, 0.7), (0.6, 1.0)]
SECOND = {"kind": "sag", "t_s": 0.6, "duration_s": 0.3, "sag": {"depth": 0.5}}


def checks_of(result) -> dict:
    """Verdicts by kind."""
    return {check.check: check for check in result.checks}


@pytest.fixture(scope="module")
def judged():
    """Judge the bundled control in a sag of the user's own and what follows it."""

    def run(profile: str, depth: float, duration_s: float, *events: dict) -> dict:
        loaded = load_profile(profile)
        test = loaded.ad_hoc_test(Sag(depth=depth), duration_s, events=events)
        return run_test(loaded, test, Parameters()).result

    return run


@pytest.mark.parametrize(
    ("depth", "duration_s", "event", "levels"),
    [
        (0.3, 0.6, INNER, (0.7, 0.2, 0.7)),
        (0.0, 0.6, {"kind": "voltage_profile", "points": LEVELS}, (0.7, 0.2, 0.7)),
        (0.3, 0.4, INNER | {"duration_s": 0.3}, (0.7, 0.2)),
    ],
    ids=["inner sag", "voltage profile", "inner sag that outlasts the outer"],
)
def test_sag_within_a_sag(judged, depth, duration_s, event, levels):
    """Each level is on the curve or at the clip, at nominal current: nothing is held against a mean of two levels."""
    result = judged("spain-q-curve", depth, duration_s, event)
    checks = checks_of(result)
    assert {checks[kind].status for kind in ("reactive_support", "current_limit")} == {Status.PASS}
    assert checks["current_limit"].measured == pytest.approx(1.0, abs=0.005)
    found = [part.window.reactive_power_kvar for part in result.measurements.stretches][: len(levels)]
    wanted = [min(500 * 15 / 7 * (0.85 - u), 500 * u) for u in levels]
    assert found == pytest.approx(wanted, abs=0.5)
    bands = [band.lower[0] for band in result.bands if band.check == "reactive_support"]
    assert bands == pytest.approx([q - 0.025 * u * 500 for q, u in zip(wanted, levels, strict=True)], abs=0.01)


def test_settling_counts_from_the_second_start(judged):
    """What a short first sag leaves of its time to settle is not taken from the second one."""
    second = {"kind": "sag", "t_s": 0.45, "duration_s": 0.2, "sag": {"depth": 0.8, "phases": "c"}}
    check = checks_of(judged("spain-q-curve", 0.5, 0.15, second))["current_limit"]
    assert check.status is Status.PASS
    assert check.measured == pytest.approx(1.0, abs=0.005)


SUPPORT = {
    "spain-q-curve": ("reactive_support", "kvar"),
    "es-po-12.3": ("reactive_ratio", "pu"),
    "es-nts-631-lt110kv": ("reactive_current", "pu"),
}


@pytest.mark.parametrize("name", SUPPORT)
@pytest.mark.parametrize(("flow", "stretch"), [((1.0, 0.055), "second sag"), ((0.055, 1.0), "first sag"),
                                               ((0.0, 0.0), "first sag"), ((1.0, 1.0), "")])  # fmt: skip
def test_support_in_each_sag(bench, name, flow, stretch):
    """Hardly any current in one of two sags, whichever it is, fails the demand for support and names that sag."""
    profile = load_profile(name)
    kind, unit = SUPPORT[name]
    start_s = profile.procedure.before_s.value
    made = bench(
        profile=profile,
        duration_s=0.3,
        scenario={"events": [SECOND], "after_s": 2.0},
        q_sag_kvar=250.0,
        q_after_kvar=lambda t: np.where((t >= 0.3) & (t < 0.6), 250.0, 0.0),
        p_after_kw=lambda t: np.where((t >= 0.3) & (t < 0.6), 0.0, 500.0),
        flows=lambda t: np.where((t >= 0) & (t < 0.3), flow[0], np.where((t >= 0.6) & (t < 0.9), flow[1], 1.0)),
    )
    check = made.check(kind)
    assert (check.status is Status.FAIL) == bool(stretch)
    if stretch:
        assert check.stretch.startswith(stretch)
        assert check.message.startswith(check.stretch)
        assert check.unit == unit
        assert check.at_s > start_s + (0.6 if stretch.startswith("second") else 0.0)


DUE = {
    "k": 2.0,
    "dead_band_pu": 0.1,
    "dead_band_mode": "none",
    "reference": "prefault",
    "tolerance_plus_pu": 0.2,
    "tolerance_minus_pu": 0.1,
    "limit_pu": 1.0,
    "blocking_allowed_below_pu": 0.2,
}
DYNAMICS = {
    "activation_pu": 0.05,
    "activation_s": 0.02,
    "response_fraction": 0.9,
    "response_s": 0.05,
    "settling_s": 0.06,
    "band_plus": 0.2,
    "band_minus": 0.1,
    "least_change_pu": 0.1,
}
RATIO = {
    "curve": {"points": [[0, 0.9], [0.5, 0.9], [0.85, 0]], "confidence": "chosen", "source": "the test"},
    "within_s": 0.15,
    "tolerance": 0.01,
    "least_current_pu": 0.3,
}


@pytest.fixture
def responding(bench, demanding):
    """Make a record at 0.8 pu, 0.5 pu and 0.8 pu again, with the reactive current (pu) as a function of time.

    K = 2 asks for 0.4 pu, 1.0 pu and 0.4 pu; what passes as that are 0.3 to 0.6 pu and 0.9 to 1.2 pu.
    """
    points = [(0.0, 0.8), (0.3, 0.8), (0.3, 0.5), (0.6, 0.5), (0.6, 0.8), (0.9, 0.8), (0.9, 1.0)]

    def level(t: np.ndarray) -> np.ndarray:
        return np.select([t < 0, t < 0.3, t < 0.6, t < 0.9], [1.0, 0.8, 0.5, 0.8], 1.0)

    def make(current, **settings):
        profile = demanding(support_dynamics=DYNAMICS, reactive_current=DUE)
        scenario = {"events": [{"kind": "voltage_profile", "points": points}], "after_s": 1.0}
        q_kvar = lambda t: 500 * level(t) * current(t)  # noqa: E731
        return bench(
            depth=0, duration_s=0.9, profile=profile, scenario=scenario, q_kvar=q_kvar,
            p_kw=lambda t: np.where((t < 0) | (t >= 0.9), 500.0, 0.0), **settings,
        )  # fmt: skip

    return make


def currents(first: float, second: float, third: float, late_s: tuple[float, float, float] = (0.0, 0.0, 0.0)):
    """Reactive current of three levels, each of which comes late by a time."""

    def current(t: np.ndarray) -> np.ndarray:
        begins = [0.0 + late_s[0], 0.3 + late_s[1], 0.6 + late_s[2]]
        found = np.select([t < begins[0], t < begins[1], t < begins[2]], [0.0, first, second], third)
        return np.where(t < 0.9, found, 0.0)

    return current


def test_response_of_each_step(responding):
    """What follows each step at once passes, the way down again too."""
    check = responding(currents(0.4, 1.0, 0.4)).check("support_dynamics")
    assert check.status is Status.PASS
    assert (check.bound, check.uncertainty) == ("at_most", pytest.approx(0.01))


@pytest.mark.parametrize(("inside_by_s", "status"), [(-0.3e-3, Status.FAIL), (0.3e-3, Status.PASS)])
@pytest.mark.parametrize("of", [0, 1, 2])
def test_activation_counts_from_the_current_before(responding, of, inside_by_s, status):
    """From the current before each step 0.05 pu must have moved in time, up or down; it moves a cycle long."""
    moves_by = (0.4, 0.6, 0.6)[of]
    late_s = [0.0, 0.0, 0.0]
    late_s[of] = 0.02 - 0.02 * 0.05 / moves_by - inside_by_s
    check = responding(currents(0.4, 1.0, 0.4, tuple(late_s))).check("support_dynamics")
    assert check.status is status
    if status is Status.FAIL:
        assert "activation" in check.message
        assert check.stretch.startswith(("first", "second", "third")[of])
        assert check.margin == pytest.approx(inside_by_s, abs=0.1e-3)


@pytest.mark.parametrize(
    ("levels", "status", "stretch"),
    [
        ((0.131, 1.0, 0.4), Status.FAIL, "first"),
        ((0.4, 0.77, 0.4), Status.FAIL, "second"),
        ((0.301, 0.901, 0.301), Status.PASS, ""),
        ((0.599, 1.199, 0.599), Status.PASS, ""),
    ],
)
def test_response_is_to_what_is_due(responding, levels, status, stretch):
    """A third of what is due has not responded, however fast; what passes as steady current is not out of time."""
    result = checks_of(responding(currents(*levels)).result())
    assert result["support_dynamics"].status is status
    if status is Status.PASS:
        assert result["reactive_current"].status is Status.PASS
    else:
        assert result["support_dynamics"].stretch.startswith(stretch)


def test_nothing_to_time_where_the_current_need_not_change(bench, demanding):
    """A step that leaves what is due at its limit asks for no response."""
    points = [(0.0, 0.4), (0.3, 0.4), (0.3, 0.3), (0.6, 0.3), (0.6, 1.0)]
    made = bench(
        depth=0, duration_s=0.6, profile=demanding(support_dynamics=DYNAMICS, reactive_current=DUE),
        scenario={"events": [{"kind": "voltage_profile", "points": points}]},
        q_kvar=lambda t: 500 * np.select([t < 0, t < 0.3, t < 0.6], [0.0, 0.4, 0.3], 0.0),
        p_kw=lambda t: np.where((t < 0) | (t >= 0.6), 500.0, 0.0),
    )  # fmt: skip
    check = made.check("support_dynamics")
    assert check.status is Status.PASS
    assert check.stretch.startswith("first sag")


@pytest.mark.parametrize(("depth", "status"), [(0.81, Status.NOT_APPLICABLE), (0.79, Status.FAIL)])
def test_blocked_where_support_is_due(bench, demanding, depth, status):
    """A bridge that blocks has no response: let off where it may block, else a failure."""
    profile = demanding(support_dynamics=DYNAMICS, reactive_current=DUE)
    check = bench(depth=depth, profile=profile, p_sag_kw=0.0).check("support_dynamics")
    assert check.status is status


def test_blocked_for_a_cycle_where_support_is_due(bench, demanding):
    """A gap in the current that the mean of a long sag hides fails all the same."""
    gap = lambda t: 1.0 - ((t >= 0.5) & (t < 0.525))  # noqa: E731
    made = bench(depth=0.3, duration_s=1.0, profile=demanding(reactive_current=DUE), q_sag_kvar=210.0, flows=gap)
    check = made.check("reactive_current")
    assert check.status is Status.FAIL
    assert (check.limit, check.bound, check.unit) == (0.01, "at_least", "pu")
    assert math.isclose(check.margin, check.measured - check.limit)


@pytest.mark.parametrize(
    ("before_kvar", "between_kvar", "status"),
    [(0.0, 12.4, Status.PASS), (0.0, 12.6, Status.FAIL), (100.0, 100.0, Status.PASS)],
)
def test_no_support_between_sags(bench, before_kvar, between_kvar, status):
    """Between two sags no support is wanted; of an inverter that fed reactive power before, nothing is said."""
    made = bench(
        profile=load_profile("spain-q-curve"),
        scenario={"events": [SECOND]},
        q_before_kvar=before_kvar,
        q_sag_kvar=250.0,
        q_after_kvar=lambda t: np.where((t >= 0.3) & (t < 0.6), 250.0, between_kvar),
        p_after_kw=lambda t: np.where((t >= 0.3) & (t < 0.6), 0.0, 490.0),
    )
    check = made.check("reactive_support")
    assert check.status is status
    if status is Status.FAIL:
        assert check.stretch.startswith("first time of normal voltage")


@pytest.mark.parametrize("kind", ["reactive_current", "support_dynamics", "reactive_ratio"])
@pytest.mark.parametrize(("left", "fails"), [(0.0, True), (0.1, False)])
def test_voltage_lost_for_some_cycles(bench, demanding, kind, left, fails):
    """Where the terminals lose for some cycles what the grid has all along, nothing is excused or left open."""
    demands = {"reactive_current": DUE, "support_dynamics": DYNAMICS, "reactive_ratio": RATIO}
    made = bench(profile=demanding(**demands), q_sag_kvar=250.0)
    segment = made.waveforms().segments[0]
    lost = (segment.t_s >= 0.5) & (segment.t_s < 0.53)
    channels = {n: x * np.where(lost, left, 1.0) if n.startswith("u_") else x for n, x in segment.channels.items()}
    made.waveforms = lambda: Waveforms((Segment(segment.t0_s, segment.dt_s, channels),))
    check = made.check(kind)
    assert (check.status is Status.FAIL) == fails
    assert ("destroyed the voltage" in check.message) == fails


def test_no_mean_over_a_ramp(bench):
    """Where the voltage ramps no mean is held against a curve; the stretches beside it are judged."""
    points = [(0.0, 0.8), (0.3, 0.8), (0.6, 0.5), (0.9, 0.5), (0.9, 1.0)]

    def level(t: np.ndarray) -> np.ndarray:
        return np.interp(t, *zip(*points[:-1], strict=True)) * ((t >= 0) & (t < 0.9))

    demand = lambda t: 500 * np.minimum(15 / 7 * (0.85 - level(t)), level(t)) * ((t >= 0) & (t < 0.9))  # noqa: E731
    settings = {
        "profile": load_profile("spain-q-curve"), "depth": 0, "duration_s": 0.9,
        "scenario": {"events": [{"kind": "voltage_profile", "points": points}]},
        "p_kw": lambda t: np.where((t < 0) | (t >= 0.9), 500.0, 0.0),
    }  # fmt: skip
    silent = lambda t: demand(t) * ((t < 0.33) | (t >= 0.57))  # noqa: E731
    assert bench(q_kvar=silent, **settings).check("reactive_support").status is Status.PASS
    late = lambda t: demand(t) * (t < 0.6)  # noqa: E731
    check = bench(q_kvar=late, **settings).check("reactive_support")
    assert check.status is Status.FAIL
    assert check.at_s > 0.3 + 0.6


def test_a_step_that_was_found_late_spoils_nothing(bench):
    """In a record whose steps had to be found, what follows a step is not taken for what was before it."""
    profile = load_profile("spain-q-curve")
    surge = lambda t: 1.0 + 0.15 * ((t >= 0.3) & (t < 0.33))  # noqa: E731
    made = bench(depth=0.03, profile=profile, p_sag_kw=485.0, flows=surge)
    waveforms = made.waveforms()
    thresholds = FoundThresholds(normal=normal_voltage(profile.thresholds))
    found = disturbance_found(waveforms, made.nominal, thresholds)
    assert found.clear_s > made.test.scenario.clear_s + 0.01
    result = evaluate(profile, made.test, waveforms, made.nominal, made.available_power_w, found)
    assert checks_of(result)["current_limit"].status is Status.PASS


def test_share_on_a_ramp(bench, demanding):
    """A share is judged instant by instant, on a ramp of the voltage as well."""
    points = [(0.0, 0.4), (0.2, 0.4), (0.6, 0.2), (0.6, 1.0)]
    settings = {
        "profile": demanding(reactive_ratio=RATIO), "depth": 0, "duration_s": 0.6,
        "scenario": {"events": [{"kind": "voltage_profile", "points": points}]},
    }  # fmt: skip
    for lost_s, status in ((0.6, Status.PASS), (0.5, Status.FAIL)):
        q = lambda t, lost_s=lost_s: 100.0 * ((t >= 0) & (t < lost_s))  # noqa: E731
        p = lambda t, lost_s=lost_s: np.where((t < 0) | (t >= 0.6), 500.0, 100.0 * (t >= lost_s))  # noqa: E731
        assert bench(q_kvar=q, p_kw=p, **settings).check("reactive_ratio").status is status
