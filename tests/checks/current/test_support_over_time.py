"""Times of the additional reactive current and its share in the total current, at both sides of every limit."""

import numpy as np
import pytest
from demands import CONTROL_STEP_S, DETECTION, DYNAMICS, RATIO

from pvlvrt_compliance.checks.api import judge_alone
from pvlvrt_compliance.checks.current.reactive_ratio import ReactiveRatioCheck
from pvlvrt_compliance.results import Status
from pvlvrt_compliance.scenario.events import VoltageProfile
from pvlvrt_compliance.scenario.sag import Sag

CYCLE_S = 0.02
FINAL_PU = 0.5
MARGINS = [(-0.2e-3, Status.FAIL), (0.2e-3, Status.PASS)]


@pytest.fixture
def timed(bench, demanding):
    """Make a record of a sag to 0.5 pu whose reactive current (pu) is a function of the time since its start."""

    def make(current_pu, detection=None, depth=0.5, changed=None, **settings):
        profile = demanding(detection=detection, support_dynamics=DYNAMICS | (changed or {}))
        q_kvar = lambda t: 500 * (1 - depth) * current_pu(t)  # noqa: E731
        return bench(depth=depth, profile=profile, q_sag_kvar=q_kvar, **settings)

    return make


def step(delay_s: float, size_pu: float = FINAL_PU):
    """Reactive current that comes at once after a delay; over a cycle it rises along a straight line."""
    return lambda t: np.where(t >= delay_s, size_pu, 0.0)


@pytest.mark.parametrize(("inside_by_s", "status"), MARGINS)
@pytest.mark.parametrize("sign", [-1, 1])
def test_activation(timed, inside_by_s, status, sign):
    """0.05 pu of 0.5 pu have come a tenth of a cycle after the step; a current the other way counts alike."""
    made = timed(step(0.018 - inside_by_s, sign * FINAL_PU), dt_s=CONTROL_STEP_S)
    check = made.check("support_dynamics")
    assert check.status is status
    assert "activation" in check.message
    assert (check.limit, check.unit) == (0.02, "s")
    assert check.margin == pytest.approx(inside_by_s, abs=0.1e-3)
    assert check.at_s == pytest.approx(0.32 - inside_by_s, abs=0.1e-3)


@pytest.mark.parametrize(("inside_by_s", "status"), MARGINS)
def test_response(timed, inside_by_s, status):
    """A step from 0.1 pu to 0.5 pu brings the mean to 90 % seven eighths of a cycle later."""
    rise_s = (0.45 - 0.1) / 0.4 * CYCLE_S
    come_s = 0.05 - rise_s - inside_by_s
    made = timed(lambda t: np.where(t >= come_s, FINAL_PU, 0.1), dt_s=CONTROL_STEP_S)
    check = made.check("support_dynamics")
    assert check.status is status
    assert "response" in check.message
    assert check.margin == pytest.approx(inside_by_s, abs=0.1e-3)


@pytest.mark.parametrize(("inside_by_s", "status"), MARGINS)
@pytest.mark.parametrize(("size_pu", "edge_pu"), [(0.65, 0.6), (0.40, 0.45)])
def test_settling(timed, inside_by_s, status, size_pu, edge_pu):
    """Beyond either edge of the band until late, the mean comes back into it a part of a cycle after the current."""
    activated_s = 0.05 / size_pu * CYCLE_S
    part_s = (size_pu - edge_pu) / (size_pu - FINAL_PU) * CYCLE_S
    left_s = activated_s + 0.06 - part_s - inside_by_s
    late = lambda t: np.where(t >= left_s, FINAL_PU, size_pu)  # noqa: E731
    made = timed(late, changed={"response_s": 0.2}, dt_s=CONTROL_STEP_S)
    check = made.check("support_dynamics")
    assert check.status is status
    assert "settling" in check.message
    assert check.margin == pytest.approx(inside_by_s, abs=0.1e-3)


@pytest.mark.parametrize(("inside_by_s", "status"), MARGINS)
def test_times_count_from_detection(timed, inside_by_s, status):
    """V+ over a cycle is at 0.85 pu three tenths of a cycle after a sag to 0.5 pu began; the times count from there."""
    made = timed(step(0.018 + 0.006 - inside_by_s), detection=DETECTION, dt_s=CONTROL_STEP_S)
    check = made.check("support_dynamics")
    assert check.status is status
    assert check.margin == pytest.approx(inside_by_s, abs=0.1e-3)


@pytest.mark.parametrize(("band", "status"), [(0.12, Status.PASS), (0.08, Status.FAIL)])
def test_oscillation_that_never_settles(timed, band, status):
    """A swing of a tenth of the final value, slow against a cycle, is within a band of 12 % and not of 8 %."""
    swinging = lambda t: FINAL_PU * (1 + 0.1 * np.sin(2 * np.pi * 10 * t) * (t > 0.1))  # noqa: E731
    changed = {"band_plus": band, "band_minus": band}
    assert timed(swinging, duration_s=0.62, changed=changed).check("support_dynamics").status is status


@pytest.mark.parametrize(("size_pu", "status"), [(0.049, Status.NOT_APPLICABLE), (0.051, Status.PASS)])
def test_small_change_is_not_timed(timed, size_pu, status):
    """Less than the least change has no response."""
    made = timed(step(0.0, size_pu), p_sag_kw=50.0, changed={"activation_pu": 0.01})
    assert made.check("support_dynamics").status is status


@pytest.mark.parametrize(
    ("settings", "reason"),
    [
        ({"duration_s": 0.11}, "no whole cycle"),
        ({"depth": 0.1, "detection": DETECTION}, "threshold of detection"),
        ({"asked": Sag(depth=0.95, phases="bc", two_phase=True), "current_pu": step(0, 0)}, "less than the 0.05 pu"),
    ],
)
def test_nothing_to_time(timed, settings, reason):
    """Sags that are too short or no event, and a bridge blocked where V+ is V- nearly, have no response."""
    check = timed(**({"current_pu": step(0)} | settings)).check("support_dynamics")
    assert check.status is Status.NOT_APPLICABLE
    assert reason in check.message


def test_sag_over_before_the_limit(timed):
    """A current still outside the band when the voltage comes back has not failed a limit that is later than that."""
    made = timed(
        lambda t: np.where(t >= 0.15, 0.9, FINAL_PU), duration_s=0.18, changed={"settling_s": 0.5, "band_plus": 0.02}
    )
    assert made.check("support_dynamics").status is Status.NOT_APPLICABLE


@pytest.fixture
def sharing(bench, demanding):
    """Make a record of a sag whose current of 0.8 pu is reactive in a given share."""

    def make(share, depth=0.5, current_pu=0.8, changed=None, detection=None, **settings):
        def at_angle(part):
            return lambda t: 500 * (1 - depth) * current_pu * part(share(t) if callable(share) else share + 0 * t)

        profile = demanding(detection, reactive_ratio=RATIO | (changed or {}))
        p, q = at_angle(lambda s: np.sqrt(1 - s**2)), at_angle(lambda s: s)
        return bench(depth=depth, profile=profile, p_sag_kw=p, q_sag_kvar=q, **settings)

    return make


@pytest.mark.parametrize(("depth", "demanded"), [(0.5, 0.9), (0.8, 0.9), (0.325, 0.45), (0.15, 0.0)])
@pytest.mark.parametrize(("inside_by", "status"), [(-0.001, Status.FAIL), (0.001, Status.PASS)])
def test_share(sharing, depth, demanded, inside_by, status):
    """The share may be 0.01 below the curve at the V+ measured; without a demand, under-excited by as much."""
    check = sharing(demanded - 0.01 + inside_by, depth=depth).check("reactive_ratio")
    assert check.status is status
    assert check.limit == pytest.approx(demanded - 0.01, abs=1e-3)
    assert check.margin == pytest.approx(inside_by, abs=2e-4)
    assert 0.45 <= check.at_s <= 0.6


@pytest.mark.parametrize(("depth", "status"), [(0.145, Status.NOT_APPLICABLE), (0.155, Status.FAIL)])
def test_no_share_without_an_event(sharing, depth, status):
    """Above the threshold of detection there is no sag: nothing is demanded, and nothing forbidden."""
    assert sharing(-0.05, depth=depth, detection=DETECTION).check("reactive_ratio").status is status


@pytest.mark.parametrize("levels", [{}, {"enter_above_pu": 1.1, "leave_below_pu": 1.1}])
@pytest.mark.parametrize(("depth", "swelling"), [(-0.09, False), (-0.11, True)])
def test_a_share_in_a_swell(sharing, levels, depth, swelling):
    """A swell is an event where the profile has thresholds for it."""
    curve = RATIO["curve"] | {"points": [[0.5, 0.9], [0.85, 0], [1.05, 0.3]]}
    voltage = VoltageProfile(points=((0.0, 1 - depth), (0.3, 1 - depth), (0.3, 1.0)))
    made = sharing(
        0.0, depth=0, changed={"curve": curve}, detection=DETECTION | levels, scenario={"events": (voltage,)}
    )
    expected = Status.FAIL if levels and swelling else Status.NOT_APPLICABLE
    assert made.check("reactive_ratio").status is expected


@pytest.mark.parametrize(("late_s", "status"), [(0.129, Status.PASS), (0.139, Status.FAIL)])
def test_share_in_time(sharing, late_s, status):
    """The share must be there 0.15 s after the start, over a cycle; what comes before does not count."""
    check = sharing(lambda t: np.where(t < late_s, 0.0, 0.95)).check("reactive_ratio")
    assert check.status is status
    if status is Status.FAIL:
        assert check.at_s == pytest.approx(0.45, abs=1e-4)


@pytest.mark.parametrize("over_s", [0.2, 0.27])
def test_share_must_last(sharing, over_s):
    """A share that is lost before clearing fails at the worst instant."""
    check = sharing(lambda t: np.where(t < over_s, 0.95, 0.0)).check("reactive_ratio")
    assert check.status is Status.FAIL
    assert check.at_s > 0.3 + over_s


@pytest.mark.parametrize(("current_pu", "status"), [(0.049, Status.FAIL), (0.051, Status.PASS)])
def test_hardly_any_current_fails(sharing, current_pu, status):
    """Where a share is due, less than the least current fails, however reactive it is: doing nothing is no pass."""
    check = sharing(1.0, current_pu=current_pu).check("reactive_ratio")
    assert check.status is status
    if status is Status.FAIL:
        assert (check.limit, check.unit, check.bound) == (0.05, "pu", "at_least")
        assert check.measured == pytest.approx(current_pu)
        assert check.margin == pytest.approx(current_pu - 0.05)


@pytest.mark.parametrize(("current_pu", "status"), [(0.19, Status.FAIL), (0.21, Status.PASS)])
def test_no_more_current_is_due_than_before(sharing, current_pu, status):
    """With 0.2 pu of current before a shallow sag no more is due in it, however much the profile asks for at most."""
    settings = {"depth": 0.2, "changed": {"least_current_pu": 0.3}, "p_before_kw": 100.0, "available_power_w": 100e3}
    assert sharing(0.95, current_pu=current_pu, **settings).check("reactive_ratio").status is status


@pytest.mark.parametrize(("depth", "status"), [(0.92, Status.NOT_APPLICABLE), (0.88, Status.FAIL)])
def test_no_current_where_the_sequences_meet(sharing, depth, status):
    """Where V+ and V- of the grid are nearly the same, eq (8) leaves no current, and none is due."""
    sag = Sag(depth=depth, phases="bc", two_phase=True)
    assert sharing(1.0, current_pu=0.0, asked=sag).check("reactive_ratio").status is status


@pytest.mark.parametrize(("left_pu", "status"), [(0.0, Status.FAIL), (0.05, Status.PASS)])
def test_a_voltage_that_the_inverter_destroys(sharing, left_pu, status):
    """Nothing left at the terminals of a grid that has 0.5 pu fails."""
    check = sharing(0.95, sag=Sag(depth=1 - left_pu), no_load_sag=Sag(depth=0.5)).check("reactive_ratio")
    assert check.status is status
    assert ("destroyed the voltage" in check.message) == (status is Status.FAIL)


def test_without_the_grids_voltage_the_terminals_decide(sharing):
    """Nobody knows who took the voltage away in a record of the terminals alone."""
    made = sharing(0.95, sag=Sag(depth=1), no_load_sag=Sag(depth=0.5), without=("u0_a_v", "u0_b_v", "u0_c_v"))
    requirement = made.profile.requirements.reactive_ratio
    verdict = judge_alone(ReactiveRatioCheck, requirement, made.waveforms(), made.test.scenario)
    assert verdict.status is Status.NOT_APPLICABLE


def test_share_in_a_short_sag(sharing):
    """A sag that is over before the share is due is let off, and so is one without voltage."""
    assert sharing(0.0, duration_s=0.14).check("reactive_ratio").status is Status.NOT_APPLICABLE
    assert sharing(0.0, depth=1).check("reactive_ratio").status is Status.NOT_APPLICABLE


def test_share_of_an_unbalanced_sag(bench, demanding):
    """The share is that of the positive sequence: negative-sequence current neither helps nor harms."""
    sag = Sag(depth=0.5, phases="bc", two_phase=True)
    settings = {"asked": sag, "profile": demanding(reactive_ratio=RATIO), "negative_reactive_pu": 0.4}
    share = 0.9 * (0.85 - 0.75) / 0.35
    for extra, status in ((-0.011, Status.FAIL), (-0.009, Status.PASS)):
        q = 300 * (share + extra)
        made = bench(p_sag_kw=np.sqrt(300**2 - q**2), q_sag_kvar=q, **settings)
        assert made.check("reactive_ratio").status is status


@pytest.mark.parametrize("kind", ["support_dynamics", "reactive_ratio"])
@pytest.mark.parametrize("channel", ["u_a_v", "i_c_a"])
def test_missing_numbers(timed, sharing, kind, channel):
    """A sample that is no number leaves the test without a verdict."""
    made = (
        timed(step(0), spoiled={channel: 0.5}) if kind == "support_dynamics" else sharing(0.95, spoiled={channel: 0.5})
    )
    assert made.check(kind).status is Status.NOT_EVALUATED
