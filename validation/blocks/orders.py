"""LVRT logic and current references: what they ask for, as they run and by the paper's equations."""

import cmath
import math
from collections.abc import Callable

import numpy as np

from pvlvrt_compliance.control.current_references import current_references
from pvlvrt_compliance.control.lvrt import LvrtOrder, lvrt_step
from pvlvrt_compliance.kernel import in_python
from pvlvrt_compliance.units import Nominal
from validation.blocks.svg import Axes, Figure, curve
from validation.simulator import loops
from validation.simulator.evidence import Row, at_most, shown

_STRATEGIES = ("constant-p-q", "constant-p-light-q", "constant-p-sinusoidal", "constant-q", "balanced")


def order(V_pos: float, V_neg: float) -> LvrtOrder:
    """What the LVRT logic asks for at these sequences (pu), as it runs."""
    p = loops.nominal_controller().lvrt
    found: LvrtOrder = in_python(lvrt_step)(complex(V_pos * p.u_nom), complex(V_neg * p.u_nom), p)
    return found


def asked(V_pos: float, V_neg: float) -> tuple[float, float]:
    """P and Q (pu) by eqs (7) to (10), written anew."""
    if V_pos >= 0.85:
        return 1.0, 0.0
    S = max(V_pos - V_neg, 0.0)
    Q = min(0.75, 15 / 7 * (0.85 - V_pos), S)
    return math.sqrt(S * S - Q * Q), Q


def lvrt_rows() -> tuple[Row, ...]:
    """Sags of the paper, and where reactive power meets the limit."""
    rows = []
    for name, V_pos, V_neg in (
        ("three-phase 90 %", 0.1, 0.0),
        ("phase c 90 %", 0.7, 0.3),
        ("phase c 50 %", 5 / 6, 1 / 6),
    ):
        found, (P, Q) = order(V_pos, V_neg), asked(V_pos, V_neg)
        rows.append(Row(f"{name}: limit of P*", found.P_limit / 1e3, 500 * P, 1e-6, "kW"))
        rows.append(Row(f"{name}: Q*", found.Q_ref / 1e3, 500 * Q, 1e-6, "kvar"))
    low, high = 0.5, 0.85  # between them the line of eq (9) meets that of eq (8)
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if order(middle, 0.0).P_limit == 0 else (low, middle)
    slope = 15 / 7
    u_nom = Nominal().voltage_ab_v
    meets = slope * 0.85 / (1 + slope) * u_nom
    rows.append(Row("balanced: |u⁺| from which active power is left", low * u_nom, meets, 1e-3, "V"))
    rows.append(shown("limit of P* 0.005 pu above it", order(low + 0.005, 0.0).P_limit / 1e3, "kW"))
    return tuple(rows)


def lvrt_figure() -> Figure:
    """Powers over V+, without and with negative sequence."""
    panels = []
    for said, share in (("balanced", 0.0), ("V⁻ = 0.2 pu", 0.2)):
        V = np.unique([*np.linspace(0.0, 1.05, 64), 0.5, 0.5795, 0.8499, 0.85])
        few = np.linspace(0.0, 1.04, 27)
        P, Q = np.array([asked(v, share) for v in V]).T
        dots = [order(v, share) for v in few]
        panels.append(
            Axes(
                f"V⁺ (pu), {said}",
                "pu",
                (
                    curve("P* limit", V, P),
                    curve("Q*", V, Q),
                    curve("as it runs", few, [x.P_limit / 500e3 for x in dots], dots=True, like=0),
                    curve("", few, [x.Q_ref / 500e3 for x in dots], dots=True, like=1),
                    curve("nominal current", V, np.maximum(V - share, 0.0), dashed=True),
                ),
            )
        )
    return Figure("controller/figures/lvrt.svg", "Powers asked for over the positive sequence", tuple(panels))


def references_figure() -> Figure:
    """Current vector of each strategy over a cycle, in a 90 % sag of phase c."""
    size, ask, strategies = Nominal().current_ab_a, order(0.7, 0.3), []
    angles = np.linspace(0, 2 * math.pi, 91)
    for k, name in enumerate(_STRATEGIES):
        i = np.array([_reference(k + 1, float(a), ask) for a in angles]) / size
        strategies.append(curve(name, i.real, i.imag))
    circle = np.exp(1j * angles)
    strategies.append(curve("nominal", circle.real, circle.imag, dashed=True, like=4))
    panels = (Axes("i_α (pu)", "i_β (pu)", tuple(strategies), equal=True), _powers_panel(ask))
    title = "Hodographs of the reference by each strategy, and the powers that the default makes"
    return Figure("controller/figures/references.svg", title, panels)


def _reference(strategy: int, angle: float, ask: LvrtOrder) -> complex:
    p = loops.nominal_controller()
    pos, neg = (size * p.lvrt.u_nom * cmath.exp(sign * 1j * angle) for size, sign in ((0.7, 1), (0.3, -1)))
    params = p.references._replace(strategy=strategy)
    found: complex = in_python(current_references)(pos, neg, ask.P_limit, ask.Q_ref, params)
    return found


def _powers_panel(ask: LvrtOrder) -> Axes:
    angles, u_nom = np.linspace(0, 2 * math.pi, 73), loops.nominal_controller().lvrt.u_nom
    u = u_nom * (0.7 * np.exp(1j * angles) + 0.3 * np.exp(-1j * angles))
    S = u * np.conj([_reference(3, float(a), ask) for a in angles]) / 1e3
    t = 20 * angles / (2 * math.pi)
    r2 = (0.3 / 0.7) ** 2
    mean = ask.Q_ref / 1e3 * (1 + r2) / (1 - r2)
    curves = (
        curve("P, constant-p-sinusoidal", t, S.real),
        curve("Q", t, S.imag),
        curve("Q* (1 + r²)/(1 − r²)", t[[0, -1]], [mean, mean], dashed=True, like=1),
    )
    return Axes("time (ms)", "kW, kvar", curves)


def references_rows() -> tuple[Row, ...]:
    """Means and swings of the default strategy in a 90 % sag of phase c."""
    ask, u_nom = order(0.7, 0.3), loops.nominal_controller().lvrt.u_nom
    angles = np.linspace(0, 2 * math.pi, 360, endpoint=False)
    u = u_nom * (0.7 * np.exp(1j * angles) + 0.3 * np.exp(-1j * angles))
    S = u * np.conj([_reference(3, float(a), ask) for a in angles]) / 1e3
    r = 0.3 / 0.7
    P, Q = ask.P_limit / 1e3, ask.Q_ref / 1e3
    swing = 2 * r / (1 - r * r) * math.hypot(P, Q)
    largest = max(abs(_reference(3, float(a), ask)) for a in angles) / Nominal().current_ab_a
    return (
        at_most("swing of P", float(np.ptp(S.real) / 2), 1e-6, "kW", floor=1e-6),
        Row("mean of Q", float(S.imag.mean()), Q * (1 + r * r) / (1 - r * r), 1e-6, "kvar"),
        Row("swing of Q", float(np.ptp(S.imag) / 2), swing, 0.05, "kvar"),
        Row("longest current vector", largest, 1.0, 1e-3, "pu"),
    )


ROWS: dict[str, Callable[[], tuple[Row, ...]]] = {"lvrt": lvrt_rows, "references": references_rows}
FIGURES: tuple[Callable[[], Figure], ...] = (lvrt_figure, references_figure)
