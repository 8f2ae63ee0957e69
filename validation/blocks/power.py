"""Array and DC link: what they do, as they run and in closed form."""

import math
from collections.abc import Callable
from functools import cache

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import in_python
from pvlvrt_compliance.plant.plant import PlantParams, PlantState, plant_step
from pvlvrt_compliance.plant.protection import NO_TRIP, relays_at_rest
from pvlvrt_compliance.plant.pv_array import (
    array_current,
    current_at,
    diode_voltage,
    maximum_power_point,
    open_circuit_voltage,
    voltage_at_power,
)
from pvlvrt_compliance.plant.switched_bridge import PeriodMean
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.translate import plant_params
from validation.blocks.svg import Axes, Figure, curve
from validation.simulator.blocks import array_slope
from validation.simulator.evidence import Row, at_most, shown
from validation.simulator.loops import W
from validation.simulator.photovoltaics import array_at

SCENARIO = Scenario(sag=Sag(depth=0), duration_s=0.5)


@cache
def nominal_plant() -> PlantParams:
    """The plant with its defaults, at 50 Hz and 1000 W/m2."""
    return plant_params(Parameters(), SCENARIO)


def standing(v_dc: float, i: complex, trip: int, closed: bool) -> PlantState:
    """Plant at a DC voltage (V) and a current (A), its array in balance with the voltage."""
    p = nominal_plant()
    i_pv = current_at(v_dc, 1000.0, p.pv)
    return PlantState(
        i=i,
        v_dc=v_dc,
        x_pv=v_dc / p.pv.n_series + p.pv.R_s * i_pv / p.pv.n_parallel,
        i_pv=i_pv,
        relay=relays_at_rest(complex(p.protection.u_nom), W),
        trip=trip,
        t_trip=0.0,
        closed=closed,
        blocked=False,
        mean=PeriodMean(u=0j, i=i),
    )


def newton_error() -> float:
    """Largest difference of the array's current in the plant from its closed form, of the short-circuit current (-)."""
    p, found = array_at(25.0), 0.0
    for v in np.linspace(0, 1000, 41):
        x = in_python(diode_voltage)(float(v), 0.8, 45.6, p)
        found = max(found, abs(in_python(array_current)(float(v), x, p) - current_at(float(v), 800.0, p)))
    return found / 653.0


def pv_rows() -> tuple[Row, ...]:
    """Points of the characteristic beside Table 1, and what the fit gives."""
    p = array_at(25.0)
    best = maximum_power_point(1000.0, p)
    return (
        Row("open-circuit voltage", open_circuit_voltage(1000.0, p), 1003.2, 1.0, "V"),
        Row("short-circuit current", current_at(0.0, 1000.0, p), 653.04, 0.65, "A"),
        Row("voltage at maximum power", best.v, 807.4, 0.8, "V"),
        Row("maximum power", best.p / 1e3, 506.91, 0.5, "kW"),
        at_most("current by the plant's Newton less Lambert's W, 800 W/m²", newton_error(), 1e-6, "of Isc", 1e-8),
        shown("photocurrent I_L of a module", p.I_L, "A"),
        shown("saturation current, ln I_0", math.log(p.I_0)),
        shown("series resistance R_s of a module", p.R_s, "Ω"),
        shown("modified ideality a", p.a, "V"),
        shown("dp/dv at nominal power, right of the maximum", array_slope() / 1e3, "kW/V"),
        shown("open-circuit voltage at −10 °C", open_circuit_voltage(1000.0, array_at(-10.0)), "V"),
    )


def charging(seconds: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Time (s) and voltage (V) of the link that the array charges alone, from nominal power on."""
    p, step = nominal_plant(), in_python(plant_step)
    x, found = standing(voltage_at_power(500e3, 1000.0, p.pv), 0j, NO_TRIP, False), []
    for _ in range(round(seconds / p.T_S)):
        found.append(x.v_dc)
        x = step(x, 0j, complex(p.protection.u_nom), 0.0, p)
    return p.T_S * np.arange(len(found), dtype=np.float64), np.array(found)


def time_to(volts: NDArray[np.float64], v0: float) -> NDArray[np.float64]:
    """When that link reaches each voltage (s): integral of C dv / i(v), by the closed form of the array."""
    p, fine = nominal_plant(), np.linspace(v0, float(volts[-1]), 4001)
    pace = np.array([p.C / current_at(float(v), 1000.0, p.pv) for v in fine])
    t = np.concatenate(([0.0], np.cumsum(0.5 * (pace[1:] + pace[:-1]) * np.diff(fine))))
    when: NDArray[np.float64] = np.interp(volts, fine, t)
    return when


def link_rows() -> tuple[Row, ...]:
    """Energy, pace and ripple of the link."""
    p = nominal_plant()
    v0 = voltage_at_power(500e3, 1000.0, p.pv)
    t, v = charging(0.05)
    when = float(time_to(np.array([970.0]), v0)[0])
    return (
        shown("voltage at which the array gives 500 kW", v0, "V"),
        shown("energy stored there", 0.5 * p.C * v0**2 / 1e3, "kJ"),
        shown("rise at once when P* goes from 500 kW to 0", 500e3 / (p.C * v0) / 1e3, "V/ms"),
        Row(
            "charged by the array alone: 970 V reached after",
            1e3 * float(np.interp(970.0, v, t)),
            1e3 * when,
            0.02,
            "ms",
        ),
        shown("pole of the link at constant P*, dp/dv/(C v_DC)", array_slope() / (p.C * v0), "1/s"),
        shown("swing of v_DC by 100 kW at 2f, ΔP/(2 w C v_DC)", 100e3 / (2 * W * p.C * v0), "V"),
    )


def link_figure() -> Figure:
    """The array charges the link."""
    t, v = charging(0.06)
    volts = np.linspace(v[0], v[-1], 40)
    dots = slice(None, None, 400)
    panels = (
        Axes(
            "time (ms)",
            "v_DC (V)",
            (
                curve("∫ C dv / i(v)", 1e3 * time_to(volts, float(v[0])), volts),
                curve("as it runs", 1e3 * t[dots], v[dots], dots=True, like=0),
            ),
        ),
        Axes("v_DC (V)", "kW", (curve("power of the array", volts, _power(volts)),)),
    )
    return Figure("plant/figures/dc-link.svg", "Link that the array charges after P* has gone to zero", panels)


def _power(volts: NDArray[np.float64]) -> list[float]:
    return [v * current_at(float(v), 1000.0, nominal_plant().pv) / 1e3 for v in volts]


ROWS: dict[str, Callable[[], tuple[Row, ...]]] = {"pv": pv_rows, "link": link_rows}
FIGURES: tuple[Callable[[], Figure], ...] = (link_figure,)
