"""Regulators, search and modulator: steps and limits, as they run and in closed form."""

import cmath
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.control.current_regulator import at_rest_regulator, current_regulator_step
from pvlvrt_compliance.control.dc_voltage_regulator import DcVoltageRegulatorState, dc_voltage_regulator_step
from pvlvrt_compliance.control.modulator import modulate
from pvlvrt_compliance.control.mppt import mppt_step, searching_from
from pvlvrt_compliance.kernel import in_python
from pvlvrt_compliance.plant.inverter import K_PWM, M_MAX
from pvlvrt_compliance.plant.pv_array import current_at, maximum_power_point
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.sogi import harmonic_turns
from pvlvrt_compliance.space_vectors import clarke
from validation.blocks.svg import Axes, Figure, curve
from validation.simulator import blocks, loops
from validation.simulator.evidence import Row, at_most, shown
from validation.simulator.loops import V_DC, W
from validation.simulator.photovoltaics import array_at


def dc_voltage_step(dv: float, seconds: float) -> tuple[NDArray[np.float64], ...]:
    """Time (s) and deviation of the voltage by that of its reference: as it runs, and linearised."""
    p, C = loops.nominal_controller(), Parameters().plant.dc_link_capacitance_f
    step, P0 = in_python(dc_voltage_regulator_step), 300e3
    x, v, found = DcVoltageRegulatorState(integral=P0), V_DC, []
    for _ in range(round(seconds / p.T)):
        found.append((v - V_DC) / dv)
        x, P, _limited = step(x, v, V_DC + dv, 500e3, p.dc_voltage, p.T)
        v = math.sqrt(v * v + 2 * p.T / C * (P0 - P))  # energy of the link, P0 from the array and P to the grid
    t = p.T * np.arange(len(found), dtype=np.float64)
    a, b = p.dc_voltage.K_P / (C * V_DC), p.dc_voltage.K_I / (C * V_DC)
    roots = np.roots([1, a, b])
    # 1 - s^2/(s^2 + a s + b) is a s + b over the same: a step of it, by partial fractions.
    linear = 1 - sum(root / (root - other) * np.exp(root * t) for root, other in zip(roots, roots[::-1], strict=True))
    return t, np.array(found), np.real(linear)


def dc_voltage_rows() -> tuple[Row, ...]:
    """Closed loop at the voltage of Table 2."""
    p, C = loops.nominal_controller().dc_voltage, Parameters().plant.dc_link_capacitance_f
    w_n = math.sqrt(p.K_I / (C * V_DC))
    t, found, linear = dc_voltage_step(1.0, 0.15)
    return (
        *blocks.voltage_loop_rows()[:5],
        shown("natural frequency of the closed loop, √(K_I/(C v_DC))/2π", w_n / (2 * math.pi), "Hz"),
        shown("damping, K_P/(2 √(K_I C v_DC))", p.K_P / (2 * math.sqrt(p.K_I * C * V_DC))),
        at_most("step of 1 V: difference from the linear loop", float(np.abs(found - linear).max()), 0.01),
        Row("overshoot", float(found.max()) - 1, float(linear.max()) - 1, 0.005),
        shown("time until it stays within 5 %", 1e3 * float(t[np.abs(found - 1) > 0.05][-1]), "ms"),
    )


def dc_voltage_figure() -> Figure:
    """Small step beside the transfer function, and P* at a limit that comes and goes."""
    t, small, linear = dc_voltage_step(1.0, 0.15)
    dots, line = slice(None, None, 90), slice(None, None, 30)
    first = (
        curve("linear", 1e3 * t[line], linear[line]),
        curve("as it runs", 1e3 * t[dots], small[dots], dots=True, like=0),
    )
    panels = (Axes("time (ms)", "v_DC by its step of 1 V", first), _limit_panel())
    title = "Voltage after a step of its reference; power through a limit that is set and lifted"
    return Figure("controller/figures/dc-voltage.svg", title, panels)


def _limit_panel() -> Axes:
    p, C = loops.nominal_controller(), Parameters().plant.dc_link_capacitance_f
    step, array = in_python(dc_voltage_regulator_step), array_at(25.0)
    v, found = 840.0, []
    begin, end = 1200, 4800
    x = DcVoltageRegulatorState(integral=v * current_at(v, 1000.0, array) - p.dc_voltage.K_P * (v - V_DC))
    for k in range(8000):
        limit = 120e3 if begin <= k < end else 500e3
        x, P, _ = step(x, v, V_DC, limit, p.dc_voltage, p.T)
        if k % 40 == 0:
            i = current_at(v, 1000.0, array)  # it moves little in forty periods
        v = math.sqrt(v * v + 2 * p.T / C * (v * i - P))
        found.append((1e3 * p.T * k, P / 1e3, v))
    t, P_kw, volts = np.array(found[::50]).T
    curves = (curve("P* (kW)", t, P_kw), curve("v_DC (V)", t, volts))
    times = f"from {1e3 * p.T * begin:.0f} to {1e3 * p.T * end:.0f} ms"
    return Axes(f"time (ms); limit of P* 120 kW {times}", "kW, V", curves)


def climb(start: float, irradiance: float, seconds: float) -> NDArray[np.float64]:
    """The voltage reference over the samples (V), on a link that follows at once."""
    p, array, step = loops.nominal_controller(), array_at(25.0), in_python(mppt_step)
    x, found, v, i = searching_from(start), [], math.nan, 0.0
    for _ in range(round(seconds / p.T)):
        if x.v_ref != v:
            v = x.v_ref
            i = current_at(v, irradiance, array)
        found.append(v)
        x = step(x, v, i, False, p.mppt)
    return np.array(found)


def mppt_rows() -> tuple[Row, ...]:
    """Pace of the search and what it costs around the maximum."""
    p, array = loops.nominal_controller(), array_at(25.0)
    best = maximum_power_point(800.0, array)
    tail = climb(best.v + 0.1, 800.0, 1.2)[round(0.5 / p.T) :]
    power = np.array([v * current_at(v, 800.0, array) for v in np.unique(tail)])
    weights = np.array([np.mean(tail == v) for v in np.unique(tail)])
    return (
        shown("samples between two perturbations", float(p.mppt.period)),
        shown("pace of v*_DC", p.mppt.dv / (p.mppt.period * p.T), "V/s"),
        shown("maximum-power point at 800 W/m²", best.v, "V"),
        at_most("farthest from it once there", float(np.abs(tail - best.v).max()), 2 * p.mppt.dv, "V"),
        shown("power given up by it", 1e6 * (1 - float(power @ weights) / best.p), "ppm"),
    )


def mppt_figure() -> Figure:
    """Search from both sides."""
    best, T = maximum_power_point(800.0, array_at(25.0)), loops.nominal_controller().T
    curves = []
    for start in (best.v - 10, best.v + 10):
        v = climb(start, 800.0, 1.4)
        at = np.flatnonzero(np.diff(v, prepend=v[0] - 1))
        corners = np.sort(np.r_[at, at[1:] - 1])
        curves.append(curve(f"from {start - best.v:+.0f} V".replace("-", "−"), T * corners, v[corners] - best.v))
    curves.append(curve("maximum power", [0, 1.4], [0, 0], dashed=True))
    title = "Perturb and observe from 10 V on either side of the maximum-power point, 800 W/m²"
    panel = Axes("time (s)", "v*_DC less the voltage of maximum power (V)", tuple(curves))
    return Figure("controller/figures/mppt.svg", title, (panel,))


def regulator_rows() -> tuple[Row, ...]:
    """Gains of the regulator as it runs, and the loop around it."""
    _, e = error_after_step(0.2)
    left = abs(1 / (1 + loops.sampled_current_loop()(W)))
    p = loops.nominal_controller()
    driven = p.lvrt.u_nom / (K_PWM * V_DC * (p.current.K_P + p.current.K_I))
    return (
        *blocks.resonator_rows()[::2],
        *blocks.current_loop_rows(),
        Row("error that i* of 50 Hz leaves, settled", abs(e[-1]), left, 1e-6, "of i*"),
        shown("error that the grid's voltage leaves, u/(K_PWM v_DC (K_P + K_I))", driven, "A"),
    )


def error_after_step(seconds: float) -> tuple[NDArray[np.float64], NDArray[np.complex128]]:
    """Time (s) and what is left of a step of i* along alpha, in the loop as it runs on a short-circuited filter."""
    p, plant = loops.nominal_controller(), Parameters().plant
    step, turns = in_python(current_regulator_step), in_python(harmonic_turns)(W * p.T)
    decay = math.exp(-plant.filter_resistance_ohm * p.T / plant.filter_inductance_h)
    gain = K_PWM * V_DC * (1 - decay) / plant.filter_resistance_ohm
    x: Any = at_rest_regulator()
    i, m, found = 0j, 0j, []
    for n in range(round(seconds / p.T)):
        e = 100 * cmath.exp(1j * W * p.T * n) - i
        found.append(e / 100)
        x, following = step(x, e, W, turns, p.current)
        i, m = decay * i + gain * m, following
    return p.T * np.arange(len(found), dtype=np.float64), np.array(found)


def regulator_figure() -> Figure:
    """Error of the current over time, beside the slowest modes."""
    t, e = error_after_step(0.2)
    first, all_of = t < 0.004, slice(None, None, 24)
    turned = (e * np.exp(-1j * W * t))[first]
    ms = 1e3 * t[first]
    crossover, delay = loops.margin(loops.current_loop(1.5), 300, 2000).crossover_hz, 1.5 * loops.nominal_controller().T
    decay = np.exp(-2 * math.pi * crossover * np.maximum(t[first] - delay, 0.0))
    early = (
        curve("along i*", ms, turned.real),
        curve("across i*", ms, turned.imag),
        curve("e^(−w_x (t − 1.5 T))", ms, decay, dashed=True),
    )
    late = (curve("|e|", 1e3 * t[all_of], np.log10(np.abs(e[all_of]))),)
    panels = (Axes("time (ms)", "error by the step of i*", early), Axes("time (ms)", "lg |e|", late))
    title = "Error of the current after i* of 50 Hz begins, in the loop as it runs"
    return Figure("controller/figures/current-step.svg", title, panels)


def modulator_rows() -> tuple[Row, ...]:
    """Ends of the linear range."""
    p = loops.nominal_controller().modulator
    out = in_python(modulate)(5 + 3j, 0j, V_DC, p)
    u_nom = loops.nominal_controller().lvrt.u_nom
    return (
        Row("longest modulating signal", abs(out), M_MAX, 1e-12),
        Row("longest inverter voltage by v_DC", K_PWM * abs(out), 1 / math.sqrt(2), 1e-12),
        shown("phase amplitude at 807.4 V", math.sqrt(2 / 3) * K_PWM * V_DC * abs(out), "V"),
        shown("least v_DC for nominal voltage", math.sqrt(2) * u_nom, "V"),
        at_most("turn of a signal that is limited", abs(cmath.phase(out / (5 + 3j))), 1e-12, "rad", floor=1e-14),
    )


def modulator_figure() -> Figure:
    """Voltages that the bridge reaches, and which the modulator lets through."""
    corners = [clarke(*(float(k >> n & 1) for n in range(3))) for k in (1, 3, 2, 6, 4, 5, 1)]
    p, step = loops.nominal_controller().modulator, in_python(modulate)
    angles = np.linspace(0, 2 * math.pi, 73)
    let = np.array([K_PWM * step(5 * cmath.exp(1j * a), 0j, V_DC, p) for a in angles])
    nominal = Sag(depth=0).sequences_pu().positive.real * math.sqrt(3) * 230 / V_DC * np.exp(1j * angles)
    curves = (
        curve("hexagon of the bridge", np.real(corners), np.imag(corners)),
        curve("limit of the modulator, as it runs", let.real, let.imag, dots=True),
        curve("nominal grid at 807 V", nominal.real, nominal.imag, dashed=True),
    )
    title = "Inverter voltage by v_DC: what two-level legs reach, what is let through, what the grid needs"
    return Figure("controller/figures/modulator.svg", title, (Axes("u_α/v_DC", "u_β/v_DC", curves, equal=True),))


ROWS: dict[str, Callable[[], tuple[Row, ...]]] = {
    "dc-voltage": dc_voltage_rows,
    "mppt": mppt_rows,
    "regulator": regulator_rows,
    "modulator": modulator_rows,
}
FIGURES: tuple[Callable[[], Figure], ...] = (dc_voltage_figure, mppt_figure, regulator_figure, modulator_figure)
