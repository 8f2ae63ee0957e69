"""Staying connected through disturbances of the voltage, feeding all the while, and coming back."""

from itertools import pairwise

import numpy as np

from recomputing.feeding import besides
from recomputing.limits import Demand, demand_at, limits_of, release_of, whole_test
from recomputing.numbers import Missing, Off, Recomputed, Table, at_most, finite, number, worst_of
from recomputing.view import View

KIND = "ride_through"


def judge(view: View, demand: Table) -> Recomputed:
    """A failed part with the least margin; else the time with the least margin, else what there is."""
    limits = limits_of(view)
    others = list(besides(view, demand))
    try:
        found = [_connection(view, demand, limits), *others]
    except Off:
        if not others:
            raise
        found = others
    failed = [verdict for verdict in found if verdict.status == "fail"]
    if failed:
        return worst_of(failed)
    return min(found, key=lambda verdict: (verdict.unit != "s", verdict.margin or 0.0))


def stayed(demand: Demand, stopped_s: float, passed: bool, kind: str = KIND) -> Recomputed:
    """Time connected against the time demanded."""
    time_s = stopped_s - demand.since_s
    return Recomputed(kind, "pass" if passed else "fail", time_s, demand.stay_s, time_s - demand.stay_s, stopped_s, "s")


def throughout(demand: Demand, stopped_s: float, kind: str = KIND) -> Recomputed:
    """A failure where connection is demanded for ever: without limit and margin."""
    return Recomputed(kind, "fail", stopped_s - demand.since_s, None, None, stopped_s, "s")


def _connection(view: View, demand: Table, limits: list) -> Recomputed:
    if "connected" not in view.of:
        raise Missing("the record does not say whether the breaker is closed")
    if view.opened_s is not None:
        return _trip(view, demand, limits, view.opened_s)
    grid, release = view.grid, release_of(limits)
    if release is not None and release.until_s < grid.end_s and view.expect != "ride_through":
        if release.stay_s <= 0:
            raise Off("nothing is demanded")
        return stayed(release, min(grid.end_s, view.last_s), True)
    back = _recoveries(view, demand)
    if back is not None:
        return back
    whole = whole_test(view)
    return stayed(whole, max(view.end_s, whole.until_s), True)


def moved_at(view: View, at_s: float) -> str | None:
    """What of the source is not normal at an instant."""
    grid, part = view.grid, view.grid.stretch_at(at_s)
    if "recording" in part["ramps"]:
        k = min(int(np.searchsorted(view.t_s, at_s - 2e-9)), len(view.t_s) - 1)
        level = grid.level(at_s)._replace(
            positive=float(np.nan_to_num(view.amplitude_pu(view.source, 0)[k])),
            negative=float(np.nan_to_num(view.amplitude_pu(view.source, 1)[k])),
        )
    else:
        level = grid.level(at_s)
    if not grid.is_normal(level):
        return "high voltage" if level.positive > grid.told["normal"]["high_pu"] else "low voltage"
    if abs(source_hz(view, at_s) - view.nominal_hz) > view.threshold("frequency_deviation_hz"):
        return "frequency"
    steps, recent_s = grid.steps_of("voltage"), view.threshold("normal_jump_s")
    for jump in grid.told["jumps"]:
        size = max(abs(jump["positive_deg"]), abs(jump["phase_deg"]))
        fresh = at_s - recent_s <= jump["at_s"] <= at_s
        if fresh and jump["at_s"] not in steps and size > view.threshold("normal_jump_deg"):
            return "angle"
    return None


def source_hz(view: View, at_s: float) -> float:
    """Frequency that the source was asked for, or was last seen to have."""
    part = view.grid.stretch_at(at_s)
    if part.get("frequency_hz") is not None and "recording" not in part["ramps"] and not view.grid.found:
        return float(part["frequency_hz"] + part["rocof_hz_s"] * (at_s - part["begin_s"]))
    known = np.flatnonzero(np.isfinite(view.tracked_hz) & (view.t_s <= at_s))
    return float(view.tracked_hz[known[-1]]) if len(known) else view.nominal_hz


def _trip(view: View, demand: Table, limits: list, stop_s: float) -> Recomputed:
    grid, moved = view.grid, moved_at(view, stop_s)
    if view.expect == "ride_through" and stop_s < grid.end_s:
        return _broken(whole_test(view), stop_s)
    release = release_of(limits)
    released = release is not None and stop_s >= release.until_s - 2e-9
    if release is not None and released and view.expect != "ride_through" and (moved or stop_s < grid.end_s):
        if view.source == "u":
            raise Missing("no-load voltage missing")
        if release.stay_s <= 0:
            raise Off("nothing is demanded")
        return stayed(release, stop_s, True)
    if moved in ("low voltage", "high voltage") and not released:
        if moved == "high voltage" and "envelope_over_voltage" not in demand and "regions" not in demand:
            raise Missing("nothing is said of over-voltage")
        due = demand_at(limits, stop_s) or whole_test(view)
        due = due._replace(stay_s=min(due.stay_s, max(grid.end_s, stop_s) - due.since_s))
        return _broken(due, stop_s)
    own = {"frequency": "frequency_ride_through", "angle": "phase_jump_ride_through"}.get(moved or "")
    if own is not None:
        if view.demand(own) is not None:
            raise Off(f"{own} judges it")
        raise Missing("nothing is said of what moved")
    if stop_s < grid.end_s and grid.steps:
        return _broken(whole_test(view), stop_s)
    return throughout(whole_test(view), stop_s)


def _broken(due: Demand, stop_s: float) -> Recomputed:
    return throughout(due, stop_s) if stop_s >= due.until_s else stayed(due, stop_s, False)


def _recoveries(view: View, demand: Table) -> Recomputed | None:
    fraction, time_s = number(demand, "recovery_fraction"), number(demand, "recovery_time_s")
    grid = view.grid
    only_others = not grid.steps_of("voltage") and bool(grid.steps_of("frequency", "angle"))
    if fraction is None or time_s is None or only_others:
        return None
    parts = grid.of_voltage(view.last_s)
    returns: list[tuple[float, float | None]] = [
        (part["begin_s"], part["end_s"])
        for last, part in pairwise(parts)
        if part["kind"] == "normal" and last["kind"] != "normal" and part["end_s"] < grid.end_s + 1e-9
    ]
    found = []
    for from_s, until_s in [*returns, (grid.end_s, None)]:
        try:
            found.append(recovery(view, KIND, from_s, until_s, fraction, time_s))
        except Off:
            continue
    return worst_of(found) if found else None


def recovery(
    view: View, kind: str, from_s: float, until_s: float | None, fraction: float, allowed_s: float
) -> Recomputed:
    """Time until the one-cycle P stays at or above a share of the power before."""
    from recomputing.windows import power_before

    target = fraction * power_before(view)
    took_s = settles_after(view, view.mean_powers[0], from_s, until_s, lambda p: p >= target)
    seen_s = (view.last_s if until_s is None else until_s) - from_s
    if took_s is None and seen_s < allowed_s:
        if until_s is not None:
            raise Off("the next disturbance comes before")
        raise Missing("the record ends before")
    took_s = seen_s if took_s is None else took_s
    return at_most(kind, took_s, allowed_s, from_s + took_s, "s")


def settles_after(view: View, x: np.ndarray, from_s: float, until_s: float | None, inside) -> float | None:
    """Time from an instant until a series is inside for good; None where it ends outside."""
    here = view.between(from_s, view.last_s)
    if until_s is not None:
        here &= view.t_s < until_s - 2e-9
    values, t_s = finite(x[here], "a power"), view.t_s[here]
    if not len(t_s):
        raise Missing("the record ends before")
    k = len(values)
    while k > 0 and inside(values[k - 1]):
        k -= 1
    if k == len(values):
        return None
    return 0.0 if k == 0 else float(t_s[k] - from_s)
