"""Checks of frequency: bands and rates that are ridden through, and the power above a threshold."""

import numpy as np

from recomputing.limits import Demand, release_of, whole_test
from recomputing.numbers import Off, Recomputed, Table, at_most, finite, number
from recomputing.regions import in_spans, spans, time_spent
from recomputing.ride_through import stayed, throughout
from recomputing.view import View
from recomputing.windows import power_before

KIND = "frequency_ride_through"


def known_hz(view: View) -> np.ndarray:
    """The tracked frequency, where no step and no faint voltage spoils it."""
    spoiled = np.zeros(len(view.t_s), dtype=bool)
    settle_s = view.threshold("frequency_settled_cycles") * view.cycle_s
    slow_s = view.threshold("terminals_settled_cycles") * view.cycle_s
    for t in view.grid.steps_of("angle", "voltage"):
        spoiled |= view.between(t, t + settle_s)
    if view.source == "u0":
        with np.errstate(invalid="ignore"):
            bad, after_s = view.amplitude_pu("u0", 0) < view.threshold("least_source_pu"), settle_s
    else:
        normal = view.grid.told["normal"]
        for t in view.grid.steps_of("voltage"):
            spoiled |= view.between(t, t + slow_s)
        with np.errstate(invalid="ignore"):
            bad = (view.v_plus < normal["low_pu"]) | (view.v_plus > normal["high_pu"])
            bad |= view.v_minus > normal["negative_pu"]
        after_s = slow_s
    for begin_s, end_s in spans(view, bad, anchored=False):
        spoiled |= view.between(begin_s - view.cycle_s, end_s + after_s)
    return np.where(spoiled, np.nan, view.tracked_hz)


def held_hz(view: View) -> np.ndarray:
    """The same, its last value held."""
    found, last = np.empty(len(view.t_s)), np.nan
    for k, hz in enumerate(known_hz(view).tolist()):
        last = hz if np.isfinite(hz) else last
        found[k] = last
    return found


def judge(view: View, demand: Table) -> Recomputed:
    """A trip, or a bridge that blocks for good, by the time in the bands and the rate of change."""
    frequency, grid = held_hz(view), view.grid
    away = np.abs(frequency - view.nominal_hz)
    if not np.isfinite(away).any() or np.nanmax(away) <= view.threshold("frequency_deviation_hz"):
        raise Off("the frequency stays near nominal")
    always = whole_test(view)
    stop_s = _stop(view)
    if stop_s is None:
        return stayed(always, max(view.end_s, always.until_s), True, KIND)
    if not grid.is_normal(grid.level(stop_s)):
        raise Off("the voltage was not normal")
    if view.expect == "ride_through" and stop_s < grid.end_s:
        return stayed(always, stop_s, False, KIND)
    release = min(_releases(view, demand, frequency), key=lambda due: due.until_s, default=None)
    if release is None or stop_s < release.since_s - 2e-9:
        return throughout(always, stop_s, KIND)
    if release.stay_s <= 0:
        raise Off("nothing is demanded")
    return stayed(release, stop_s, stop_s >= release.until_s - 2e-9, KIND)


def _stop(view: View) -> float | None:
    if view.opened_s is not None:
        return view.opened_s
    carrying = np.flatnonzero((np.abs(finite(view.current_pu, "the current")) >= view.blocked_pu).any(axis=0))
    after = int(carrying[-1]) + 1 if len(carrying) else 0
    return float(view.t_s[after]) if 0 < after < len(view.t_s) else None


def _releases(view: View, demand: Table, frequency: np.ndarray) -> list[Demand]:
    rows = demand["bands"]["rows"]
    edges = [(1, rows[0]["frequency_hz"][0], 0.0), (-1, rows[-1]["frequency_hz"][1], 0.0)]
    for row in rows:
        if row.get("ride_s") is not None:
            low = row["frequency_hz"][1] <= view.nominal_hz
            edges.append(
                (1, row["frequency_hz"][1], row["ride_s"]) if low else (-1, row["frequency_hz"][0], row["ride_s"])
            )
    found = []
    for sign, edge, ride_s in edges:
        with np.errstate(invalid="ignore"):
            beyond = sign * (edge - frequency) > view.threshold("frequency_accuracy_hz")
        times = spans(view, beyond, anchored=False)
        free = np.flatnonzero(in_spans(view, times) & (time_spent(view, times, None) >= ride_s - 2e-9))
        if len(free):
            found.append(Demand(float(view.t_s[free[0]]) - ride_s, ride_s))
    window_s, limit = number(demand, "rocof_window_s"), number(demand, "rocof_hz_s")
    if window_s is not None:
        known = known_hz(view)
        ago = np.interp(view.t_s - window_s, view.t_s, known, left=np.nan)
        allowed = limit + 2 * view.threshold("frequency_accuracy_hz") / window_s
        with np.errstate(invalid="ignore"):
            fast = np.flatnonzero(np.abs(known - ago) / window_s > allowed)
        if len(fast):
            found.append(Demand(float(view.t_s[fast[0]]), 0.0))
    return found


def judge_overfrequency(view: View, demand: Table) -> Recomputed:
    """Distance of P from the droop while the frequency is above the threshold."""
    frequency = held_hz(view)
    end_s = np.inf if view.opened_s is None else view.opened_s
    judged = view.t_s < end_s - 2e-9
    with np.errstate(invalid="ignore"):
        above = (frequency > number(demand, "threshold_hz")) & judged
    active = np.zeros(len(view.t_s), dtype=bool)
    for begin_s, end in spans(view, above, anchored=False, gap_s=0.0):
        active |= (view.t_s > begin_s + number(demand, "activation_s") + 2e-9) & (view.t_s < end - 2e-9)
    active &= judged
    if not active.any():
        raise Off("the threshold is not passed for long enough")
    over = frequency[active] - number(demand, "threshold_hz")
    share = np.maximum(1 - over / (number(demand, "droop_fraction") * view.nominal_hz), 0.0)
    wanted = power_before(view) * share
    off = np.abs(finite(view.mean_powers[0][active], "P") - wanted)
    k = int(off.argmax())
    limit = number(demand, "tolerance_fraction") * view.rated_kva
    return at_most("overfrequency_power", float(off[k]), limit, float(view.t_s[active][k]), "kW")


__all__ = ["judge", "judge_overfrequency", "release_of"]
