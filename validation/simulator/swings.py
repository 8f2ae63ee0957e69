"""Finding: P and Q swing for as long as a sag lasts where active power sets in, on a grid that is not stiff."""

import math
from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from pvlvrt_compliance.control.lvrt import LvrtOrder, LvrtParams, lvrt_step
from pvlvrt_compliance.measure.fourier import one_cycle_mean
from pvlvrt_compliance.measure.power import instantaneous_power
from pvlvrt_compliance.measure.swing import Swing, Tone, swing, tone
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.simulate import simulate
from validation.mutations.rebuild import rebuilt_loop
from validation.simulator.evidence import Plot, Row, Section, at_most, shown
from validation.simulator.findings import Finding, checks_of, shell
from validation.simulator.records import in_parallel, without_trips

STRENGTHS = (2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 15.0, 20.0, None)
"""SCR, X/R 10; None: no impedance."""
DEPTHS = (0.40, 0.45, 0.50, 0.52, 0.54, 0.56, 0.58, 0.60, 0.62, 0.65, 0.70)
LIMIT_KW = 25.0
"""Limit of the check `oscillation` in the shipped profiles."""
MEETS = 0.75 * 0.85 / 0.35 / (1 + 0.75 / 0.35)
"""V+ of a balanced sag at which Q by eq (9) meets S_fault, and eq (10) begins with an infinite slope (pu)."""
FIXED_PU = 0.15

FINDING = Finding(
    Scenario(sag=Sag(depth=0.56), duration_s=0.7, scr=6.0, xr=10.0),
    ("--sag", "56%", "--scr", "6", "--xr", "10", "--duration", "700ms"),
    "pass",
)


class Found(NamedTuple):
    """What the half-cycle means do from 0.1 s after the start of a sag to its end."""

    p_kw: Swing
    q_kvar: Swing
    tone: Tone | None
    v_fault_pu: float


def slope_12(u_pos: complex, u_neg: complex, p: LvrtParams) -> LvrtOrder:
    """P of eq (10), but no more than rises by 12 S for 1 pu of voltage from where it sets in."""
    right = lvrt_step(u_pos, u_neg, p)
    P = min(right.P_limit, 12.0 * p.S_nom * max(right.V_fault - MEETS, 0.0)) if right.fault else right.P_limit
    return LvrtOrder(V_fault=right.V_fault, fault=right.fault, P_limit=P, Q_ref=right.Q_ref)


def slope_6(u_pos: complex, u_neg: complex, p: LvrtParams) -> LvrtOrder:
    """The same with 6 S."""
    right = lvrt_step(u_pos, u_neg, p)
    P = min(right.P_limit, 6.0 * p.S_nom * max(right.V_fault - MEETS, 0.0)) if right.fault else right.P_limit
    return LvrtOrder(V_fault=right.V_fault, fault=right.fault, P_limit=P, Q_ref=right.Q_ref)


def slope_3(u_pos: complex, u_neg: complex, p: LvrtParams) -> LvrtOrder:
    """The same with 3 S."""
    right = lvrt_step(u_pos, u_neg, p)
    P = min(right.P_limit, 3.0 * p.S_nom * max(right.V_fault - MEETS, 0.0)) if right.fault else right.P_limit
    return LvrtOrder(V_fault=right.V_fault, fault=right.fault, P_limit=P, Q_ref=right.Q_ref)


def fixed(u_pos: complex, u_neg: complex, p: LvrtParams) -> LvrtOrder:
    """The same P in every sag."""
    right = lvrt_step(u_pos, u_neg, p)
    P = FIXED_PU * p.S_nom if right.fault else right.P_limit
    return LvrtOrder(V_fault=right.V_fault, fault=right.fault, P_limit=P, Q_ref=right.Q_ref)


@cache
def loop_with(order: Callable[..., Any] | None) -> Any:
    """The loop over time with another LVRT logic; None: the paper's."""
    if order is None:
        return None
    return rebuilt_loop(lvrt_step=order)


@cache
def found(depth: float, scr: float | None, order: Callable[..., Any] | None = None) -> Found:
    """Run half a second of a three-phase sag, X/R 10, no relay acting."""
    run = Scenario(sag=Sag(depth=depth), duration_s=0.5, scr=scr, after_s=0.1)
    loop = loop_with(order)
    samples = simulate(run, without_trips(), **({} if loop is None else {"run": loop})).segments[0]
    powers = one_cycle_mean(np.stack(instantaneous_power(samples)) / 1e3, samples.dt_s, 2 * run.frequency_hz)
    judged = (samples.t_s >= run.start_s + 0.1) & (samples.t_s < run.clear_s)
    t_s, step_s = samples.t_s[judged], np.full(judged.sum(), samples.dt_s)
    p_kw, q_kvar = powers[:, judged]
    v_fault_pu = float(samples["v_fault_pu"][judged].mean())
    return Found(swing(t_s, p_kw, step_s), swing(t_s, q_kvar, step_s), tone(t_s, p_kw, step_s), v_fault_pu)


@cache
def swing_map() -> Any:
    """Larger of the swings of P and of Q by depth and SCR (kW or kvar), shape (depths, strengths)."""
    cases = [(depth, scr) for depth in DEPTHS for scr in STRENGTHS]
    sizes = in_parallel(lambda case: max(x.peak_to_peak for x in found(*case)[:2]), cases)
    return np.array(sizes).reshape(len(DEPTHS), len(STRENGTHS))


def _draw_map(figure: Any) -> None:
    axes = figure.subplots()
    sizes = swing_map()
    mesh = axes.pcolormesh(sizes, cmap="YlOrRd", vmin=0, vmax=200, edgecolors="w", linewidth=1)
    for (row, column), size in np.ndenumerate(sizes):
        axes.text(column + 0.5, row + 0.5, f"{size:.0f}", ha="center", va="center", fontsize="x-small")
    names = ["stiff" if scr is None else f"{scr:g}" for scr in STRENGTHS]
    axes.set_xticks(0.5 + np.arange(len(STRENGTHS)), names)
    axes.set_yticks(0.5 + np.arange(len(DEPTHS)), [f"{100 * depth:g} %" for depth in DEPTHS])
    axes.set(xlabel="SCR (X/R 10)", ylabel="depth")
    axes.invert_yaxis()
    axes.grid(False)
    figure.colorbar(mesh, label="peak to peak (kW or kvar)")


CASES = ((0.56, 6.0), (0.60, 5.0), (0.60, 4.0), (0.60, 3.0))
"""Depth and SCR of sags that swing."""
CALM_BELOW_12 = (0.50, 10.0)
"""One that does not, as eq (10) is less steep than 12 S/pu where it comes to rest."""


def _coarse(name: str, size: float, unit: str = "kW") -> Row:
    """A swing that lasts ends where it likes: its last digits are another machine's."""
    return shown(name, 10.0 * round(size / 10), unit)


def _case(depth: float, scr: float) -> str:
    return f"{100 * depth:g} %, SCR {scr:g}"


def paper_rows() -> tuple[Row, ...]:
    """What the paper's control does: how it swings in some cases, and that it is calm on either side of them."""
    rows = [_coarse(f"swing of P, {_case(*case)}", found(*case).p_kw.peak_to_peak) for case in CASES]
    tones = [(case, found(*case).tone) for case in CASES[:2]]
    rows += [shown(f"its frequency, {_case(*case)}", float(round(x.frequency_hz)), "Hz") for case, x in tones if x]
    calm = ((0.50, 6.0), (0.65, 6.0), (0.65, 5.0), (0.56, 20.0), (0.56, None))
    rows += [
        at_most(
            f"swing of P, {100 * depth:g} %, {'stiff' if scr is None else f'SCR {scr:g}'}",
            found(depth, scr).p_kw.peak_to_peak,
            1.0,
            "kW",
            floor=1.0,
        )
        for depth, scr in calm
    ]
    return tuple(rows)


def slope_at(v_pu: float) -> float:
    """How steeply P of eq (10) rises with V+ in a balanced sag (S for 1 pu): P P' = V + Q (15/7), Q' = -15/7."""
    q = 15 / 7 * (0.85 - v_pu)
    return (v_pu + 15 / 7 * q) / math.sqrt(v_pu**2 - q**2)


def slope_rows() -> tuple[Row, ...]:
    """What becomes of it where P rises less steeply, more steeply, or not at all."""
    steep = [_coarse(f"P at most 12 S/pu, {_case(*case)}", found(*case, slope_12).p_kw.peak_to_peak) for case in CASES]
    less = [_coarse(f"P at most 6 S/pu, {_case(*case)}", found(*case, slope_6).p_kw.peak_to_peak) for case in CASES]
    calm = [
        at_most(f"{name}, {_case(*case)}", found(*case, order).p_kw.peak_to_peak, 1.0, "kW", floor=1.0)
        for name, order in (("P at most 3 S/pu", slope_3), ("P fixed at 0.15 S", fixed))
        for case in CASES
    ]
    v_held, v_swings = found(*CALM_BELOW_12).v_fault_pu, found(0.56, 6.0).v_fault_pu
    return (
        *steep,
        *less,
        *calm,
        shown("V_fault, mean, 56 %, SCR 6", v_swings, "pu"),
        shown("V_fault with P fixed at 0.15 S", found(0.56, 6.0, fixed).v_fault_pu, "pu"),
        shown("slope of eq (10) there", slope_at(v_swings), "S/pu"),
        at_most(f"swing of P, {_case(*CALM_BELOW_12)}", found(*CALM_BELOW_12).p_kw.peak_to_peak, 1.0, "kW", floor=1.0),
        shown("slope of eq (10) there, too", slope_at(v_held), "S/pu"),
        _coarse(f"P at most 12 S/pu, {_case(*CALM_BELOW_12)}", found(*CALM_BELOW_12, slope_12).p_kw.peak_to_peak),
    )


def section() -> Section:
    """Section on swings."""
    check = checks_of(FINDING)["oscillation"]
    rows = (
        *paper_rows(),
        *slope_rows(),
        _coarse("swing of P in the report", float(check["measured"])),
    )
    plots = (Plot("swings", "Larger swing of P and Q, half-cycle means, by SCR and depth.", _draw_map, 4.0),)
    return Section("Finding: swings where active power sets in", _TEXT + shell(FINDING), rows, plots)


_TEXT = """In a balanced sag Q by eq (9) takes all of S_fault up to V+ = 0.5795 pu. Above, eq (10) lets active power in,
with an infinite slope at first: 20 kW at 0.580 pu, 70 kW at 0.585 pu. Where the inverter's own current brings V+ there,
behind an impedance, P and Q swing for as long as the sag lasts, at 25 to 60 Hz and undamped, in averaged and switched
inverter alike. One-cycle means hardly show it; half-cycle means, which leave out 2f and its multiples, do. The map has
the larger of both peaks to peaks from 0.1 s after the start of half a second of a three-phase sag to its end, no relay
acting; the check `oscillation` allows 25 kW or kvar. A stiff grid is calm at every depth, and so is a sag that leaves
V+ well above or below that voltage.

Proven by runs in which only P_fault was changed: what swings is the loop from V_fault through P of eq (10) to the
voltage, and its steepness decides. With P held at 0.15 S, about what the swing leaves as its mean, the same sags are
calm at the same voltage: it is neither that voltage itself nor the reactive power, which goes on following the curve.
With P rising by at most 3 S for 1 pu they are calm, too; with 6 S those on the weaker grids swing, with 12 S all as
before. The infinite slope at 0.5795 pu is more than it takes: at 0.592 pu (56 %, SCR 6) eq (10) has a slope of about
8 S/pu left, and swings. At SCR 10 the same slope is calm, and a straight line of 12 S/pu through 0.5795 pu makes that
sag swing in which eq (10) itself is calm. Not proven: where in the loop (sequence filter, FLL, current regulator, grid)
the delay arises that makes a given slope too steep, and the slope at which a given strength begins to swing; neither
was calculated."""
