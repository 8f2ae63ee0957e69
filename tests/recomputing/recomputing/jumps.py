"""Staying connected through jumps of the angle, and the power's return."""

import numpy as np

from recomputing.cycles import sequences
from recomputing.limits import Demand
from recomputing.numbers import Off, Recomputed, Table, number
from recomputing.ride_through import recovery, stayed, throughout
from recomputing.view import View
from recomputing.windows import own_frequency

KIND = "phase_jump_ride_through"


def judge(view: View, demand: Table) -> Recomputed:
    """A trip after a jump that is within the limits fails; else the return of P."""
    at = view.grid.steps_of("angle")
    if not at:
        raise Off("no angle jumps")
    accuracy = view.threshold("angle_accuracy_deg")
    single = number(demand, "single_phase_deg")
    for t in at:
        positive, phase = jump_at(view, t)
        if abs(positive) > number(demand, "all_phases_deg") + accuracy:
            raise Off("beyond the limit")
        if single is not None and abs(phase) > single + accuracy:
            raise Off("beyond the limit of one phase")
    if view.opened_s is not None:
        return _trip(view, at, view.opened_s)
    fraction, time_s = number(demand, "recovery_fraction"), number(demand, "recovery_time_s")
    found = recovery(view, KIND, at[-1], None, fraction, time_s)
    if found.status == "fail" and ends_elsewhere(view):
        raise Off("the frequency ends elsewhere")
    return found


def _trip(view: View, at: list[float], stop_s: float) -> Recomputed:
    grid = view.grid
    if stop_s < at[0]:
        raise Off("tripped before the first jump")
    if not grid.is_normal(grid.level(stop_s)):
        raise Off("the voltage was not normal")
    jump_s = max(t for t in at if t <= stop_s)
    due = Demand(jump_s, max(grid.end_s - jump_s, 0.0))
    if view.expect == "ride_through" and stop_s < grid.end_s:
        return stayed(due, stop_s, False, KIND)
    return throughout(due, stop_s, KIND)


def ends_elsewhere(view: View) -> bool:
    """Whether the frequency at the end is not that of the beginning."""
    if view.after is None:
        return False
    first, last = own_frequency(view, view.before), own_frequency(view, view.after)
    return first is not None and last is not None and abs(last - first) > view.threshold("frequency_deviation_hz")


def jump_at(view: View, at_s: float) -> tuple[float, float]:
    """Jump of the positive sequence and of the phase that jumps furthest (deg), measured or else asked for."""
    grid = view.grid
    told = next(jump for jump in grid.told["jumps"] if jump["at_s"] == at_s)
    settled_s = view.threshold("settled_cycles") * view.cycle_s
    before_s, _ = grid.beside(at_s - 1e-6, float(view.t_s[0]), view.last_s)
    _, after_s = grid.beside(at_s, float(view.t_s[0]), view.last_s)
    near = [part for part in grid.stretches if part["end_s"] > at_s - 2 * settled_s]
    near = [part for part in near if part["begin_s"] <= at_s + 2 * settled_s]
    steady = len({part["frequency_hz"] for part in near}) == 1 and not any(part["rocof_hz_s"] for part in near)
    alone = all(abs(t - at_s) > 2 * settled_s for t in grid.steps_of("angle") if t != at_s)
    if steady and alone and at_s - before_s > 2 * settled_s and after_s - at_s > settled_s:
        abc = view.voltages_pu(view.source)
        last = max(int(np.searchsorted(view.t_s, at_s - 2e-9)) - 1, 0)
        cycles = [last + round(k * settled_s / view.dt_s) for k in (-1, 0, 2)]
        first, now, then = (abc[:, min(k, len(view.t_s) - 1)] for k in cycles)
        drift = sequences(now)[0] / sequences(first)[0]
        then = then * np.conj(drift / abs(drift))
        positive = np.degrees(np.angle(sequences(then)[0] / sequences(now)[0]))
        each = np.degrees(np.angle(then / now))
        if np.isfinite(positive) and np.isfinite(each).all():
            return float(positive), float(each[np.abs(each).argmax()])
    return told["positive_deg"], told["phase_deg"]
