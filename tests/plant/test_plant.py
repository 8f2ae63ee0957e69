import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pvlvrt_compliance.plant.pv_array import current_at
from pvlvrt_compliance.scenario.sag import Sag

T_REG = 40.9568e-6
L, R, C, W = 0.15e-3, 1e-3, 0.065, 2 * math.pi * 50
M = 0.7 + 0.05j
"""A constant modulating signal near the source's first voltage: hundreds of amperes build up as the source turns."""


def exact(p, periods: int) -> np.ndarray:
    """State (i_alpha, i_beta, v_DC) after a number of control periods, by another integrator."""

    def slope(t, x):
        i, v = complex(x[0], x[1]), x[2]
        e = math.sqrt(3) * 230 * np.exp(1j * W * (t - 0.3))
        di = (2 / 3 * v * M - e - R * i) / L
        dv = (current_at(v, 1000 * p.G, p.pv) - 2 / 3 * (M * i.conjugate()).real) / C
        return [di.real, di.imag, dv]

    solved = solve_ivp(slope, (0, periods * T_REG), [0, 0, 834.0], method="DOP853", rtol=1e-11, atol=1e-9)
    return solved.y[:, -1]


def test_open_loop_against_another_integrator(plant, open_loop):
    """Two milliseconds under a constant modulating signal agree with scipy's integrator, the better the finer."""
    periods = 48
    errors = []
    for ratio in (4, 8, 16, 32):
        p, tables = plant(ratio)
        i, v_dc = open_loop(p, tables, np.full(periods, M))
        if not errors:
            expected = exact(p, periods)
        errors.append(np.abs(np.array([i[-1].real, i[-1].imag, v_dc[-1]]) - expected))
    assert np.abs(expected[:2]).max() > 100
    assert np.all(errors[1] < [1e-2, 1e-2, 1e-4])  # 8 steps a control period: 10 ppm of the current
    order = np.log2(np.divide(errors[:-1], errors[1:]))
    assert np.allclose(order, 2, atol=0.2)


def test_modulation_beyond_the_linear_range_is_limited(plant, open_loop):
    """The plant limits what any controller hands to it: twice the range and ten times it give one current."""
    p, tables = plant()
    far, farther = (open_loop(p, tables, np.full(10, k * (1 + 1j)))[0] for k in (2, 10))
    assert np.allclose(far, farther)


def test_a_breakpoint_acts_within_the_control_period(plant, open_loop):
    """A sag that starts inside a control period counts from the plant step whose middle it precedes."""
    m = np.full(3, 398 / (834 * 2 / 3) + 0j)
    currents = {}
    for k in (0, 2, 5, 8):
        p, tables = plant(sag=Sag(depth=1), before_s=0.25)
        grid = tables.grid._replace(t=np.array([-1e6, T_REG + k * p.T_S, 1.0]), w=np.zeros(3), theta=np.zeros(3))
        grid = grid._replace(half_rate=np.ones(3, complex))
        currents[k] = open_loop(p, tables._replace(grid=grid), m)[0][1].real
    # 398 V across 0.15 mH for what is left of the period.
    step = math.sqrt(3) * 230 / L * p.T_S
    for k in (0, 2, 5):
        assert currents[k] - currents[8] == pytest.approx((8 - k) * step, rel=2e-3)
