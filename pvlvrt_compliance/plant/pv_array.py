"""PV array: single-diode module, irradiance by De Soto, temperature by the datasheet's coefficients."""

import math
from collections.abc import Callable
from functools import cache, lru_cache, partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.kernel import kernel

STC_IRRADIANCE = 1000.0
"""Irradiance at standard test conditions (W/m2)."""
STC_TEMPERATURE = 25.0
"""Cell temperature at standard test conditions (degrees C)."""

# Beyond this change of the diode voltage (V) a further Newton step is needed: its error is the square of it over 2 a.
_NEWTON_TOLERANCE = 1e-4
_NEWTON_STEPS = 50
_BISECTIONS = 60
_KEPT = 64  # points of the characteristic that are known: the tests of a run have few weathers


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


def at_temperature(module: Module, temperature: float) -> Module:
    """Datasheet at another cell temperature (degrees C), each value moved linearly by its coefficient.

    I_mp moves with the coefficient of I_sc, and V_mp with what that of maximum power leaves.
    """
    dT = temperature - STC_TEMPERATURE
    return module._replace(
        I_sc=module.I_sc * (1 + module.alpha_isc * dT),
        I_mp=module.I_mp * (1 + module.alpha_isc * dT),
        V_oc=module.V_oc * (1 + module.beta_voc * dT),
        V_mp=module.V_mp * (1 + (module.gamma_pmp - module.alpha_isc) * dT),
    )


@cache
def fit(module: Module, temperature: float, n_series: int, n_parallel: int) -> PvParams:
    """Single-diode parameters that meet the datasheet at a cell temperature (degrees C).

    The four conditions I(0) = I_sc, I(V_oc) = 0, I(V_mp) = I_mp and dP/dV(V_mp) = 0 are solved with R_sh fixed, from
    standard conditions to this temperature in steps small enough for Newton.

    Raises
    ------
    UsageError
        When no physical parameters meet the four conditions.
    """
    solution = np.array([math.log(module.I_sc), 0.5, module.V_oc / 40])  # typical of crystalline silicon
    for T in np.linspace(STC_TEMPERATURE, temperature, 1 + math.ceil(abs(temperature - STC_TEMPERATURE) / 10)):
        at_T = at_temperature(module, float(T))
        solution = _newton(partial(_conditions, module=at_T), solution)
    ln_I_d, R_s, a = map(float, solution)
    if not (R_s > 0 and a > 0):
        raise UsageError(f"no single-diode parameters meet the module's data at a cell of {temperature:g} C")
    I_0 = math.exp(ln_I_d - at_T.V_oc / a)
    G_sh = 1 / module.R_sh
    return PvParams(
        I_L=I_0 * math.expm1(at_T.V_oc / a) + at_T.V_oc * G_sh,
        I_0=I_0,
        R_s=R_s,
        G_sh=G_sh,
        a=a,
        n_series=float(n_series),
        n_parallel=float(n_parallel),
    )


def _conditions(unknowns: NDArray[np.complex128], module: Module) -> NDArray[np.complex128]:
    """What is left of I(0) = I_sc, I(V_mp) = I_mp (A) and dP/dV(V_mp) = 0 (A); I_L is eliminated by I(V_oc) = 0.

    The unknowns are ln of the diode's exponential at V_oc (A), R_s (ohm) and a (V): with ln I_0 itself in the place of
    the first, Newton would run away.
    """
    ln_I_d, R_s, a = unknowns
    G_sh = 1 / module.R_sh

    def current_left(v: float, i: float) -> complex:
        x = v + i * R_s
        diodes = np.exp(ln_I_d) * (1 - np.exp((x - module.V_oc) / a))
        return complex(diodes + (module.V_oc - x) * G_sh - i)

    slope = np.exp(ln_I_d + (module.V_mp + module.I_mp * R_s - module.V_oc) / a) / a + G_sh
    return np.array(
        [
            current_left(0.0, module.I_sc),
            current_left(module.V_mp, module.I_mp),
            module.I_mp - module.V_mp * slope / (1 + R_s * slope),
        ]
    )


def _newton(
    function: Callable[[NDArray[np.complex128]], NDArray[np.complex128]], guess: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Zero of a small analytic system, by Newton with derivatives from a complex step; not a number if none is found.

    scipy.optimize would do, but importing it takes longer than everything else that a run does.
    """
    x = guess.copy()
    for _ in range(_NEWTON_STEPS):
        steps = [function(x + 1e-30j * axis).imag / 1e-30 for axis in np.eye(len(x))]
        try:
            dx = np.linalg.solve(np.transpose(steps), function(x.astype(np.complex128)).real)
        except np.linalg.LinAlgError:
            return np.full_like(x, math.nan)
        x -= dx
        if np.all(np.abs(dx) <= 1e-13 * np.abs(x)):
            break
    else:
        x[:] = math.nan
    return x


def current_at(v: float, irradiance: float, p: PvParams) -> float:
    """Array current (A) at a voltage (V) and an irradiance (W/m2): the closed form by Lambert's W."""
    G = irradiance / STC_IRRADIANCE
    G_sh = p.G_sh * G
    v_module = v / p.n_series
    shunted = p.a * (1 + p.R_s * G_sh)
    source = p.I_L * G + p.I_0
    argument = p.R_s * p.I_0 / shunted * math.exp((p.R_s * source + v_module) / shunted)
    i = (source - v_module * G_sh) / (1 + p.R_s * G_sh) - p.a / p.R_s * lambert_w(argument)
    return p.n_parallel * i


def lambert_w(x: float) -> float:
    """W where W exp(W) = x, for x of 0 and more, to two units of the last digit.

    scipy.special has it, too, but importing that takes as long as numba.
    """
    # log(1 + x) is never below W, and W exp(W) - x is convex: Newton falls until rounding alone is left.
    w = math.log1p(x)
    while (lower := w - (w - x * math.exp(-w)) / (1 + w)) < w:
        w = lower
    return w


@lru_cache(maxsize=_KEPT)
def open_circuit_voltage(irradiance: float, p: PvParams) -> float:
    """Voltage of the array without current (V)."""
    v_far = 2 * p.n_series * p.a * math.log(p.I_L / p.I_0)
    return _zero_of(lambda v: current_at(v, irradiance, p), 0.0, v_far)


@lru_cache(maxsize=_KEPT)
def maximum_power_point(irradiance: float, p: PvParams) -> Operating:
    """Voltage (V) and power (W) at which the array gives most: where dP/dV = 0."""

    def power_slope(v: float) -> float:
        i = current_at(v, irradiance, p)
        x = v / p.n_series + p.R_s * i / p.n_parallel
        g = p.I_0 / p.a * math.exp(x / p.a) + p.G_sh * irradiance / STC_IRRADIANCE
        return i - v * p.n_parallel / p.n_series * g / (1 + p.R_s * g)

    v = _zero_of(power_slope, 0.0, open_circuit_voltage(irradiance, p))
    return Operating(v=v, p=v * current_at(v, irradiance, p))


@lru_cache(maxsize=_KEPT)
def voltage_at_power(power: float, irradiance: float, p: PvParams) -> float:
    """Voltage right of the maximum-power point at which the array gives ``power`` (W, not above the maximum) (V)."""
    best = maximum_power_point(irradiance, p)
    v_oc = open_circuit_voltage(irradiance, p)
    return _zero_of(lambda v: v * current_at(v, irradiance, p) - min(power, best.p), best.v, v_oc)


def _zero_of(falling: Callable[[float], float], low: float, high: float) -> float:
    """Zero of a falling function by bisection, to the last digits; ``low`` when it is not positive there."""
    if falling(low) <= 0:
        return low
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if falling(middle) > 0 else (low, middle)
    return 0.5 * (low + high)
