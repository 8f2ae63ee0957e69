"""Active power: in a sag, its swings and ripple, and at the end of the record."""

import numpy as np

from recomputing.grid import Stretch
from recomputing.jumps import ends_elsewhere
from recomputing.numbers import Missing, Off, Recomputed, Table, at_least, at_most, finite, nearest_part, number
from recomputing.support import demanded_q
from recomputing.view import View
from recomputing.windows import mean_in, powers_in, tones_in, voltages_in


def judge_active_power(view: View, demand: Table, part: Stretch) -> Recomputed:
    """One-cycle P of a settled sag against what eq (10) leaves, P before, and what the array gives."""
    before = view.grid.stretch_at(part["begin_s"] - 1e-6)
    off = np.abs(np.subtract(part["first"][:2], view.grid.level(float(view.t_s[0]))[:2]))
    shallow = off.max() > view.threshold("voltage_tolerance_pu") and before["kind"] == "normal"
    if (part["kind"] == "normal" and not shallow) or part["ramps"]:
        raise Off("normal, or something moves")
    here = view.up_to(part["begin_s"] + number(demand, "settling_s"), part["end_s"])
    if not here.any():
        raise Off("too short")
    p, v_plus, v_minus = (finite(x[here], "P or V") for x in (view.mean_powers[0], view.v_plus, view.v_minus))
    support, around = view.demand("reactive_support"), number(demand, "voltage_pu")
    room = np.maximum(v_plus - v_minus, 0)
    if support is not None:
        least = np.full(len(p), np.inf)
        for k in range(11):
            off = -around + 0.2 * around * k
            u, v = v_plus + off, v_minus + around - abs(off)
            s, q = np.maximum(u - v, 0), demanded_q(support, u, v)
            least = np.minimum(least, np.sqrt(np.maximum(s * s - q * q, 0)))
        room = np.where(v_plus >= number(support, "no_support_from_pu"), room, least)
    available, light = view.result["available_power_kw"], view.grid.irradiance
    if light is not None and part.get("irradiance_w_m2") is not None and light[0] > 0:
        available *= part["irradiance_w_m2"] / light[0]
    due = np.minimum(room * view.rated_kva, min(powers_in(view, view.before)[0], available))
    k = int((p - due).argmin())
    tolerance = number(demand, "tolerance_fraction") * view.rated_kva
    at_s = float(view.t_s[here][k])
    return at_least("active_power_support", float(p[k]), float(due[k]), at_s, "kW", tolerance)


def judge_oscillation(view: View, demand: Table, part: Stretch) -> Recomputed:
    """Peak to peak of the half-cycle means of P or Q about a straight line, at most what they go up and down by."""
    if part["ramps"]:
        raise Off("something moves")
    of_array = part["begin_s"] in view.grid.steps_of("irradiance")
    begin_s = part["begin_s"] + number(demand, "array_settling_s" if of_array else "settling_s")
    if (part["end_s"] - begin_s) * view.hz < number(demand, "least_cycles") - 1e-3:
        raise Off("too short")
    here = view.up_to(begin_s, part["end_s"])
    t_s = view.t_s[here] - begin_s
    found = []
    for x, unit in zip(view.half_cycle_powers, ("kW", "kvar"), strict=True):
        y = finite(x[here], "the power")
        rest = y - np.polyval(np.polyfit(t_s, y, 1), t_s)
        size = min(float(np.ptp(rest)), _to_and_fro(y))
        limit = number(demand, "limit_fraction") * view.rated_kva
        found.append(at_most("oscillation", size, limit, float(t_s[np.abs(rest).argmax()] + begin_s), unit))
    return found[0] if found[0].measured >= found[1].measured else found[1]


def _to_and_fro(y: np.ndarray) -> float:
    """The smaller of the largest rise and the largest fall from a sample to a later one."""
    low = high = y[0]
    rise = fall = 0.0
    for value in y.tolist():
        low, high = min(low, value), max(high, value)
        rise, fall = max(rise, value - low), max(fall, high - value)
    return float(min(rise, fall))


def departed(view: View) -> list[Stretch]:
    """The stretches at another voltage than before; of a test that leaves the voltage alone, all."""
    parts = view.disturbed("trip")
    if not view.grid.steps_of("voltage"):
        return parts
    first = view.grid.level(float(view.t_s[0]))
    return [part for part in parts if part["kind"] != "normal" or part["ramps"] or part["first"] != first]


def judge_constant_power(view: View, demand: Table, part: Stretch) -> Recomputed:
    """Amplitude of P at 2f."""
    window = view.settled(part)
    size = float(abs(tones_in(view, view.powers[0], window, 2, "P")[0]))
    return at_most("constant_power", size, number(demand, "limit_fraction") * view.rated_kva, window[0], "kW")


def judge_dc_ripple(view: View, demand: Table, part: Stretch) -> Recomputed:
    """Amplitude of v_DC at 2f, a straight line taken away, in percent of the mean."""
    window = view.settled(part)
    if "v_dc_v" not in view.of:
        raise Missing("the record has no DC voltage")
    level = mean_in(view, view.of["v_dc_v"], window, "v_DC")
    size = float(abs(tones_in(view, view.of["v_dc_v"], window, 2, "v_DC", line=True)[0]))
    if level <= 0:
        raise Missing("there is no DC voltage")
    return at_most("dc_ripple", 100 * size / level, number(demand, "limit_percent"), window[0], "%")


def judge_return(view: View, demand: Table) -> Recomputed:
    """P and Q of the last window against those before."""
    grid = view.grid
    if grid.irradiance is not None and not np.isclose(*grid.irradiance, rtol=1e-9):
        raise Off("another irradiance")
    end_s = view.last_s if grid.told.get("record_end_s") is None else grid.told["record_end_s"]
    if not grid.is_normal(grid.level(end_s)):
        raise Off("the voltage does not come back")
    if ends_elsewhere(view):
        raise Off("another frequency")
    if view.after is None:
        raise Missing("there is no window at the end")
    (p0, q0), (p1, q1) = powers_in(view, view.before), powers_in(view, view.after)
    limits = [
        (abs(p1 - p0), number(demand, "active_fraction"), 1.0),
        (abs(q1 - q0), number(demand, "reactive_fraction"), 1.0),
        (abs(q1 - q0), number(demand, "reactive_pu"), voltages_in(view, view.after)[0]),
    ]
    parts = [
        at_most("return_to_prefault", off / view.rated_kva, limit * times, view.after[0], "pu")
        for off, limit, times in limits
        if limit is not None
    ]
    return nearest_part(parts, relative=False)
