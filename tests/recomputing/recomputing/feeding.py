"""What is asked for besides staying connected: feeding, the least current, ceasing and tripping."""

from collections.abc import Iterator

import numpy as np

from recomputing.numbers import Recomputed, Table, at_least, at_most, finite, number
from recomputing.regions import Span, Visit, in_spans, spans, visits
from recomputing.view import View
from recomputing.windows import average

KIND = "ride_through"


def besides(view: View, demand: Table) -> Iterator[Recomputed]:
    """All of it, as long as connection is demanded."""
    until_s = view.until("release")
    table, terminals, no_load = demand.get("regions"), [], []
    tolerance = number(demand, "envelope_tolerance_pu")
    if table is not None:
        terminals = visits(view, table, tolerance, "u")
        no_load = visits(view, table, tolerance, view.source)
        yield from _responses(view, terminals, no_load)
        yield from _least_current(view, demand, table, terminals, no_load, until_s)
    yield from _without_current(view, demand, [*terminals, *no_load], until_s)
    by_s = view.result.get("by_s")
    if by_s is not None:
        took_s = (view.end_s if view.opened_s is None else view.opened_s) - view.grid.start_s
        yield at_most(KIND, took_s, by_s, view.grid.start_s + by_s, "s")


def _carries(view: View) -> np.ndarray:
    """Whether any phase carries current at each sample."""
    return (np.abs(view.current_pu) >= view.blocked_pu).any(axis=0)


def _without_current(view: View, demand: Table, found: list[Visit], until_s: float) -> Iterator[Recomputed]:
    here = view.between(view.grid.start_s, until_s)
    finite(view.current_pu[:, here], "the current")
    room = view.amplitude_pu(view.source, 0) - view.amplitude_pu(view.source, 1)
    least = view.threshold("least_difference_pu") - view.threshold("voltage_tolerance_pu")
    due = (np.nan_to_num(room) >= least) & _is_due(view) & ~_may_pause(view, demand, found)
    at = np.flatnonzero(here)
    longest = (0.0, 0.0)
    gap = due & ~_carries(view)
    for begin, end in _runs_within(gap, at):
        begin_s, end_s = float(view.t_s[begin]), float(view.t_s[min(end, at[-1])])
        if end_s - begin_s > longest[1] - longest[0]:
            longest = (begin_s, end_s)
    lasted_s, allowed_s = longest[1] - longest[0], view.cycle_s
    if lasted_s > allowed_s:
        yield at_most(KIND, lasted_s, allowed_s, longest[0], "s")


def _runs_within(mask: np.ndarray, at: np.ndarray) -> Iterator[tuple[int, int]]:
    begun = None
    for k in at.tolist():
        if mask[k] and begun is None:
            begun = k
        if not mask[k] and begun is not None:
            yield begun, k
            begun = None
    if begun is not None:
        yield begun, int(at[-1]) + 1


def _is_due(view: View) -> np.ndarray:
    """Where a current is due: light, or support."""
    power = np.full(len(view.t_s), view.result["available_power_kw"] / view.rated_kva)
    light = view.grid.irradiance
    for part in view.grid.stretches:
        if light and light[0] > 0 and part.get("irradiance_w_m2") is not None and part["begin_s"] > 0:
            inside = view.between(part["begin_s"], part["end_s"])
            power[inside] *= 0.0 if "irradiance" in part["ramps"] else part["irradiance_w_m2"] / light[0]
    due = power >= view.blocked_pu
    supports = any(view.demand(kind) for kind in ("reactive_support", "reactive_current", "reactive_ratio"))
    return due | view.is_event(view.v_plus) if supports and view.profile.get("detection") else due


def _may_pause(view: View, demand: Table, found: list[Visit]) -> np.ndarray:
    recovery_s = number(demand, "recovery_time_s", 0.0)
    free = np.zeros(len(view.t_s), dtype=bool)
    for visit in found:
        if visit.region["mode"] != "mandatory":
            for begin_s, end_s in visit.within:
                free |= view.between(begin_s, end_s + recovery_s)
    support = view.demand("reactive_current")
    if support is not None:
        free |= np.nan_to_num(view.v_plus) < number(support, "blocking_allowed_below_pu")
    return free


def _least_current(
    view: View, demand: Table, table: Table, terminals: list[Visit], no_load: list[Visit], until_s: float
) -> Iterator[Recomputed]:
    share = number(table, "least_current_fraction")
    if share is None:
        return
    phases = view.current_phase_pu
    now = np.sqrt((phases**2).mean(axis=0)) if table["least_current_of"] == "apparent" else phases.max(axis=0)
    before = average(view, now, view.before, "the current")
    asked = view.between(view.grid.start_s, until_s) & _is_due(view)
    for found in (terminals, no_load):
        inside = np.zeros(len(view.t_s), dtype=bool)
        for visit in found:
            if visit.region["mode"] == "mandatory":
                inside |= in_spans(view, visit.within)
        asked &= inside
    settling_s = max(view.threshold("settled_cycles") * view.cycle_s, number(table, "least_current_settling_s", 0.0))
    for step in view.grid.steps:
        asked &= ~view.between(step["at_s"], step["at_s"] + settling_s)
    asked &= ~_may_pause(view, demand, [*terminals, *no_load])
    if not asked.any() or before < view.blocked_pu:
        return
    values = finite(now[asked], "the current")
    k = int(values.argmin())
    yield at_least(KIND, float(values[k]), share * before, float(view.t_s[asked][k]), "pu")


def _responses(view: View, terminals: list[Visit], no_load: list[Visit]) -> Iterator[Recomputed]:
    for visit in terminals:
        for stretch in visit.within:
            took = _response(view, visit, stretch)
            if took is None or (took[0] > took[1] and _other_answer(view, visit, stretch, no_load)):
                continue
            yield at_most(KIND, took[0], took[1], min(stretch[0] + max(took), stretch[1]), "s")


def _response(view: View, visit: Visit, stretch: Span) -> tuple[float, float] | None:
    """Time that ceasing or tripping took, and the time for it."""
    within_s, lasted_s = visit.region.get("respond_s"), stretch[1] - stretch[0]
    if within_s is None or lasted_s <= within_s:
        return None
    if visit.region["mode"] == "must_trip":
        opened_s = view.opened_s
        return lasted_s if opened_s is None else min(max(opened_s - stretch[0], 0.0), lasted_s), within_s
    here = np.flatnonzero(view.up_to(*stretch))
    finite(view.current_pu[:, here], "the current")
    carrying = here[_carries(view)[here]]
    if not len(carrying):
        return 0.0, within_s
    if carrying[-1] == here[-1]:
        return lasted_s, within_s
    return float(view.t_s[carrying[-1] + 1]) - stretch[0], within_s


def _other_answer(view: View, visit: Visit, stretch: Span, no_load: list[Visit]) -> bool:
    """Whether the no-load voltage lies in another region here, whose answer was given."""
    same = next(other for other in no_load if other.region == visit.region)
    overlap_s = sum(max(min(stretch[1], b) - max(stretch[0], a), 0.0) for a, b in same.within)
    if overlap_s >= (visit.region.get("respond_s") or 0.0):
        return False
    for other in no_load:
        for a, b in other.within:
            common = (max(a, stretch[0]), min(b, stretch[1]))
            if common[1] > common[0] and other.region != visit.region:
                took = _response(view, other, common)
                if took is not None and took[0] > took[1]:
                    return False
    return True


__all__ = ["besides", "spans"]
