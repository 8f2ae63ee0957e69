"""Faults from their start to their clearing: the power's return after them, and what is taken from the grid."""

from collections.abc import Iterator

import numpy as np

from recomputing.grid import Stretch
from recomputing.numbers import Missing, Off, Recomputed, Table, at_most, finite, nearest_part, number
from recomputing.ride_through import settles_after
from recomputing.view import View
from recomputing.windows import power_before, voltages_in

Zone = tuple[float, float]


def faults(view: View) -> list[Stretch]:
    """Runs of sags up to a trip; without any, what the test gives its times from."""
    parts = view.stretches("trip")
    found: list[Stretch] = []
    for k, part in enumerate(parts):
        if part["kind"] == "sag":
            if k > 0 and found and parts[k - 1]["kind"] == "sag":
                found[-1] = {**found[-1], "end_s": part["end_s"]}
            else:
                found.append(part)
    return found or [{**parts[0], "end_s": min(view.grid.clear_s, parts[-1]["end_s"])}]


def _cut_by_trip(view: View, fault: Stretch) -> bool:
    return view.opened_s is not None and view.opened_s <= fault["end_s"]


def _next_s(view: View, fault: Stretch) -> float | None:
    """The next fault, or a trip."""
    later = [p["begin_s"] for p in view.stretches("trip") if p["begin_s"] >= fault["end_s"] and p["kind"] != "normal"]
    ends = [*later[:1], *([] if view.opened_s is None else [view.opened_s])]
    return min(ends, default=None)


def judge_recovery(view: View, demand: Table, fault: Stretch) -> Recomputed:
    """The first share of P, then the final value, after the return of V+, by the depth of the fault."""
    kind = "active_power_recovery"
    if _cut_by_trip(view, fault):
        raise Off("tripped")
    if view.released_s is not None and view.released_s < fault["end_s"]:
        raise Off("released")
    parts = [part for part in view.grid.following(fault["end_s"]) if part["begin_s"] >= fault["begin_s"]]
    depth = min(_residual(view, part) for part in parts) + view.threshold("voltage_tolerance_pu")
    rows = [row for row in demand["rows"]["rows"] if row["residual_pu"][0] <= depth < row["residual_pu"][1]]
    if not rows:
        raise Off("no recovery is demanded")
    until_s = _next_s(view, fault)
    from_s = _return_s(view, fault, until_s, number(demand, "return_pu"))
    before = power_before(view)
    first_kw = number(demand, "first_fraction") * before
    band_kw = number(demand, "tolerance_fraction") * view.rated_kva
    p = view.mean_powers[0]
    first_s, final_s = rows[0]["first_s"], rows[0]["first_s"] + rows[0]["final_extra_s"]
    back_s = settles_after(view, p, from_s, until_s, lambda x: x >= first_kw)
    first = _time(view, kind, from_s, until_s, back_s, first_s)
    if first.status == "fail":
        return first
    back_s = settles_after(view, p, from_s, until_s, lambda x: abs(x - before) <= band_kw)
    return nearest_part([first, _time(view, kind, from_s, until_s, back_s, final_s)])


def _time(
    view: View, kind: str, from_s: float, until_s: float | None, took_s: float | None, limit: float
) -> Recomputed:
    seen_s = (view.last_s if until_s is None else until_s) - from_s
    if took_s is None and seen_s <= limit:
        raise Off("cut short") if until_s is not None else Missing("the record ends before")
    took_s = seen_s if took_s is None else took_s
    return at_most(kind, took_s, limit, from_s + took_s, "s")


def _residual(view: View, part: Stretch) -> float:
    """Mean V+ of the window of a level, or without one its lowest one-cycle V+."""
    if view.during(part["begin_s"], part["end_s"]) is not None and not part["ramps"]:
        return voltages_in(view, view.settled(part))[0]
    return float(finite(view.v_plus[view.between(part["begin_s"], part["end_s"])], "V+").min())


def _return_s(view: View, fault: Stretch, until_s: float | None, level: float) -> float:
    here = view.between(fault["end_s"], view.last_s)
    if until_s is not None:
        here &= view.t_s < until_s - 2e-9
    back = np.flatnonzero(finite(view.v_plus[here], "V+") >= level)
    if not len(back):
        raise Off("V+ does not return before") if until_s is not None else Missing("V+ does not return")
    return float(view.t_s[here][back[0]])


def judge_consumption(view: View, demand: Table, fault: Stretch) -> Recomputed:
    """What is taken in zones A, B and C; the limit nearest to failing."""
    window = view.during(fault["begin_s"], fault["end_s"])
    here = view.between(*(window or (fault["begin_s"], fault["end_s"])))
    negative = finite(view.v_minus[here], "V-")
    size = negative.max() if window is None else negative.mean()
    zones = demand["balanced"] if size < number(demand, "unbalanced_from_pu") else demand.get("unbalanced")
    if zones is None:
        raise Off("nothing is limited in an unbalanced fault")
    return nearest_part(list(_parts(view, zones, fault)))


def _parts(view: View, zones: Table, fault: Stretch) -> Iterator[Recomputed]:
    transient_s, begin_s, end_s = number(zones, "transient_s"), fault["begin_s"], fault["end_s"]
    middle_s = min(begin_s + transient_s, end_s)
    last_s = end_s if _cut_by_trip(view, fault) else end_s + transient_s
    next_s = None if _cut_by_trip(view, fault) else _next_s(view, fault)
    c = (end_s, last_s if next_s is None else min(last_s, next_s))
    a, b = (begin_s, middle_s), (middle_s, end_s)
    for zone, key, which, energy in (
        (a, "reactive_power_a", 1, False),
        (a, "reactive_energy_a_s", 1, True),
        (b, "active_power_b", 0, False),
        (b, "reactive_power_b", 1, False),
        (b, "active_energy_b_s", 0, True),
        (b, "reactive_energy_b_s", 1, True),
        (c, "reactive_energy_c_s", 1, True),
    ):
        limit = number(zones, key)
        if limit is not None and zone[1] > zone[0]:
            _recorded(view, zone)
            unit = ("kW", "kvar")[which]
            if energy:
                yield _energy(view, zone, which, limit * view.rated_kva, f"{unit} s")
            else:
                yield from _largest(view, zone, -view.mean_powers[which], limit * view.rated_kva, unit)
    limit = number(zones, "reactive_current_c_pu")
    if limit is not None and c[1] > c[0]:
        _recorded(view, c)
        yield from _largest(view, c, -view.sequence_current(0)[1], limit, "pu")


def _recorded(view: View, zone: Zone) -> None:
    if view.end_s < zone[1]:
        raise Missing("the record ends in a zone")


def _largest(view: View, zone: Zone, taken: np.ndarray, limit: float, unit: str) -> Iterator[Recomputed]:
    here = view.between(zone[0] + view.cycle_s, zone[1])
    if here.any():
        values = finite(taken[here], "what is taken")
        k = int(values.argmax())
        yield at_most("consumption", max(float(values[k]), 0.0), limit, float(view.t_s[here][k]), unit)


def _energy(view: View, zone: Zone, which: int, limit: float, unit: str) -> Recomputed:
    """Sum over the cycles of a zone of what each takes; the last is cut where the zone ends."""
    total, most, at_s, begin_s = 0.0, -1.0, zone[1], zone[0]
    cycles = int(np.ceil((zone[1] - zone[0] - 1e-9) / view.cycle_s))
    for k in range(cycles):
        begin_s = zone[0] + k * view.cycle_s
        end_s = zone[1] if k == cycles - 1 else begin_s + view.cycle_s
        inner = view.t_s[(view.t_s > begin_s) & (view.t_s < end_s)]
        at = np.concatenate([[begin_s], inner, [end_s]])
        y = finite(np.interp(at, view.t_s, view.powers[which]), "the power")
        taken = max(-float(0.5 * ((y[1:] + y[:-1]) * np.diff(at)).sum()), 0.0)
        total += taken
        if taken > most:
            most, at_s = taken, end_s
    return at_most("consumption", total, limit, at_s, unit)
