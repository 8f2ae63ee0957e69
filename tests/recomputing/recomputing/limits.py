"""What envelopes and regions demand of the connection, by the voltage without the inverter's current."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from recomputing.cycles import sequences
from recomputing.numbers import Table, finite, number, runs_of
from recomputing.regions import region_limits
from recomputing.view import View


class Demand(NamedTuple):
    """Stay connected for a time from an instant on (s)."""

    since_s: float
    stay_s: float

    @property
    def until_s(self) -> float:
        """When it ends."""
        return self.since_s + self.stay_s


class Limit(NamedTuple):
    """What first lets the inverter go, and what would be demanded of the voltage at an instant."""

    release: Demand | None
    at: Callable[[float], Demand | None]


def quantity(view: View, name: str, kind: str) -> np.ndarray:
    """The voltage that a limit speaks of (pu)."""
    if name == "positive_sequence":
        return view.amplitude_pu(kind, 0)
    abc = view.voltages_pu(kind)
    if name.endswith("line_to_line"):
        abc = np.stack([abc[0] - abc[1], abc[1] - abc[2], abc[2] - abc[0]]) / np.sqrt(3)
    sizes = np.abs(abc)
    found: np.ndarray = {"mean": sizes.mean(0), "lowe": sizes.min(0), "high": sizes.max(0)}[name[:4]]
    return found


def points_of(envelope: Table) -> list[tuple[float, float]]:
    """Corners of an envelope (s, pu)."""
    points = envelope["points"]
    return [(p["t_s"], p["u_pu"]) if isinstance(p, dict) else (p[0], p[1]) for p in points]


def level_at(envelope: Table, t_s: np.ndarray) -> np.ndarray:
    """Level at times since the start."""
    times, levels = map(np.array, zip(*points_of(envelope), strict=True))
    if envelope["interpolation"] == "linear":
        found: np.ndarray = np.interp(t_s, times, levels)
        return found
    return levels[np.maximum((np.asarray(t_s)[..., None] >= times).sum(axis=-1) - 1, 0)]


def time_of(envelope: Table, level: float, sign: int) -> float | None:
    """The first instant at which the envelope passes a level; None: never."""
    points = points_of(envelope)
    for k, (t, u) in enumerate(points):
        if sign * u > sign * level:
            if k == 0 or envelope["interpolation"] == "step":
                return t
            t0, u0 = points[k - 1]
            return t0 + (t - t0) * (level - u0) / (u - u0)
    return None


def median_between(view: View, x: np.ndarray, at_s: float) -> float | None:
    """Median between the steps of the voltage next to an instant, the first cycle left out."""
    begin_s, end_s = view.grid.beside(at_s, float(view.t_s[0]), view.last_s)
    here = np.sort(x[view.between(begin_s + view.cycle_s, end_s)])
    return float(here[(len(here) - 1) // 2]) if len(here) else None


def is_two_phase(view: View) -> bool:
    """Whether the sag lies nearest to an isolated two-phase fault."""
    here = view.between(view.grid.start_s + view.cycle_s, view.grid.clear_s)
    if view.source == "u" or not here.any():
        positive, negative, zero = view.grid.level(view.grid.start_s)
    else:
        sizes = np.sort(np.abs(sequences(view.voltages_pu("u0")[:, here])), axis=1)
        positive, negative, zero = (float(x) for x in sizes[:, (sizes.shape[1] - 1) // 2])
    return abs(1 - positive - negative) < negative / 2 and zero < negative / 2


def envelope_limit(view: View, envelope: Table, sign: int, tolerance: float) -> Limit:
    """When an envelope (sign 1 of sags, -1 of swells) is left."""
    voltage = quantity(view, envelope["voltage_quantity"], view.source)
    finite(voltage[view.between(view.grid.start_s, view.last_s)], "the voltage")
    settling_s = view.threshold("settled_cycles") * view.cycle_s
    steps = view.grid.steps_of("voltage")
    starts = [view.grid.start_s]
    back = sign * points_of(envelope)[-1][1] - tolerance
    for step in steps:
        at = min(int(np.searchsorted(view.t_s, step - 2e-9)), len(view.t_s) - 1)
        if step > starts[0] and sign * voltage[at] >= back:
            starts.append(step)

    def demand_at(at_s: float) -> Demand | None:
        level = median_between(view, voltage, at_s)
        stay_s = None if level is None else time_of(envelope, level, sign)
        return None if stay_s is None else Demand(max((t for t in starts if t <= at_s), default=starts[0]), stay_s)

    for begin_s, end_s in zip(starts, [*starts[1:], view.last_s], strict=True):
        here = view.between(begin_s, end_s)
        t_s = view.t_s[here] - begin_s
        level = level_at(envelope, t_s)
        beyond = sign * (level - voltage[here])
        flat = np.full(len(t_s), True)
        if envelope["interpolation"] == "linear":
            flat = level == level_at(envelope, t_s + 1e-6)
        unsettled = np.zeros(len(t_s), dtype=bool)
        for step in steps:
            unsettled |= (view.t_s[here] >= step - 2e-9) & (view.t_s[here] <= step + settling_s + 2e-9)
        deep = np.flatnonzero((beyond > tolerance) & ~unsettled)
        if len(deep):
            k = int(deep[0])
            while k > 0 and beyond[k - 1] > (tolerance if flat[k - 1] else min(tolerance, 1e-6)):
                k -= 1
            left_s = _at_step(view, envelope, sign, tolerance, voltage, begin_s, float(t_s[k]))
            return Limit(Demand(begin_s, left_s), demand_at)
    return Limit(None, demand_at)


def _at_step(
    view: View, envelope: Table, sign: int, tolerance: float, voltage: np.ndarray, begin_s: float, left_s: float
) -> float:
    """Left at the step that leads beyond it: a one-cycle voltage shows that late."""
    settling_s = view.threshold("settled_cycles") * view.cycle_s
    at_s = begin_s + left_s
    near = [t for t in [begin_s, *view.grid.steps_of("voltage")] if at_s - settling_s <= t <= at_s + 2e-9]
    if not near or max(near) < begin_s:
        return left_s
    level = median_between(view, voltage, max(near))
    since = max(near) - begin_s
    led_beyond = level is not None and sign * (float(level_at(envelope, np.array(since))) - level) > tolerance
    return since if led_beyond else left_s


def limits_of(view: View) -> list[Limit]:
    """All limits of the voltage that a profile has."""
    demand = view.demand("ride_through")
    if demand is None:
        return []
    tolerance = number(demand, "envelope_tolerance_pu")
    low = demand.get("envelope")
    if demand.get("envelope_two_phase") is not None and is_two_phase(view):
        low = demand["envelope_two_phase"]
    found = []
    if low is not None:
        found.append(envelope_limit(view, low, 1, tolerance))
    if demand.get("envelope_over_voltage") is not None:
        found.append(envelope_limit(view, demand["envelope_over_voltage"], -1, tolerance))
    if demand.get("regions") is not None:
        found += [Limit(*pair) for pair in region_limits(view, demand["regions"], tolerance, Demand)]
    return found


def release_of(limits: list[Limit]) -> Demand | None:
    """The demand that ends first."""
    found = [limit.release for limit in limits if limit.release is not None]
    return min(found, key=lambda demand: demand.until_s, default=None)


def released_s(view: View) -> float | None:
    """When the inverter may let go; of a row that is ridden through, not before its end."""
    release = release_of(limits_of(view))
    if release is None:
        return None
    if view.expect != "ride_through":
        return release.until_s
    back = view.grid.is_normal(view.grid.level(view.grid.end_s))
    return None if back else max(release.until_s, view.grid.end_s)


def whole_test(view: View) -> Demand:
    """From the start of the disturbance to its end."""
    return Demand(view.grid.start_s, view.grid.end_s - view.grid.start_s)


def demand_at(limits: list[Limit], at_s: float) -> Demand | None:
    """The shortest time that the voltage at an instant would have had to be ridden through."""
    found = [demand for limit in limits if (demand := limit.at(at_s)) is not None]
    ahead = [demand for demand in found if at_s < demand.until_s < np.inf]
    return min(ahead, key=lambda demand: demand.until_s, default=None)


__all__ = ["Demand", "Limit", "limits_of", "runs_of"]
