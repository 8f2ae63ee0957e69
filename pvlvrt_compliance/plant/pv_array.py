"""PV array: single-diode module, irradiance by De Soto, temperature by the datasheet's coefficients."""

import math
from functools import cache
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.kernel import kernel, plain

STC_IRRADIANCE = 1000.0
"""Irradiance at standard test conditions (W/m2)."""
STC_TEMPERATURE = 25.0
"""Cell temperature at standard test conditions (degrees C)."""

# Beyond this change of the diode voltage (V) a further Newton step is needed: its error is the square of it over 2 a.
_NEWTON_TOLERANCE = 1e-4
_NEWTON_STEPS = 50


class Module(NamedTuple):
    """Datasheet of a module at standard test conditions."""

    V_oc: float  # open-circuit voltage (V)
    I_sc: float  # short-circuit current (A)
    V_mp: float  # voltage at maximum power (V)
    I_mp: float  # current at maximum power (A)
    alpha_isc: float  # relative change of I_sc (1/K)
    beta_voc: float  # relative change of V_oc (1/K)
    gamma_pmp: float  # relative change of maximum power (1/K)
    R_sh: float  # shunt resistance at STC, held fixed (ohm)


STP320_24_VE = Module(
    V_oc=45.6, I_sc=9.07, V_mp=36.7, I_mp=8.72, alpha_isc=0.00067, beta_voc=-0.0033, gamma_pmp=-0.0041, R_sh=1000.0
)
"""Suntech STP320-24/Ve, 72 cells. The coefficients are remembered from the data sheet, not checked against it."""


class PvParams(NamedTuple):
    """Single-diode parameters of one module at the cell temperature of the run, and the array around it."""

    I_L: float  # photocurrent at 1000 W/m2 (A)
    I_0: float  # saturation current (A)
    R_s: float  # series resistance (ohm)
    G_sh: float  # shunt conductance at 1000 W/m2 (S)
    a: float  # modified ideality, n N_s k T / q (V)
    n_series: float  # modules in a string (-)
    n_parallel: float  # strings (-)


class Operating(NamedTuple):
    """A point of the array's characteristic."""

    v: float  # voltage (V)
    p: float  # power (W)


@kernel
def diode_voltage(v: float, G: float, x: float, p: PvParams) -> float:
    """Junction voltage of a module (V) at array voltage ``v`` (V), by Newton from the guess ``x`` (V).

    0 = I_L G - I_0 (exp(x/a) - 1) - G_sh G x - (x - v_module)/R_s, with G in units of 1000 W/m2 (De Soto scaling).
    The left side is concave and falls, so Newton converges from any guess at or above the solution.
    """
    per_a, G_s, G_sh = 1 / p.a, 1 / p.R_s, p.G_sh * G  # constant over a run: the compiler lifts them out of its loops
    source = p.I_L * G + p.I_0 + v / p.n_series * G_s
    for _ in range(_NEWTON_STEPS):
        diode = p.I_0 * math.exp(x * per_a)
        dx = (source - diode - (G_sh + G_s) * x) / (diode * per_a + G_sh + G_s)
        x += dx
        if abs(dx) < _NEWTON_TOLERANCE:
            break
    return x


@kernel
def array_current(v: float, x: float, p: PvParams) -> float:
    """Array current (A) from its voltage (V) and the junction voltage of a module (V)."""
    return p.n_parallel * (x - v / p.n_series) / p.R_s


@cache
def fit(module: Module, temperature: float, n_series: int, n_parallel: int) -> PvParams:
    """Single-diode parameters that meet the datasheet at a cell temperature (degrees C).

    I_sc, V_oc, I_mp and V_mp move linearly with the datasheet's coefficients (I_mp with that of I_sc, V_mp with what
    the one of maximum power leaves); then the four conditions I(0) = I_sc, I(V_oc) = 0, I(V_mp) = I_mp and
    dP/dV(V_mp) = 0 are solved with R_sh fixed.

    Raises
    ------
    UsageError
        When no physical parameters meet the four conditions.
    """
    from scipy.optimize import root

    dT = temperature - STC_TEMPERATURE
    I_sc = module.I_sc * (1 + module.alpha_isc * dT)
    I_mp = module.I_mp * (1 + module.alpha_isc * dT)
    V_oc = module.V_oc * (1 + module.beta_voc * dT)
    V_mp = module.V_mp * (1 + (module.gamma_pmp - module.alpha_isc) * dT)
    G_sh = 1 / module.R_sh

    def conditions(unknowns: np.ndarray) -> list[float]:
        I_L, ln_I_0, R_s, a = unknowns

        def diode(v: float, i: float) -> float:
            return math.exp(min(ln_I_0 + (v + i * R_s) / a, 700.0))

        def current(v: float, i: float) -> float:
            return float(I_L - diode(v, i) + math.exp(ln_I_0) - (v + i * R_s) * G_sh - i)

        slope = diode(V_mp, I_mp) / a + G_sh
        return [
            current(0, I_sc),
            current(V_oc, 0),
            current(V_mp, I_mp),
            I_mp - V_mp * slope / (1 + R_s * slope),
        ]

    a = 1.14 * (temperature + 273.15) / 298.15
    found = root(conditions, [I_sc, math.log(I_sc) - V_oc / a, 0.58, a], tol=1e-13)
    I_L, ln_I_0, R_s, a = (float(value) for value in found.x)
    if max(abs(residual) for residual in conditions(found.x)) > 1e-9 or R_s <= 0 or a <= 0:
        raise UsageError(
            f"no single-diode parameters meet the module's data at a cell temperature of {temperature:g} C"
        )
    return PvParams(
        I_L=I_L, I_0=math.exp(ln_I_0), R_s=R_s, G_sh=G_sh, a=a, n_series=float(n_series), n_parallel=float(n_parallel)
    )


def current_at(v: float, irradiance: float, p: PvParams) -> float:
    """Array current (A) at a voltage (V) and an irradiance (W/m2)."""
    guess = max(v / p.n_series, 0.0) + p.R_s * p.I_L
    x = plain(diode_voltage)(v, irradiance / STC_IRRADIANCE, guess, p)
    return plain(array_current)(v, x, p)


def open_circuit_voltage(irradiance: float, p: PvParams) -> float:
    """Voltage of the array without current (V)."""
    if irradiance <= 0:
        return 0.0
    return _zero_of(lambda v: current_at(v, irradiance, p), 0.0, 2 * p.n_series * p.a * math.log(p.I_L / p.I_0))


def maximum_power_point(irradiance: float, p: PvParams) -> Operating:
    """Voltage (V) and power (W) at which the array gives most."""
    from scipy.optimize import minimize_scalar

    v_oc = open_circuit_voltage(irradiance, p)
    if v_oc == 0:
        return Operating(v=0.0, p=0.0)
    best = minimize_scalar(
        lambda v: -v * current_at(v, irradiance, p),
        bounds=(0.4 * v_oc, v_oc),
        method="bounded",
        options={"xatol": 1e-6},
    )
    return Operating(v=float(best.x), p=float(-best.fun))


def voltage_at_power(power: float, irradiance: float, p: PvParams) -> float:
    """Voltage right of the maximum-power point at which the array gives ``power`` (W, not above the maximum) (V)."""
    best = maximum_power_point(irradiance, p)
    return _zero_of(
        lambda v: v * current_at(v, irradiance, p) - min(power, best.p), best.v, open_circuit_voltage(irradiance, p)
    )


def _zero_of(function, low: float, high: float) -> float:  # type: ignore[no-untyped-def]
    from scipy.optimize import brentq

    return float(brentq(function, low, high, xtol=1e-9)) if function(low) > 0 else low
