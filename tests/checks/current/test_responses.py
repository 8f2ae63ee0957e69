"""How fast the reactive current follows each step of a voltage that has several, up and down."""

import numpy as np
import pytest
from demands import CONTROL_STEP_S, DYNAMICS_OF_LARGE_STEPS, K_FACTOR, checks_of

from pvlvrt_compliance.results import Status


@pytest.fixture
def responding(bench, demanding):
    """Make a record at 0.8 pu, 0.5 pu and 0.8 pu again, with the reactive current (pu) as a function of time.

    K = 2 asks for 0.4 pu, 1.0 pu and 0.4 pu; what passes as that are 0.3 to 0.6 pu and 0.9 to 1.2 pu.
    """
    points = [(0.0, 0.8), (0.3, 0.8), (0.3, 0.5), (0.6, 0.5), (0.6, 0.8), (0.9, 0.8), (0.9, 1.0)]

    def level(t: np.ndarray) -> np.ndarray:
        return np.select([t < 0, t < 0.3, t < 0.6, t < 0.9], [1.0, 0.8, 0.5, 0.8], 1.0)

    def make(current, **settings):
        profile = demanding(support_dynamics=DYNAMICS_OF_LARGE_STEPS, reactive_current=K_FACTOR)
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
    check = responding(currents(0.4, 1.0, 0.4, tuple(late_s)), dt_s=CONTROL_STEP_S).check("support_dynamics")
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
        depth=0, duration_s=0.6, profile=demanding(support_dynamics=DYNAMICS_OF_LARGE_STEPS, reactive_current=K_FACTOR),
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
    profile = demanding(support_dynamics=DYNAMICS_OF_LARGE_STEPS, reactive_current=K_FACTOR)
    check = bench(depth=depth, profile=profile, p_sag_kw=0.0).check("support_dynamics")
    assert check.status is status


def test_instants_are_those_that_were_judged(responding):
    """Each step has its three, when the current had come; the verdict's own time is among them."""
    late_s = (0.004, 0.012, 0.008)
    result = responding(currents(0.4, 1.0, 0.4, late_s)).result()
    check = next(check for check in result.checks if check.check == "support_dynamics")
    begins_s = [step.at_s for step in result.disturbance.steps][:3]
    names = ["activation", "response", "settling"]
    assert [one.name for one in result.instants] == 3 * names
    for k, begin_s in enumerate(begins_s):
        activation, response, settling = result.instants[3 * k : 3 * k + 3]
        assert begin_s + late_s[k] < activation.at_s < min(response.at_s, settling.at_s)
        assert max(response.at_s, settling.at_s) < begin_s + late_s[k] + 0.021
        assert settling.took_s == pytest.approx(settling.at_s - activation.at_s)
    assert check.measured in {one.took_s for one in result.instants}
    assert check.at_s in {one.at_s for one in result.instants}


def test_what_never_comes_has_no_instant(responding):
    """A current that stays away after the second step is neither active nor settled there."""
    result = responding(currents(0.4, 0.4, 0.4)).result()
    second_s, third_s = (step.at_s for step in result.disturbance.steps[1:3])
    assert not [one for one in result.instants if second_s <= one.at_s < third_s]
