"""The two control loops of the paper: crossover and phase margin, from its gains and from the blocks as they run."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from pvlvrt_compliance.control.controller import ControllerParams
from pvlvrt_compliance.control.current_regulator import leading_output, resonator_step
from pvlvrt_compliance.kernel import in_python
from pvlvrt_compliance.plant.inverter import K_PWM
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.translate import controller_params
from pvlvrt_compliance.sogi import SogiState
from pvlvrt_compliance.vectors import Rotation

W = 2 * math.pi * 50
V_DC = 807.4
"""DC voltage of Table 2 (V)."""
CURRENT_LOOP_HZ, VOLTAGE_LOOP_HZ, PHASE_MARGIN_DEG = 610.4, 12.208, 63.5
"""What the paper states below Table 3."""
ORDERS = (1, 5, 7, 11, 13)

Loop = Callable[[float], complex]
"""Open loop by angular frequency (rad/s)."""


class Margin(NamedTuple):
    """Where an open loop crosses one, and how far its phase is from -180 degrees there."""

    crossover_hz: float
    phase_deg: float


def nominal_controller() -> ControllerParams:
    """Parameters of Table 3 at 50 Hz."""
    return controller_params(Parameters(), Scenario(sag=Sag(depth=0), duration_s=0.5))


def margin(loop: Loop, low_hz: float, high_hz: float) -> Margin:
    """Crossover between two frequencies that enclose one crossing only, and phase margin there."""

    def log_gain(f: float) -> float:
        return math.log(abs(loop(2 * math.pi * f)))

    crossover = float(brentq(log_gain, low_hz, high_hz, xtol=1e-9))
    return Margin(crossover, math.degrees(float(np.angle(-loop(2 * math.pi * crossover)))))


def resonance(s: complex, w: float, w_c: float) -> complex:
    """2 w_c s / (s^2 + 2 w_c s + w^2), eq (6)."""
    return 2 * w_c * s / (s**2 + 2 * w_c * s + w**2)


def filter_admittance(s: complex) -> complex:
    """1/(L s + R) of the filter (S)."""
    plant = Parameters().plant
    return 1 / (plant.filter_inductance_h * s + plant.filter_resistance_ohm)


def current_loop(periods_of_delay: float, v_dc: float = V_DC) -> Loop:
    """PR regulator, delay, inverter and filter, as transfer functions of continuous time."""
    p = nominal_controller()

    def loop(w: float) -> complex:
        s = 1j * w
        regulator = p.current.K_P + p.current.K_I * resonance(s, W, p.current.w_c)
        return complex(K_PWM * v_dc * regulator * np.exp(-s * periods_of_delay * p.T) * filter_admittance(s))

    return loop


def resonator_matrices(h: int, w_c: float, lead: int, T: float) -> tuple[NDArray[np.float64], ...]:
    """Matrices A (2, 2), B (2,) and C (2,) of a resonator as it runs, from its steps out of unit vectors."""
    angle = h * W * T
    turn = Rotation(c=math.cos(angle), s=math.sin(angle))
    step, output = in_python(resonator_step), in_python(leading_output)
    units = (SogiState(u=1 + 0j, qu=0j), SogiState(u=0j, qu=1 + 0j))
    columns = [step(x, 0j, 2 * w_c / (h * W), turn) for x in units]
    driven = step(SogiState(u=0j, qu=0j), 1 + 0j, 2 * w_c / (h * W), turn)
    A = np.array([[x.u.real for x in columns], [x.qu.real for x in columns]])
    return A, np.array([driven.u.real, driven.qu.real]), np.array([output(x, turn, lead).real for x in units])


def resonator_response(w: float, h: int, w_c: float, lead: int, T: float) -> complex:
    """Frequency response of a resonator as it runs."""
    A, B, C = resonator_matrices(h, w_c, lead, T)
    return complex(C @ np.linalg.solve(np.exp(1j * w * T) * np.eye(2) - A, B))


def sampled_current_loop(orders: tuple[int, ...] = ORDERS, v_dc: float = V_DC, lead: int | None = None) -> Loop:
    """The loop as it runs: the regulator's own steps, a period of computation, the hold and the filter, exactly."""
    p = nominal_controller()
    c, T, plant = p.current, p.T, Parameters().plant
    gains = dict(zip(ORDERS, (c.K_I, c.K_I5, c.K_I7, c.K_I11, c.K_I13), strict=True))
    decay = math.exp(-plant.filter_resistance_ohm * T / plant.filter_inductance_h)
    gain = (1 - decay) / plant.filter_resistance_ohm
    ahead = c.lead if lead is None else lead

    def loop(w: float) -> complex:
        z = np.exp(1j * w * T)
        regulator = c.K_P + sum(gains[h] * resonator_response(w, h, c.w_c, ahead, T) for h in orders)
        return complex(K_PWM * v_dc * regulator / z * gain / (z - decay))

    return loop


def largest_pole(orders: tuple[int, ...] = ORDERS, lead: int | None = None, v_dc: float = V_DC) -> float:
    """Largest pole of the closed sampled loop by magnitude: stable below one."""
    p = nominal_controller()
    c, T, plant = p.current, p.T, Parameters().plant
    gains = dict(zip(ORDERS, (c.K_I, c.K_I5, c.K_I7, c.K_I11, c.K_I13), strict=True))
    decay = math.exp(-plant.filter_resistance_ohm * T / plant.filter_inductance_h)
    b = K_PWM * v_dc * (1 - decay) / plant.filter_resistance_ohm
    n = 2 * len(orders)
    # State: current, modulating signal of the period before, resonators. The error is minus the current.
    A = np.zeros((n + 2, n + 2))
    A[0, 0], A[0, 1], A[1, 0] = decay, b, -c.K_P
    for k, h in enumerate(orders):
        part = slice(2 + 2 * k, 4 + 2 * k)
        A_h, B_h, C_h = resonator_matrices(h, c.w_c, c.lead if lead is None else lead, T)
        A[part, part], A[part, 0], A[1, part] = A_h, -B_h, gains[h] * C_h
    return float(np.abs(np.linalg.eigvals(A)).max())


def voltage_loop(v_dc: float = V_DC, slope: float = 0.0) -> Loop:
    """PI regulator on C v dv/dt = p - P*, with the array's dp/dv at the operating point (W/V)."""
    p, C = nominal_controller().dc_voltage, Parameters().plant.dc_link_capacitance_f

    def loop(w: float) -> complex:
        s = 1j * w
        return (p.K_P + p.K_I / s) / (C * v_dc * s - slope)

    return loop
