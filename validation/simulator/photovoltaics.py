"""The PV array against pvlib, and its temperature against the coefficients of the datasheet."""

from typing import Any

import numpy as np

from pvlvrt_compliance.kernel import in_python
from pvlvrt_compliance.plant.pv_array import (
    STP320_24_VE,
    PvParams,
    array_current,
    current_at,
    diode_voltage,
    fit,
    maximum_power_point,
    open_circuit_voltage,
)
from validation.simulator.evidence import Plot, Row, Section, at_most

IRRADIANCES = (100.0, 200.0, 400.0, 600.0, 800.0, 1000.0, 1200.0)
TEMPERATURES = (-10.0, 0.0, 50.0, 75.0)
CURRENT_LIMIT = 1e-6
_SERIES, _PARALLEL = 22, 72


def array_at(temperature: float) -> PvParams:
    """The array of the paper at a cell temperature (degrees C)."""
    return fit(STP320_24_VE, temperature, _SERIES, _PARALLEL)


def voltages(irradiance: float) -> np.ndarray:
    """Voltages (V) from short circuit to beyond open circuit."""
    return np.linspace(0, 1.02 * open_circuit_voltage(irradiance, array_at(25.0)), 81)


def pvlib_currents(irradiance: float) -> np.ndarray:
    """Currents (A) by pvlib's single-diode equation at `voltages`."""
    from pvlib.pvsystem import i_from_v

    p, G = array_at(25.0), irradiance / 1000
    v = voltages(irradiance) / p.n_series
    module: np.ndarray = i_from_v(v, p.I_L * G, p.I_0, p.R_s, 1 / (p.G_sh * G), p.a, method="newton")
    return p.n_parallel * module


def kernel_currents(irradiance: float) -> np.ndarray:
    """Currents (A) as the plant's step finds them: Newton's iteration from the voltage before."""
    p, junction = array_at(25.0), in_python(diode_voltage)
    x, found = 0.0, []
    for v in voltages(irradiance):
        x = junction(float(v), irradiance / 1000, x, p)
        found.append(in_python(array_current)(float(v), x, p))
    return np.array(found)


def closed_form_currents(irradiance: float) -> np.ndarray:
    """Currents (A) by the closed form that start values and reports use."""
    p = array_at(25.0)
    return np.array([current_at(float(v), irradiance, p) for v in voltages(irradiance)])


def current_rows() -> tuple[Row, ...]:
    """Largest differences of the currents, of the short-circuit current."""
    found = []
    for irradiance in IRRADIANCES:
        theirs = pvlib_currents(irradiance)
        for name, ours in (("kernel", kernel_currents(irradiance)), ("closed form", closed_form_currents(irradiance))):
            apart = float(np.abs(ours - theirs).max() / theirs[0])
            found.append(at_most(f"I(v) at {irradiance:g} W/m2, {name}", apart, CURRENT_LIMIT, "of Isc", floor=1e-8))
    return tuple(found)


def table_rows() -> tuple[Row, ...]:
    """Table 1 of the paper, each within 0.1 %."""
    p = array_at(25.0)
    best = maximum_power_point(1000.0, p)
    figures = (
        ("open-circuit voltage", open_circuit_voltage(1000.0, p), 1003.2, "V"),
        ("short-circuit current", current_at(0.0, 1000.0, p), 653.04, "A"),
        ("voltage at maximum power", best.v, 807.4, "V"),
        ("current at maximum power", best.p / best.v, 627.84, "A"),
        ("maximum power", best.p / 1e3, 506.91, "kW"),
    )
    return tuple(Row(name, x, paper, 1e-3 * paper, unit) for name, x, paper, unit in figures)


def temperature_rows() -> tuple[Row, ...]:
    """Mean change from 25 degrees C to each temperature beside the datasheet's coefficient (%/K)."""
    module, found = STP320_24_VE, []
    standard = array_at(25.0)
    for T in TEMPERATURES:
        warm, dT = array_at(T), T - 25.0
        changes = (
            (
                "V_oc",
                open_circuit_voltage(1000.0, warm) / open_circuit_voltage(1000.0, standard),
                module.beta_voc,
                1e-4,
            ),
            ("I_sc", current_at(0.0, 1000.0, warm) / current_at(0.0, 1000.0, standard), module.alpha_isc, 1e-4),
            # V_mp and I_mp move linearly, so the power has a part in the square of the difference.
            (
                "P_mp",
                maximum_power_point(1000.0, warm).p / maximum_power_point(1000.0, standard).p,
                module.gamma_pmp + module.alpha_isc * (module.gamma_pmp - module.alpha_isc) * dT,
                1e-4,
            ),
        )
        found += [
            Row(
                f"{name} at {T:g} degrees C",
                100 * (ratio - 1) / dT,
                100 * coefficient,
                100 * abs(coefficient) * tol,
                "%/K",
            )
            for name, ratio, coefficient, tol in changes
        ]
    return tuple(found)


def curves(figure: Any) -> None:
    """Draw I(v) at some irradiances, ours as lines and pvlib's as points."""
    axes = figure.subplots()
    for irradiance in IRRADIANCES[1::2]:
        v = voltages(irradiance)
        axes.plot(v, kernel_currents(irradiance), label=f"{irradiance:g} W/m2")
        axes.plot(v[::5], pvlib_currents(irradiance)[::5], "k.", markersize=3)
    axes.set(xlabel="voltage (V)", ylabel="current (A)", ylim=(0, None))
    axes.legend(loc="lower left")


def section() -> Section:
    """Section on the PV array."""
    return Section(
        title="PV array against pvlib",
        text="""The array is a single-diode module, 22 in series and 72 in parallel, whose parameters meet the four
conditions of the datasheet (short circuit, open circuit, current at maximum power, and that it is the maximum) with
the shunt resistance held fixed. Photocurrent and shunt conductance scale with irradiance (De Soto). pvlib solves
the same equation by its own Newton iteration; the difference is compared as a part of the short-circuit current,
over 81 voltages from 0 to 1.02 times the open-circuit voltage. Both forms of ours are shown: the iteration inside
the plant's step, which starts from the value before, and the closed form.

Temperature is the cell's. De Soto's law for it would change the open-circuit voltage of this parameter set by -0.08
%/K only, so it is not used: the datasheet's values move linearly by their coefficients, and the conditions are
solved again at each temperature. The table shows the mean change from 25 degrees C beside the coefficient; that of
P_mp carries the small second-order part of a product of two straight lines.""",
        rows=(*table_rows(), *current_rows(), *temperature_rows()),
        plots=(Plot("pv", "Characteristics: lines are the simulator's, points are pvlib's.", curves),),
    )
