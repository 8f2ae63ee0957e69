"""Several sags in one record: the bundled control is right in each, and no wrong one passes by its first sag."""

import math

import numpy as np
import pytest
from demands import DYNAMICS_OF_LARGE_STEPS, K_FACTOR, RATIO, checks_of

from pvlvrt_compliance.checks.evaluate import evaluate
from pvlvrt_compliance.disturbance.found import Thresholds as FoundThresholds
from pvlvrt_compliance.disturbance.found import disturbance_found
from pvlvrt_compliance.evidence.collect import normal_voltage
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.results import Status
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.study.run import run_test
from pvlvrt_compliance.waveforms.container import Segment, Waveforms

INNER = {"kind": "sag", "t_s": 0.2, "duration_s": 0.15, "sag": {"depth": 0.8}}
LEVELS = [(0.0, 0.7), (0.2, 0.7), (0.2, 0.2), (0.35, 0.2), (0.35, 0.7), (0.6, 0.7), (0.6, 1.0)]
SECOND = {"kind": "sag", "t_s": 0.6, "duration_s": 0.3, "sag": {"depth": 0.5}}
RATIO_OF_LARGE_CURRENTS = RATIO | {"least_current_pu": 0.3}


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
    bands = [band.lower[0] for band in result.bands if band.check == "reactive_support" and band.widened]
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


def test_blocked_for_a_cycle_where_support_is_due(bench, demanding):
    """A gap in the current that the mean of a long sag hides fails all the same."""
    gap = lambda t: 1.0 - ((t >= 0.5) & (t < 0.525))  # noqa: E731
    made = bench(depth=0.3, duration_s=1.0, profile=demanding(reactive_current=K_FACTOR), q_sag_kvar=210.0, flows=gap)
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
    demands = {
        "reactive_current": K_FACTOR,
        "support_dynamics": DYNAMICS_OF_LARGE_STEPS,
        "reactive_ratio": RATIO_OF_LARGE_CURRENTS,
    }
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


def test_steps_that_were_found_spoil_nothing(bench):
    """In a record whose steps had to be found, what follows a step is not taken for what was before it."""
    profile = load_profile("spain-q-curve")
    surge = lambda t: 1.0 + 0.15 * ((t >= 0.3) & (t < 0.33))  # noqa: E731
    made = bench(depth=0.03, profile=profile, p_sag_kw=485.0, flows=surge)
    waveforms = made.waveforms()
    thresholds = FoundThresholds(normal=normal_voltage(profile.thresholds))
    found = disturbance_found(waveforms, made.nominal, thresholds)
    assert found.clear_s == pytest.approx(made.test.scenario.clear_s, abs=0.001)
    result = evaluate(profile, made.test, waveforms, made.nominal, made.available_power_w, found)
    assert checks_of(result)["current_limit"].status is Status.PASS


def test_share_on_a_ramp(bench, demanding):
    """A share is judged instant by instant, on a ramp of the voltage as well."""
    points = [(0.0, 0.4), (0.2, 0.4), (0.6, 0.2), (0.6, 1.0)]
    settings = {
        "profile": demanding(reactive_ratio=RATIO_OF_LARGE_CURRENTS), "depth": 0, "duration_s": 0.6,
        "scenario": {"events": [{"kind": "voltage_profile", "points": points}]},
    }  # fmt: skip
    for lost_s, status in ((0.6, Status.PASS), (0.5, Status.FAIL)):
        q = lambda t, lost_s=lost_s: 100.0 * ((t >= 0) & (t < lost_s))  # noqa: E731
        p = lambda t, lost_s=lost_s: np.where((t < 0) | (t >= 0.6), 500.0, 100.0 * (t >= lost_s))  # noqa: E731
        assert bench(q_kvar=q, p_kw=p, **settings).check("reactive_ratio").status is status
