"""Generators, FLLs and PLLs: what each makes of a frequency, probed, beside its transfer function."""

import math
from collections.abc import Callable, Iterable
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from pvlvrt_compliance.control import ddsrf_pll, dsc_pll, dsogi_fll, msogi_fll, srf_pll
from pvlvrt_compliance.control.ddsrf_pll import ddsrf_pll_step
from pvlvrt_compliance.control.dsc_pll import dsc_pll_step
from pvlvrt_compliance.control.dsogi_fll import dsogi_fll_step
from pvlvrt_compliance.control.msogi_fll import msogi_fll_step
from pvlvrt_compliance.control.pll import PllState, pll_step
from pvlvrt_compliance.control.srf_pll import srf_pll_step
from pvlvrt_compliance.kernel import in_python
from validation.blocks.svg import Axes, Figure, curve
from validation.simulator import blocks, frequency_lock, loops
from validation.simulator.evidence import Row, at_most, shown
from validation.simulator.loops import W
from validation.simulator.sequence_filters import passed

_SAMPLES = 4000  # of a pulse response: 164 ms, in which what decays with 222 1/s is gone
_NOTCHES = (-5, 7, -11, 13)


@cache
def pulse_response(name: str) -> NDArray[np.complex128]:
    """Samples of u+ after a pulse of one sample on a dead grid, with the frequency held at 50 Hz."""
    p, T = loops.nominal_controller().sync, loops.nominal_controller().T
    fll, pll = p.fll._replace(gamma=0.0), p.dsc._replace(K_P=0.0, K_I=0.0)
    srf, ddsrf = p.srf._replace(pll=pll), p.ddsrf._replace(pll=pll)
    step, x, params = {
        "msogi-fll": (msogi_fll_step, msogi_fll.locked(0j, W), fll),
        "dsogi-fll": (dsogi_fll_step, dsogi_fll.locked(0j, W), fll),
        "srf-pll": (srf_pll_step, srf_pll.locked(0j, W, srf), srf),
        "ddsrf-pll": (ddsrf_pll_step, ddsrf_pll.locked(0j, W), ddsrf),
        "dsc-pll": (dsc_pll_step, dsc_pll.locked(0j, W, pll.w_min, T), pll),
    }[name]
    step, found = in_python(step), np.empty(_SAMPLES, dtype=np.complex128)
    for n in range(_SAMPLES):
        x, y = step(x, 1 + 0j if n == 0 else 0j, params, T)
        found[n] = y.u_pos
    return found


def as_it_runs(name: str, order: float) -> complex:
    """What of a vector that turns at so many times 50 Hz arrives in u+."""
    angles = order * W * loops.nominal_controller().T * np.arange(_SAMPLES)
    return complex(pulse_response(name) @ np.exp(-1j * angles))


def filter_panel(names: Iterable[str], orders: NDArray[np.float64]) -> Axes:
    """|u+/u| over the frequency, negative ones turning backwards: lines by transfer functions, dots as it runs."""
    curves: list[Any] = []
    few = orders[::6]
    for name in names:
        line = [abs(passed(name, h).positive) for h in orders]
        curves.append(curve(name, 50 * orders, line))
        dots = [abs(as_it_runs(name, float(h))) for h in few]
        said = "" if len(curves) > 1 else "as they run"
        curves.append(curve(said, 50 * few, dots, dots=True, like=len(curves) - 1))
    return Axes("frequency of the vector (Hz)", "|u⁺/u|", tuple(curves))


def orders() -> NDArray[np.float64]:
    """Signed multiples of 50 Hz beside the whole ones, at which the closed forms divide by zero."""
    return np.arange(-13.95, 14, 0.1)


def msogi_figure() -> Figure:
    """With and without the decoupling network."""
    title = "Share of a turning voltage that the MSOGI-FLL and the DSOGI-FLL pass to the positive sequence"
    return Figure("controller/figures/msogi.svg", title, (filter_panel(("msogi-fll", "dsogi-fll"), orders()),))


def pll_figure() -> Figure:
    """Filters in front of the PLLs, and the loop."""
    title = "Share of a turning voltage that each PLL's filter passes to the positive sequence; angle after a jump"
    filters = filter_panel(("srf-pll", "ddsrf-pll", "dsc-pll"), np.arange(-7.95, 8, 0.1))
    return Figure("controller/figures/pll.svg", title, (filters, jump_panel()))


def jump(degrees: float, seconds: float) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Time (s), and by how much of a jump of the angle the frame still lags: as it runs, and linearised."""
    p, T = loops.nominal_controller().sync.dsc, loops.nominal_controller().T
    step, angle = in_python(pll_step), math.radians(degrees)
    x, lag = PllState(theta=0.0, w=W), []
    for n in range(round(seconds / T)):
        left = angle + W * T * n - x.theta
        left = math.remainder(left, 2 * math.pi)
        lag.append(left / angle)
        x = step(x, 398.4 * complex(math.cos(left), math.sin(left)), p, T)
    t = T * np.arange(len(lag), dtype=np.float64)
    zeta, w_n = p.K_P / (2 * math.sqrt(p.K_I)), math.sqrt(p.K_I)
    w_d = w_n * math.sqrt(1 - zeta**2)
    linear = np.exp(-zeta * w_n * t) * (np.cos(w_d * t) - zeta * w_n / w_d * np.sin(w_d * t))
    return t, np.array(lag), linear


def jump_panel() -> Axes:
    """Small and large jump of the angle."""
    t, small, linear = jump(1.0, 0.1)
    _, large, _ = jump(60.0, 0.1)
    dots, line = slice(None, None, 60), slice(None, None, 20)
    curves = (
        curve("linear", 1e3 * t[line], linear[line]),
        curve("1°, as it runs", 1e3 * t[dots], small[dots], dots=True, like=0),
        curve("60°", 1e3 * t[line], large[line], dashed=True),
    )
    return Axes("time after the jump (ms)", "share of the jump still to go", curves)


def sogi_rows() -> tuple[Row, ...]:
    """Cell of the fundamental with K of Table 3."""
    p = loops.nominal_controller()
    K, T = p.sync.fll.K, p.T
    low, high = (W / (4 * math.pi) * (math.sqrt(K * K + 4) + sign * K) for sign in (-1, 1))

    def above(f: float) -> float:
        return float(abs(blocks.generator_response(2 * math.pi * f, T)[0])) - math.sqrt(0.5)

    return (
        *blocks.generator_rows(),
        Row("lower end of the pass band of u′, as it runs (−3 dB)", float(brentq(above, 5, 50)), low, 0.3, "Hz"),
        Row("upper end", float(brentq(above, 50, 200)), high, 1.0, "Hz"),
        shown("width of the band, K w/2π", high - low, "Hz"),
        shown("real part of the poles, −K w/2", -K * W / 2, "1/s"),
        shown("imaginary part, w √(1 − K²/4)", W * math.sqrt(1 - K * K / 4), "1/s"),
    )


def msogi_rows() -> tuple[Row, ...]:
    """Notches of the network, and how fast the frequency follows."""
    gain = max(abs(as_it_runs("msogi-fll", h)) for h in _NOTCHES)
    alone = max(abs(as_it_runs("dsogi-fll", h) - passed("dsogi-fll", h).positive) for h in (-5.05, 2.05, 7.05))
    gamma = loops.nominal_controller().sync.fll.gamma
    return (
        Row("u⁺ of a voltage of 50 Hz, msogi-fll", abs(as_it_runs("msogi-fll", 1.0)), 1.0, 1e-6),
        at_most("u⁺ of a negative sequence of 50 Hz", abs(as_it_runs("msogi-fll", -1.0)), 1e-6, floor=1e-8),
        at_most("largest share of −5th, 7th, −11th and 13th in u⁺, msogi-fll", gain, 1e-6, floor=1e-8),
        shown("share of the −5th in u⁺, dsogi-fll", abs(as_it_runs("dsogi-fll", -5.0))),
        at_most("dsogi-fll: difference from its transfer function, −252 to 353 Hz", alone, 0.02),
        shown("slowest mode of the whole synchronisation", frequency_lock.slowest_mode(gamma), "1/s"),
        shown("time constant of the frequency, 1/Γ, that a slow loop has", 1e3 / gamma, "ms"),
    )


def pll_rows() -> tuple[Row, ...]:
    """Loop with the default bandwidth and damping."""
    p = loops.nominal_controller().sync.dsc
    w_n, zeta = math.sqrt(p.K_I), p.K_P / (2 * math.sqrt(p.K_I))
    t, small, linear = jump(1.0, 0.1)

    def gain(f: float) -> float:
        s: complex = 2j * math.pi * f
        return abs((p.K_P * s + p.K_I) / (s * s + p.K_P * s + p.K_I)) - math.sqrt(0.5)

    return (
        shown("K_P", p.K_P, "1/s"),
        shown("K_I", p.K_I, "1/s²"),
        shown("real part of the poles, −ζ w_n", -zeta * w_n, "1/s"),
        shown("bandwidth of the angle (−3 dB)", float(brentq(gain, 5, 100)), "Hz"),
        at_most("jump of 1°: difference from the linear loop", float(np.abs(small - linear).max()), 0.005),
        Row("overshoot after it", -float(small.min()), -float(linear.min()), 0.005),
        shown("time until 5 % of it are left", 1e3 * float(t[np.abs(small) > 0.05][-1]), "ms"),
        shown("dsc-pll: a quarter of a cycle of 50 Hz", 0.5 * math.pi / (W * loops.nominal_controller().T), "samples"),
        Row("u⁺ of the dsc-pll: share of the −5th", abs(as_it_runs("dsc-pll", -5.0)), 0.0, 0.01),
        Row("u⁺ of the srf-pll: share of the negative sequence", abs(as_it_runs("srf-pll", -1.0)), 0.0, 1e-6),
        at_most("u⁺ of the ddsrf-pll: share of the negative sequence", abs(as_it_runs("ddsrf-pll", -1.0)), 0.01),
    )


ROWS: dict[str, Callable[[], tuple[Row, ...]]] = {"sogi": sogi_rows, "msogi": msogi_rows, "pll": pll_rows}
FIGURES: tuple[Callable[[], Figure], ...] = (msogi_figure, pll_figure)
