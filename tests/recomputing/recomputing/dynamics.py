"""How soon the additional reactive current comes and settles after each step into a sag."""

import numpy as np

from recomputing.current import blocked_where_due, destroyed_voltage, is_blocked, let_off_if_blocked
from recomputing.grid import Stretch
from recomputing.numbers import Off, Recomputed, Table, at_most, finite, nearest_part, number
from recomputing.support import LIGHT, additional, asked, reactive_before
from recomputing.view import View
from recomputing.windows import Window, voltages_in

KIND = "support_dynamics"


def judge(view: View, demand: Table, part: Stretch) -> Recomputed:
    """Activation, response and settling; the one nearest to its limit is told."""
    window = view.settled(part, LIGHT)
    if not view.is_event(voltages_in(view, window)[0]):
        raise Off("no event")
    support = view.demand("reactive_current")
    let_off_if_blocked(view, window, number(support, "blocking_allowed_below_pu", 0.0))
    if (gone := destroyed_voltage(view, KIND, window)) is not None:
        return gone
    if support is None and is_blocked(view, window):
        return blocked_where_due(view, KIND, window)
    begin_s = _event_s(view, part)
    x = view.reactive(0) - reactive_before(view, 0)
    before = x[view.between(part["begin_s"] - 0.002, part["begin_s"])][-1]
    here = view.between(begin_s, part["end_s"])
    return nearest_part(_times(view, demand, support, window, view.t_s[here], finite(x[here], "it"), float(before)))


def _event_s(view: View, part: Stretch) -> float:
    """The first V+ beyond the thresholds of detection; without those, the step."""
    if view.profile.get("detection") is None:
        return float(part["begin_s"])
    here = view.between(part["begin_s"], part["end_s"])
    beyond = np.flatnonzero(view.is_event(finite(view.v_plus[here], "V+")))
    if not len(beyond):
        raise Off("no event")
    return float(view.t_s[here][beyond[0]])


def _times(
    view: View, demand: Table, support: Table | None, window: Window, t_s: np.ndarray, x: np.ndarray, before: float
) -> list[Recomputed]:
    final = additional(view, window, 0)
    due = final if support is None else asked(view, support, window, 0)[1]
    sign = -1 if due < 0 else 1
    least = most = abs(due)
    if support is not None:
        least, most = (
            max(abs(due) - number(support, "tolerance_minus_pu"), 0.0),
            abs(due) + number(support, "tolerance_plus_pu"),
        )
    start = sign * before
    goal = min(max(start, least), most)
    change = goal - start
    if abs(change) < number(demand, "least_change_pu"):
        raise Off("the change is too small")
    x = sign * x
    moved = np.sign(change) * (x - start)
    activated_s = first_reached(t_s, moved, number(demand, "activation_pu"))
    responded_s = first_reached(t_s, moved, number(demand, "response_fraction") * abs(change))
    found = [
        _part(t_s[0], t_s[-1], activated_s, number(demand, "activation_s")),
        _part(t_s[0], t_s[-1], responded_s, number(demand, "response_s")),
    ]
    if activated_s is None:
        return found
    low = least * (1 - number(demand, "band_minus"))
    high = max(sign * final, least) * (1 + number(demand, "band_plus"))
    entered_s = last_entry(t_s, x, low, high)
    entered_s = None if entered_s is None else max(entered_s, activated_s)
    return [*found, _part(activated_s, t_s[-1], entered_s, number(demand, "settling_s"))]


def _part(begin_s: float, end_s: float, reached_s: float | None, limit: float) -> Recomputed:
    took_s = (end_s if reached_s is None else reached_s) - begin_s
    if reached_s is None and took_s <= limit:
        raise Off("the sag is over before")
    return at_most(KIND, float(took_s), limit, float(begin_s + took_s), "s")


def _cross(t: np.ndarray, y: np.ndarray, k: int, level: float) -> float:
    """Where a straight line to sample k reaches a level."""
    if k == 0:
        return float(t[0])
    return float(t[k - 1] + (t[k] - t[k - 1]) * (level - y[k - 1]) / (y[k] - y[k - 1]))


def first_reached(t: np.ndarray, y: np.ndarray, level: float) -> float | None:
    """First instant at which a series is at or above a level."""
    for k, value in enumerate(y.tolist()):
        if value >= level:
            return _cross(t, y, k, level)
    return None


def last_entry(t: np.ndarray, y: np.ndarray, low: float, high: float) -> float | None:
    """Instant from which a series stays between two levels."""
    k = len(y)
    while k > 0 and low <= y[k - 1] <= high:
        k -= 1
    if k == len(y):
        return None
    return float(t[0]) if k == 0 else _cross(t, y, k, low if y[k - 1] < low else high)
