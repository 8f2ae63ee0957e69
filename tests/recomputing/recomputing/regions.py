"""Regions of voltage: visits, times in them, and what they demand."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from recomputing.numbers import Table, finite, runs_of
from recomputing.view import View

Span = tuple[float, float]
STAY = ("continuous", "mandatory", "permissive", "momentary_cessation")


class Visit(NamedTuple):
    """A region in a record."""

    region: Table
    voltage: np.ndarray
    beyond: list[Span]  # in it or in a worse one
    within: list[Span]  # in it alone


def visits(view: View, table: Table, tolerance: float, kind: str) -> list[Visit]:
    """All regions but the continuous one, and what lies above the last."""
    from recomputing.limits import quantity

    rows = table["rows"]
    middle = next(k for k, row in enumerate(rows) if row["mode"] == "continuous")
    top = rows[-1]["voltage_pu"][1]
    above = {"voltage_pu": [top, max(2.0, 2 * top)], "mode": "may_trip"}
    found = []
    for name, side in (("low_quantity", rows[:middle][::-1]), ("high_quantity", [*rows[middle + 1 :], above])):
        voltage = quantity(view, table[name], kind)
        finite(voltage[view.between(view.grid.start_s, view.last_s)], "the voltage")
        with np.errstate(invalid="ignore"):
            if name == "low_quantity":
                masks = [voltage < row["voltage_pu"][1] - tolerance for row in side]
            else:
                masks = [voltage > row["voltage_pu"][0] + tolerance for row in side]
        for k, row in enumerate(side):
            worse = masks[k + 1] if k + 1 < len(masks) else np.zeros(len(voltage), dtype=bool)
            within = masks[k] & ~worse
            found.append(Visit(row, voltage, spans(view, masks[k], True), spans(view, within, True)))
    return found


def spans(view: View, mask: np.ndarray, anchored: bool, gap_s: float | None = None) -> list[Span]:
    """Runs of a mask as times: anchored at steps of the voltage, with gaps of a cycle closed."""
    lag_s = view.threshold("settled_cycles") * view.cycle_s
    gap_s = view.cycle_s if gap_s is None else gap_s
    steps = view.grid.steps_of("voltage") if anchored else []

    def at_step(t_s: float) -> float:
        return max((step for step in steps if t_s - lag_s <= step <= t_s + 2e-9), default=t_s)

    found: list[Span] = []
    for first, end in runs_of(mask):
        begin_s = at_step(float(view.t_s[first]))
        end_s = view.last_s if end == len(mask) else at_step(float(view.t_s[end]))
        if found and begin_s - found[-1][1] <= gap_s:
            found[-1] = (found[-1][0], max(end_s, found[-1][1]))
        elif end_s > begin_s:
            found.append((begin_s, end_s))
    return found


def in_spans(view: View, found: list[Span]) -> np.ndarray:
    """Mask of the samples in some spans, their ends left out."""
    inside = np.zeros(len(view.t_s), dtype=bool)
    for begin_s, end_s in found:
        inside |= view.up_to(begin_s, end_s)
    return inside


def time_spent(view: View, found: list[Span], window_s: float | None) -> np.ndarray:
    """Time in the present span, or in all of a sliding window if that is more; 0 outside."""
    present, total = np.zeros(len(view.t_s)), np.zeros(len(view.t_s))
    for begin_s, end_s in found:
        present = np.where(view.t_s >= begin_s - 2e-9, view.t_s - begin_s, present)
        if window_s is not None:
            low = np.maximum(view.t_s - window_s, begin_s)
            total += np.maximum(np.minimum(view.t_s, end_s) - low, 0.0)
    return np.where(in_spans(view, found), np.maximum(present, total), 0.0)


def stay_s(region: Table, voltage: Any) -> Any:
    """How long to stay connected at a voltage in a region."""
    voltage = np.asarray(voltage, dtype=float)
    if region["mode"] not in STAY:
        return np.zeros(voltage.shape)
    ride = region.get("ride_s")
    if isinstance(ride, dict):
        return ride["s"] + ride["slope_s_per_pu"] * (np.clip(voltage, *region["voltage_pu"]) - ride["at_pu"])
    return np.full(voltage.shape, np.inf if ride is None else ride)


def region_limits(view: View, table: Table, tolerance: float, demand: Callable[[float, float], Any]) -> list[Any]:
    """For each region what first lets the inverter go, and what it would demand at an instant."""
    from recomputing.limits import median_between

    found = []
    for visit in visits(view, table, tolerance, view.source):

        def at(at_s: float, visit: Visit = visit) -> Any:
            level = median_between(view, visit.voltage, at_s)
            begun = [begin for begin, end in visit.beyond if begin <= at_s < end]
            return demand(begun[0], float(stay_s(visit.region, level))) if begun and level is not None else None

        stays = stay_s(visit.region, visit.voltage)
        spent = time_spent(view, visit.beyond, table.get("cumulative_window_s"))
        with np.errstate(invalid="ignore"):
            free = np.flatnonzero(in_spans(view, visit.beyond) & (spent >= stays - 2e-9))
        release = None
        if len(free):
            release = demand(float(view.t_s[free[0]] - stays[free[0]]), float(stays[free[0]]))
        found.append((release, at))
    return found
