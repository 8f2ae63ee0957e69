"""What a weak grid can carry, in closed form, and runs of the simulator on it."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from pvlvrt_compliance.scenario.events import GridStrength, VoltageProfile
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters, parameters_from
from pvlvrt_compliance.waveforms import Segment
from validation.simulator.closed_forms import closed_form
from validation.simulator.records import NO_TRIPS, NOMINAL, record

THRESHOLD = 0.85
"""V_fault below which a fault is flagged (pu)."""
HELD_HZ = (45.0, 55.0)
"""Synchronism counts as lost when the estimate on a grid at 50 Hz leaves this band later than 0.1 s after an event."""


def impedance(scr: float, xr: float) -> complex:
    """Grid impedance (pu)."""
    return (1 / xr + 1j) / abs(1 / xr + 1j) / scr


def largest_power(scr: float, xr: float, E: float = 1.0) -> float:
    """Most active power (pu) that reaches the source E at unity power factor: E^2 / (2 (|Z| - R))."""
    Z = impedance(scr, xr)
    return E**2 / (2 * (abs(Z) - Z.real))


def voltage_at_power(P: float, scr: float, xr: float) -> float:
    """Voltage (pu) at the PCC of an inverter that feeds P at unity power factor; NaN when the grid cannot carry it.

    E^2 = (V - R P/V)^2 + (X P/V)^2, the stable one of two solutions, E = 1.
    """
    Z = impedance(scr, xr)
    half = Z.real * P + 0.5
    inside = half**2 - abs(Z * P) ** 2
    return math.sqrt(half + math.sqrt(inside)) if inside >= 0 else math.nan


def weakest_for_nominal(xr: float) -> float:
    """Lowest SCR at which nominal power flows and V stays above the detector's threshold."""
    need = brentq(lambda scr: largest_power(scr, xr) - 1, 0.1, 20)
    if voltage_at_power(1, need * (1 + 1e-9), xr) >= THRESHOLD:
        return float(need)
    return float(brentq(lambda scr: voltage_at_power(1, scr, xr) - THRESHOLD, need * (1 + 1e-9), 50))


def voltage_in_fault_mode(E: float, scr: float, xr: float) -> float:
    """Highest voltage (pu) at which fault mode is at rest: |V - Z I(V)| = E, I = (P* - j Q*)/V; NaN when nowhere."""
    Z, V = impedance(scr, xr), np.linspace(1e-3, THRESHOLD, 8000)
    orders = [closed_form(float(v), 0.0) for v in V]
    off = np.array([abs(v - Z * complex(x.p, -x.q) / v) - E for v, x in zip(V, orders, strict=True)])
    crossings = np.flatnonzero(off[1:] * off[:-1] <= 0)
    return float(V[crossings[-1]]) if len(crossings) else math.nan


def weakest_for_support(E: float, xr: float) -> float:
    """Lowest SCR at which a source E can keep an inverter in step that feeds 1 pu of reactive current alone.

    That current loses R in the grid's resistance, which the source has to give: R <= E, SCR = 1/(E sqrt(1 + (X/R)^2)).
    """
    return 1 / (E * math.hypot(1, xr))


class Case(NamedTuple):
    """A run on a weak grid; no relay acts."""

    sag: Sag
    scr: float
    xr: float
    settings: tuple[str, ...] = ()  # as the command line takes them
    scr_before: float | None = None  # the strength changes as the sag clears when given


def parameters(case: Case) -> Parameters:
    """Parameters of a case, its relays out of the way."""
    chosen = parameters_from(case.settings)
    return Parameters.model_validate({**chosen.model_dump(), "protection": NO_TRIPS})


def scenario(case: Case) -> Scenario:
    """Half a second of sag, and half a second after it where that is judged."""
    changes = case.scr_before is not None
    return Scenario(
        sag=case.sag,
        duration_s=0.5,
        scr=case.scr_before if changes else case.scr,
        xr=case.xr,
        after_s=0.5 if changes else 0.1,
        events=(GridStrength(t_s=0.5, scr=case.scr, xr=case.xr),) if changes else (),
    )


def judged_part(case: Case) -> Segment:
    """From 0.1 s after the start of the sag to its end, or from 0.2 s after its end where the strength changes then."""
    return _judged(case, record(scenario(case), parameters(case)))


def _judged(case: Case, samples: Segment) -> Segment:
    run = scenario(case)
    if case.scr_before is not None:
        return samples.slice(run.clear_s + 0.2, run.end_s)
    return samples.slice(run.start_s + 0.1, run.clear_s)


HELD, OVERCURRENT, TO_AND_FRO, NOT_FULL, LOST = range(5)
OUTCOMES = ("held", "current above 1.02 pu", "mode to and fro", "below 90 % of P before", "synchronism lost")
"""What becomes of a run, the last that applies."""


def is_lost(part: Segment) -> bool:
    """Whether the estimated frequency leaves its band."""
    f = part["frequency_estimate_hz"]
    return bool(f.min() < HELD_HZ[0] or f.max() > HELD_HZ[1])


def starts_at_full_power(samples: Segment) -> bool:
    """Whether the inverter feeds 90 % of nominal before the sag; below, the tool does not evaluate the test."""
    before = samples.slice(samples.t0_s + 0.08, samples.t0_s + 0.28)
    return bool(before["p_ref_w"].mean() > 0.9 * NOMINAL.apparent_power_va)


def outcome(case: Case) -> int:
    """Index in `OUTCOMES`."""
    samples = record(scenario(case), parameters(case))
    part = _judged(case, samples)
    if is_lost(part):
        return LOST
    if not starts_at_full_power(samples):
        return NOT_FULL
    if np.abs(np.diff(part["fault_signal"])).sum() >= 4:
        return TO_AND_FRO
    largest = np.abs(part.three_phase("i")).max() / NOMINAL.phase_current_peak_a
    return OVERCURRENT if largest > 1.02 else HELD


def boundary(holds: Callable[[float], bool], expected: float) -> float:
    """Lowest SCR that ``holds``, within 2 %, by halving from 0.7 to 1.4 times the expected one."""
    low, high = 0.7 * expected, 1.4 * expected
    while high > 1.02 * low:
        middle = math.sqrt(low * high)
        low, high = (low, middle) if holds(middle) else (middle, high)
    return math.sqrt(low * high)


def support_boundary(depth: float, xr: float) -> float:
    """Lowest SCR at which a sudden three-phase sag is ridden through in synchronism."""
    expected = weakest_for_support(1 - depth, xr)
    return boundary(lambda scr: not is_lost(judged_part(Case(Sag(depth=depth), scr, xr))), expected)


def slow_support_boundary(depth: float, xr: float) -> float:
    """The same where the voltage takes a second to fall, so that no transient hides the state of rest."""
    expected = weakest_for_support(1 - depth, xr)
    fall = VoltageProfile(points=((0.0, 1.0), (1.0, 1 - depth)))

    def holds(scr: float) -> bool:
        run = Scenario(sag=Sag(depth=0), duration_s=1.6, scr=scr, xr=xr, after_s=0.1, events=(fall,))
        return not is_lost(record(run).slice(run.start_s + 1.0, run.clear_s))

    return boundary(holds, expected)


def nominal_boundary(xr: float) -> float:
    """Lowest SCR at which the inverter runs at full power without a sag and flags none."""
    no_sag = Sag(depth=0)
    return boundary(lambda scr: judged_part(Case(no_sag, scr, xr))["fault_signal"].max() == 0, weakest_for_nominal(xr))


def frequency_range_hz(case: Case) -> tuple[float, float]:
    """Lowest and highest estimate in what is judged (Hz)."""
    f = judged_part(case)["frequency_estimate_hz"]
    return float(f.min()), float(f.max())
