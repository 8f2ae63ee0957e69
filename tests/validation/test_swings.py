"""Where the paper's control swings in a sag, and what makes it."""

import numpy as np
import pytest

from validation.simulator import swings


def test_the_paper_s_control_swings_where_active_power_sets_in(assert_within):
    """It is calm on a stiff grid, and on a weak one well above or below the voltage at which eq (10) sets in."""
    assert_within(swings.paper_rows())
    for case in swings.CASES:
        assert swings.found(*case).p_kw.peak_to_peak > swings.LIMIT_KW


@pytest.mark.slow
def test_the_slope_of_the_active_power_makes_it(assert_within):
    """With a gentle slope, or none, the same sags are calm; with a steep one that is finite they swing."""
    assert_within(swings.slope_rows())
    for case in (*swings.CASES, swings.CALM_BELOW_12):
        assert swings.found(*case, swings.slope_12).p_kw.peak_to_peak > swings.LIMIT_KW


def test_slope_of_eq_10():
    """The closed form of the slope is the difference quotient of eq (10)."""
    p = lambda v: np.sqrt(v**2 - (15 / 7 * (0.85 - v)) ** 2)  # noqa: E731
    for v in (0.585, 0.6, 0.7):
        assert swings.slope_at(v) == pytest.approx((p(v + 1e-6) - p(v - 1e-6)) / 2e-6, rel=1e-6)


def test_eq_10_sets_in_where_q_meets_s_fault():
    """Q by eq (9) is all of S_fault at 0.5795 pu."""
    assert pytest.approx(15 / 7 * (0.85 - swings.MEETS)) == swings.MEETS
