import math

import pytest

from pvlvrt_compliance.scenario.sag import Sag
from validation.simulator import findings, synchronism, weak_grids
from validation.simulator.weak_grids import LOST, Case, is_lost, judged_part, outcome


def test_a_weak_grid_carries_what_the_closed_form_says(assert_within):
    """V_fault, power and the lowest SCR at full power without a sag are those of the static network."""
    assert_within(synchronism.nominal_rows())


def test_synchronism_is_lost_where_no_state_of_rest_exists(assert_within):
    """Reactive current alone is held down to SCR = 1/(E sqrt(1 + (X/R)^2)) when the sag comes slowly."""
    assert_within(synchronism.deep_rows())


@pytest.mark.parametrize(("depth", "xr"), [(0.9, 3.0), (0.9, 0.1), (0.95, 3.0)])
def test_no_control_holds_below_the_limit(depth, xr):
    """A little below the closed form a sudden sag loses synchronism, and well above it does not."""
    limit = weak_grids.weakest_for_support(1 - depth, xr)
    assert is_lost(judged_part(Case(Sag(depth=depth), 0.9 * limit, xr)))
    assert not is_lost(judged_part(Case(Sag(depth=depth), 1.4 * limit, xr)))


@pytest.mark.parametrize("scr", [10.0, 3.0, 1.5])
@pytest.mark.parametrize("xr", [10.0, 3.0])
def test_half_a_phase_is_kept_in_step(scr, xr):
    """50 % of one phase loses no synchronism down to an SCR of 1.5."""
    assert outcome(Case(synchronism.ONE_PHASE, scr, xr)) != LOST


def test_a_slower_fll_keeps_a_state_of_rest_that_exists():
    """At SCR 2.5 and X/R 10 a three-phase sag of 80 % is lost with the paper's gain and held with 40 % of it."""
    cases = [Case(Sag(depth=0.8), 2.5, 10.0, (f"controller.fll_gain={gain}",)) for gain in (50, 20)]
    assert [is_lost(judged_part(case)) for case in cases] == [True, False]


def test_the_largest_power_is_where_the_voltage_has_two_solutions_in_one():
    """At the most that a grid carries V^2 = |Z| P; beyond it there is no voltage."""
    P = weak_grids.largest_power(2.0, 10.0)
    assert weak_grids.voltage_at_power(P * (1 - 1e-12), 2.0, 10.0) == pytest.approx(math.sqrt(P / 2), rel=1e-4)
    assert math.isnan(weak_grids.voltage_at_power(1.001 * P, 2.0, 10.0))


@pytest.mark.slow
def test_the_tool_reports_the_loss():
    """The commands of the page: a trip below the limit, none above it, and no verdict on a grid that is too weak."""
    assert findings.checks_of(synchronism.LOSS)["ride_through"]["status"] == "fail"
    assert findings.checks_of(synchronism.IN_STEP)["ride_through"]["status"] == "pass"
    for finding in (synchronism.LOSS, synchronism.IN_STEP, synchronism.TOO_WEAK):
        assert findings.checks_of(finding)["current_limit"]["status"] == finding.current_limit
