"""Inverter, pulses, switched bridge and line: what they do, as they run and in closed form."""

import cmath
import math
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import in_python
from pvlvrt_compliance.plant import line
from pvlvrt_compliance.plant.carrier import Pulses, duties, pulses_of
from pvlvrt_compliance.plant.diode_bridge import blocked_voltage
from pvlvrt_compliance.plant.inverter import K_PWM, limit_modulation, modulated
from pvlvrt_compliance.plant.line import line_step, pcc_voltage
from pvlvrt_compliance.plant.plant import blocked_plant_step
from pvlvrt_compliance.plant.protection import OVERCURRENT
from pvlvrt_compliance.plant.pv_array import (
    current_at,
    voltage_at_power,
)
from pvlvrt_compliance.plant.switched_bridge import DeviceParams, PeriodMean, switched_flow
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.translate import device_params, nominal_of
from pvlvrt_compliance.vectors import Phases, phases_of, vector_of
from validation.blocks.power import SCENARIO, nominal_plant, standing
from validation.blocks.svg import Axes, Figure, curve
from validation.simulator import loops
from validation.simulator.evidence import Row, at_most, shown
from validation.simulator.loops import V_DC, W

_M = 0.85  # length of a modulating signal that is about that of normal operation


def after_trip(seconds: float) -> tuple[NDArray[np.float64], NDArray[np.complex128], NDArray[np.bool_]]:
    """Time (s), current (A) and whether the breaker is closed, from an overcurrent trip in normal operation on."""
    p, step = nominal_plant(), in_python(blocked_plant_step)
    u = p.protection.u_nom * cmath.exp(0.5j)  # at the angle of an instant at which the phases differ
    i0 = 500e3 / p.protection.u_nom**2 * u
    x, i, closed = standing(voltage_at_power(500e3, 1000.0, p.pv), i0, OVERCURRENT, True), [], []
    for n in range(round(seconds / p.T_S)):
        i.append(x.i)
        closed.append(x.closed)
        x = step(x, u * cmath.exp(1j * W * (n + 0.5) * p.T_S), 0.0, p)
    return p.T_S * np.arange(len(i), dtype=np.float64), np.array(i), np.array(closed)


def inverter_rows() -> tuple[Row, ...]:
    """Gain of the modulated bridge at its end."""
    longest = K_PWM * V_DC * abs(in_python(limit_modulation)(9 + 0j))
    return (
        shown("voltage at the end of the linear range, 807.4 V", longest, "V"),
        Row("the same by v_DC", longest / V_DC, 1 / math.sqrt(2), 1e-12),
    )


def blocked_rows() -> tuple[Row, ...]:
    """What diodes put against a current, and for how long."""
    p = nominal_plant()
    t, i, closed = after_trip(0.003)
    ended = float(t[i == 0][0])
    return (
        *(
            Row(f"voltage against a current of phase a that returns by {name}, by v_DC", found, expected, 1e-12)
            for name, found, expected in _against()
        ),
        shown("nominal current of a blocked bridge ends after", 1e3 * ended, "ms"),
        Row("the breaker opens after", 1e3 * float(t[~closed][0]), 1e3 * ended, 0.01, "ms"),
        shown("least v_DC at which diodes let no current build up", math.sqrt(2) * p.protection.u_nom, "V"),
    )


def _against() -> Iterator[tuple[str, float, float]]:
    """What phase a's current returns by, and the voltage of the diodes against it by v_DC: found, expected (-)."""
    for name, back, share in (
        ("both others", Phases(2.0, -1.0, -1.0), 2 / 3),
        ("one other", Phases(1.0, -1.0, 0.0), 0.5),
    ):
        u = in_python(blocked_voltage)(in_python(vector_of)(back), 0j, V_DC, 0.0)
        yield name, -in_python(phases_of)(u).a / V_DC, share


def inverter_figure() -> Figure:
    """Voltage of the bridge by the modulating signal, up to the end of its range and beyond."""
    sizes = np.linspace(0, 1.5, 61)
    out = np.array([abs(in_python(modulated)(in_python(limit_modulation)(complex(m)), 0j, V_DC).u) for m in sizes])
    curves = (
        curve("bridge", sizes, out),
        curve("2/3 v_DC |m|", sizes, K_PWM * V_DC * sizes, dashed=True, like=0),
        curve("v_DC/√2", [0.0, 1.5], [V_DC / math.sqrt(2)] * 2, dashed=True),
    )
    title = "Length of the inverter's voltage at 807.4 V: in proportion to m, up to the end of the linear range"
    return Figure("plant/figures/inverter.svg", title, (Axes("|m|", "V", curves),))


def trip_figure() -> Figure:
    """Current of a blocked bridge."""
    t, i, closed = after_trip(0.0004)
    few = slice(None, None, 2)
    phases = np.array([in_python(phases_of)(x) for x in i]).T
    curves = [curve(f"i_{name}", 1e3 * t[few], x[few]) for name, x in zip("abc", phases, strict=True)]
    opens = 1e3 * float(t[~closed][0])
    curves.append(curve("the breaker opens", [opens, opens], [-1000, 1000], dashed=True))
    title = "Phase currents after a trip at nominal power: the diodes end them, then the breaker opens"
    return Figure("plant/figures/trip.svg", title, (Axes("time after the trip (ms)", "A", tuple(curves)),))


def pwm_rows() -> tuple[Row, ...]:
    """Period, duties and what the smallest of them mean."""
    p = nominal_plant()
    T = p.ratio * p.T_S
    angles = np.linspace(0, 2 * math.pi, 361)
    duty = np.array([in_python(duties)(_M * cmath.exp(1j * a)) for a in angles])
    worst = max(abs(_mean_voltage(_M * cmath.exp(1j * a)) - K_PWM * _M * cmath.exp(1j * a)) for a in angles[::30])
    limit = np.array([in_python(duties)(3 / math.sqrt(8) * cmath.exp(1j * a)) for a in angles])
    return (
        Row("frequency of the carrier", 1e-3 / T, 24.416, 0.001, "kHz"),
        at_most("mean of the legs by v_DC less 2/3 m, |m| = 0.85", worst, 1e-9, floor=1e-12),
        shown("smallest duty at |m| = 0.85", float(duty.min())),
        Row("smallest duty at the end of the linear range", float(limit.min()), 0.0, 1e-4),
        shown("dead time by the period", 1e-6 * Parameters().plant.dead_time_us / T),
        shown("largest duty whose dead time ends within the period", 1 - 2e-6 * Parameters().plant.dead_time_us / T),
    )


def _mean_voltage(m: complex) -> complex:
    """Mean of the three legs over a period as a vector, by v_DC."""
    T = nominal_plant().ratio * nominal_plant().T_S
    found: Pulses = in_python(pulses_of)(m, T)
    a, b, c = ((pulse.down - pulse.up) / T for pulse in found)
    return complex(math.sqrt(2 / 3) * (a - 0.5 * b - 0.5 * c), math.sqrt(0.5) * (b - c))


def pwm_figure() -> Figure:
    """Duties over a cycle, and the pulses of a period."""
    angles = np.linspace(0, 2 * math.pi, 73)
    found = np.array([in_python(duties)(_M * cmath.exp(1j * a)) for a in angles]).T
    degrees = np.degrees(angles)
    sine = 0.5 + K_PWM * _M * math.sqrt(2 / 3) * np.cos(angles)
    legs = [curve(f"leg {name}", degrees, x) for name, x in zip("abc", found, strict=True)]
    legs.append(curve("a, without zero sequence", degrees, sine, dashed=True, like=0))
    panels = (Axes("angle of m (°)", "duty", tuple(legs)), _pulses_panel())
    return Figure(
        "plant/figures/pwm.svg", "Duties of the three legs over a cycle; carrier and pulses of a period", panels
    )


def _pulses_panel() -> Axes:
    T, m = nominal_plant().ratio * nominal_plant().T_S, _M * cmath.exp(0.5j)
    duty, found = in_python(duties)(m), in_python(pulses_of)(m, T)
    curves = [curve("carrier", [0, 5e5 * T, 1e6 * T], [1, 0, 1])]
    for k, (name, level, pulse) in enumerate(zip("abc", duty, found, strict=True)):
        x = 1e6 * np.array([0, pulse.up, pulse.up, pulse.down, pulse.down, T])
        curves.append(curve(f"leg {name}", x, -0.3 - 0.35 * k + 0.25 * np.array([0, 0, 1, 1, 0, 0])))
        curves.append(curve("", [0, 1e6 * T], [level, level], dashed=True, like=k + 1 if k == 0 else 1 + 2 * k))
    return Axes("time in the period (µs)", "duty; states below", tuple(curves))


def period_of(devices: DeviceParams, m: complex, i: complex, v: float, e: complex) -> tuple[complex, float, PeriodMean]:
    """Current (A) and link voltage (V) at the end of a carrier period, and its means, with a constant source (V)."""
    p, flow = nominal_plant(), in_python(switched_flow)
    pulses = in_python(pulses_of)(m, p.ratio * p.T_S)
    u_mean, i_mean = 0j, 0j
    i_pv = current_at(v, 1000.0, p.pv)
    for n in range(p.ratio):
        found = flow(i, v, i_pv, e, n, pulses, p.line, p.C, p.T_S, devices)
        i, v = found.i, found.v_dc
        u_mean += found.mean.u / p.ratio
        i_mean += found.mean.i / p.ratio
    return i, v, PeriodMean(u=u_mean, i=i_mean)


def bridge_rows() -> tuple[Row, ...]:
    """Voltages that dead time and devices take, and the losses at nominal."""
    p, real = nominal_plant(), device_params(Parameters())
    ideal, dead = DeviceParams(t_dead=0.0, v_drop=0.0, t_loss=0.0), DeviceParams(real.t_dead, 0.0, 0.0)
    filter_loss = Parameters().plant.filter_resistance_ohm * nominal_of(Parameters(), SCENARIO).current_ab_a ** 2
    T, v = p.ratio * p.T_S, voltage_at_power(500e3 + 2436.0 + filter_loss, 1000.0, p.pv)
    m = _M * cmath.exp(0.2j)
    i, e = 1255 * cmath.exp(0.2j), K_PWM * v * m
    means = [period_of(devices, m, i, v, e)[2].u for devices in (ideal, dead, real._replace(t_dead=0.0))]
    per_phase = math.sqrt(2 / 3) * 2  # length of the vector of 1, -1, -1
    rms = nominal_of(Parameters(), SCENARIO).current_ab_a / math.sqrt(3)
    mean = 2 * math.sqrt(2) / math.pi * rms  # of the magnitude
    plant = Parameters().plant
    conduction = 3 * (plant.device_drop_v * mean + plant.device_resistance_ohm * rms * rms)
    switching = 3 / T * real.t_loss * v * mean
    return (
        at_most("ideal legs: mean voltage less 2/3 v_DC m", abs(means[0] - K_PWM * v * m), 0.2, "V"),
        Row("lost to dead time, signs +, −, −", abs(means[1] - means[0]), per_phase * v * real.t_dead / T, 0.05, "V"),
        Row("lost to device drops, signs +, −, −", abs(means[2] - means[0]), per_phase * real.v_drop, 0.01, "V"),
        shown("v_DC at which the array gives 500 kW and all losses", v, "V"),
        shown("dead time by phase, v_DC t_dead/T", v * real.t_dead / T, "V"),
        shown("conduction at nominal current, 3 (v_drop I_m + R_on I²)", conduction, "W"),
        shown("switching there, 3/T · t_loss v_DC I_m", switching, "W"),
        Row("both, beside the paper's module", conduction + switching, 2436.0, 5.0, "W"),
    )


def line_response(f: float) -> complex:
    """Current by inverter voltage (S) of the line as it runs, on a stiff grid."""
    p = nominal_plant()
    step = in_python(line_step)
    pole, gain = step(1 + 0j, 0j, 0j, p.line), step(0j, 1 + 0j, 0j, p.line)
    z = cmath.exp(2j * math.pi * f * p.T_S)
    return complex(gain * cmath.exp(0.5j * 2 * math.pi * f * p.T_S) / (z - pole))  # voltages of the middle of a step


def line_rows() -> tuple[Row, ...]:
    """Pole, reactance, and the admittance as it runs."""
    plant = Parameters().plant
    L, R = plant.filter_inductance_h, plant.filter_resistance_ohm
    Z = nominal_of(Parameters(), SCENARIO).impedance_ohm
    weak = line.design(L, R, 0.1e-3, 1e-3, nominal_plant().T_S)
    # 1 V along alpha from the inverter, none from the source, no current: the divider of the inductances.
    share = in_python(pcc_voltage)(0j, 1 + 0j, 0j, weak).real
    rows = [
        Row(
            f"|i/u| at {f:g} Hz, as it runs",
            abs(line_response(f)),
            abs(loops.filter_admittance(2j * math.pi * f)),
            tol,
            "S",
        )
        for f, tol in ((50.0, 1e-4), (650.0, 1e-4), (10000.0, 1e-3))
    ]
    return (
        shown("pole, −R/L", -R / L, "1/s"),
        shown("reactance of the filter at 50 Hz", W * L / Z, "pu"),
        shown("what a plant step leaves of the current", nominal_plant().line.decay),
        *rows,
        Row("share of u_inv at the terminals behind 0.1 mH", share, 0.1 / 0.25, 1e-12),
    )


def line_figure() -> Figure:
    """Admittance of the filter."""
    f, few = np.geomspace(0.2, 90e3, 70), np.geomspace(0.2, 90e3, 30)

    def panel(said: str, of: Callable[[complex], float]) -> Axes:
        exact = [of(complex(loops.filter_admittance(2j * math.pi * x))) for x in f]
        return Axes(
            "frequency (Hz)",
            said,
            (
                curve("1/(L s + R)", f, exact),
                curve("as it runs", few, [of(line_response(x)) for x in few], dots=True, like=0),
            ),
            log=True,
        )

    panels = (
        panel("gain (dB of 1 S)", lambda y: 20 * math.log10(abs(y))),
        panel("phase (degrees)", lambda y: math.degrees(cmath.phase(y))),
    )
    return Figure("plant/figures/line.svg", "Admittance of the filter, as a transfer function and as it runs", panels)


ROWS: dict[str, Callable[[], tuple[Row, ...]]] = {
    "inverter": inverter_rows,
    "blocked": blocked_rows,
    "pwm": pwm_rows,
    "bridge": bridge_rows,
    "line": line_rows,
}
FIGURES: tuple[Callable[[], Figure], ...] = (inverter_figure, trip_figure, pwm_figure, line_figure)
