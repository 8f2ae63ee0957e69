"""Support: reactive power by a curve, reactive current by K, the share of it, and how often it comes on."""

import numpy as np

from recomputing.current import (
    blocked_where_due,
    destroyed_voltage,
    is_blocked,
    let_off_if_blocked,
    surely_over,
)
from recomputing.grid import Stretch
from recomputing.numbers import Off, Recomputed, Table, at_least, finite, number
from recomputing.view import View
from recomputing.windows import Window, average, powers_in, voltages_in

LIGHT = ("irradiance",)
KINDS = ("reactive_current", "negative_sequence_current")


def curve_at(curve: Table, x: np.ndarray | float) -> np.ndarray:
    """Straight lines between the points of a curve, flat beyond them."""
    levels, values = zip(*curve["points"], strict=True)
    found: np.ndarray = np.interp(x, levels, values)
    return found


def demanded_q(demand: Table, v_plus: np.ndarray | float, v_minus: np.ndarray | float) -> np.ndarray:
    """Reactive power by the curve, at most (V+ - V-), in pu of S."""
    q = curve_at(demand["curve"], v_plus)
    return np.minimum(q, np.maximum(np.subtract(v_plus, v_minus), 0)) if number(demand, "clip_to_capability") else q


def judge_reactive_power(view: View, demand: Table, part: Stretch) -> Recomputed:
    """Mean Q of a settled stretch."""
    kind = "reactive_support"
    window = view.settled(part, LIGHT)
    if (gone := destroyed_voltage(view, kind, window)) is not None:
        return gone
    v_plus, v_minus = voltages_in(view, window)
    _, q = powers_in(view, window)
    tolerance = number(demand, "tolerance_pu") * v_plus * view.rated_kva
    if v_plus < number(demand, "no_support_from_pu"):
        limit = float(demanded_q(demand, v_plus, v_minus)) * view.rated_kva
        margin = q - (limit - tolerance)
    else:
        between = part["kind"] == "normal" and part["begin_s"] > view.grid.start_s
        if between and abs(powers_in(view, view.before)[1]) > tolerance:
            raise Off("between sags the set-point counts")
        limit, margin = tolerance, tolerance - abs(q)
    margin = round(margin, 6)
    return Recomputed(kind, "pass" if margin >= 0 else "fail", q, limit, margin, window[0], "kvar")


def judge_reactive_current(view: View, demand: Table, part: Stretch, index: int) -> Recomputed:
    """Mean additional reactive current of a sequence (0 positive, 1 negative) in a settled stretch."""
    kind, window = KINDS[index], view.settled(part, LIGHT)
    let_off_if_blocked(view, window, number(demand, "blocking_allowed_below_pu"))
    if index == 0:
        if (gone := destroyed_voltage(view, kind, window)) is not None:
            return gone
    elif voltages_in(view, window)[1] < view.threshold("least_sequence_pu"):
        raise Off("there is no negative sequence")
    delta, due = asked(view, demand, window, index)
    event = bool(view.is_event(voltages_in(view, window)[0]))
    less, more = number(demand, "tolerance_minus_pu"), number(demand, "tolerance_plus_pu")
    if delta < -view.threshold("voltage_tolerance_pu"):
        less, more = more, less
    low, high = (due - less, due + more) if event else (min(due, 0.0) - less, max(due, 0.0) + more)
    measured = additional(view, window, index)
    above, below = high - measured, measured - low
    margin, limit = (above, high) if above < below else (below, low)
    if margin >= 0 and event and due != 0 and is_blocked(view, window):
        return blocked_where_due(view, kind, window)
    return Recomputed(kind, "pass" if margin >= 0 else "fail", measured, limit, margin, window[0], "pu")


def series_of(view: View, index: int) -> np.ndarray:
    """Reactive current as it is averaged: of the negative sequence 0 where that has no voltage."""
    return view.sequence_current(0)[1] if index == 0 else view.reactive(1)


def reactive_before(view: View, index: int) -> float:
    """Mean reactive current before the disturbance, 0 without voltage of the sequence."""
    if voltages_in(view, view.before)[index] < view.threshold("least_sequence_pu"):
        return 0.0
    return average(view, series_of(view, index), view.before, "the reactive current")


def additional(view: View, window: Window, index: int) -> float:
    """Mean reactive current of a window, less that before."""
    return average(view, series_of(view, index), window, "the reactive current") - reactive_before(view, index)


def asked(view: View, demand: Table, window: Window, index: int) -> tuple[float, float]:
    """Change of the voltage, and the additional current due, clipped together with the other sequence's."""
    delta, due = _unclipped(view, demand, window, index)
    before = reactive_before(view, index)
    total = abs(before + due)
    other = view.demand(KINDS[1 - index])
    if other is not None:
        total += abs(reactive_before(view, 1 - index) + _unclipped(view, other, window, 1 - index)[1])
    most = number(demand, "limit_pu")
    return delta, due if total <= most else most / total * (before + due) - before


def _unclipped(view: View, demand: Table, window: Window, index: int) -> tuple[float, float]:
    reference = 1.0 - index
    if demand["reference"]["value"] == "prefault":
        reference = voltages_in(view, view.before)[index]
    delta = reference - voltages_in(view, window)[index]
    delta = delta if index == 0 else -delta
    k = view.result.get("k_factor") or number(demand, "k")
    band, mode = number(demand, "dead_band_pu"), demand["dead_band_mode"]["value"]
    beyond = max(abs(delta) - band, 0.0)
    if mode == "none":
        return delta, k * delta
    if mode == "shift":
        return delta, k * beyond * (1 if delta >= 0 else -1)
    return delta, k * delta if beyond > 0 else 0.0


def judge_share(view: View, demand: Table, part: Stretch) -> Recomputed:
    """Share of the reactive current at every instant from some time after the step on."""
    kind = "reactive_ratio"
    begin_s, end_s = part["begin_s"] + number(demand, "within_s"), surely_over(view, part["end_s"])
    here = np.flatnonzero(view.between(begin_s, end_s))
    if not len(here):
        raise Off("too short")
    finite(view.v_plus[here], "V+")
    here = here[view.is_event(view.v_plus[here])]
    if not len(here):
        raise Off("no event")
    active, reactive = (x[here] for x in view.sequence_current(0))
    wanted, total = curve_at(demand["curve"], view.v_plus[here]), np.hypot(active, reactive)
    before = view.between(*view.before)
    usual = finite(np.hypot(*(x[before] for x in view.sequence_current(0))), "the current").mean()
    least = np.minimum(number(demand, "least_current_pu"), np.maximum(wanted, usual))
    source, other = (view.amplitude_pu(view.source, k)[here] for k in (0, 1))
    gone = np.isnan(reactive) & (source >= view.threshold("least_sequence_pu")) & (wanted > 0)
    if gone.any():
        k = int(np.where(gone, view.v_plus[here], np.inf).argmin())
        measured = float(view.v_plus[here][k])
        return at_least(kind, measured, view.threshold("voltage_floor_pu"), float(view.t_s[here][k]), "pu")
    room = source - other >= view.threshold("least_difference_pu")
    with np.errstate(invalid="ignore"):
        missing = (total < least) & (wanted > 0) & room
        if missing.any():
            k = int(np.where(missing, total - least, np.inf).argmin())
            return at_least(kind, float(total[k]), float(least[k]), float(view.t_s[here][k]), "pu")
        has = total >= least
    if not has.any():
        raise Off("too little current, and no room")
    share = np.where(has, reactive / np.where(has, total, 1.0), np.inf)
    k = int((share - wanted).argmin())
    limit = float(wanted[k]) - number(demand, "tolerance")
    return at_least(kind, float(share[k]), limit, float(view.t_s[here][k]), "")


def judge_toggling(view: View, demand: Table, part: Stretch) -> Recomputed:
    """How often the reactive current rises above one level after having been below another."""
    here = view.up_to(part["begin_s"] + number(demand, "settling_s"), part["end_s"])
    if not here.any():
        raise Off("nothing settled follows")
    current = np.abs(finite(view.reactive(0)[here], "the reactive current"))
    on, off, count, was_off, at = number(demand, "on_pu"), number(demand, "off_pu"), 0, False, []
    for value, t in zip(current.tolist(), view.t_s[here].tolist(), strict=True):
        if value > on and was_off:
            count, was_off = count + 1, False
            at.append(t)
        elif value < off:
            was_off = True
    most = number(demand, "most_activations")
    status = "pass" if count <= most else "fail"
    at_s = float(view.t_s[here][0]) if count <= most else at[int(most)]
    return Recomputed("toggling", status, float(count), most, most - count, at_s, "activations")
