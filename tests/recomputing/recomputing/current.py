"""The current: its limits, and the cases in which it shows nothing."""

from collections.abc import Iterator

import numpy as np

from recomputing.numbers import Off, Recomputed, Table, at_least, at_most, finite, nearest_part, number
from recomputing.view import View
from recomputing.windows import Window, average, voltages_in

UPSETTING = ("voltage", "angle", "frequency", "strength", "recording")


def judge_limit(view: View, demand: Table) -> Recomputed:
    """The peak up to a trip, the fundamental after each step: settled, and on its way."""
    return nearest_part(list(_stages(view, demand)), relative=False)


def _stages(view: View, demand: Table) -> Iterator[Recomputed]:
    end_s = view.last_s if view.opened_s is None else view.opened_s
    yield _largest(view, np.abs(view.current_pu), (float(view.t_s[0]), end_s), number(demand, "peak_pu"))
    grid = view.grid
    begins = sorted({grid.start_s, *grid.steps_of(*UPSETTING)})
    begins = [t for t in begins if view.t_s[0] <= t < end_s]
    settled_pu = number(demand, "limit_pu") + number(demand, "tolerance_pu")
    for begin_s, until_s in zip(begins, [*begins[1:], end_s], strict=True):
        over_s = surely_over(view, until_s)
        settled_s = begin_s + number(demand, "settling_s")
        spans = [((settled_s, over_s), settled_pu)]
        if number(demand, "stage_pu") is not None:
            from_s = begin_s + number(demand, "stage_from_cycles") * view.cycle_s
            spans.append(((from_s, min(settled_s, over_s)), number(demand, "stage_pu")))
        for span, limit in spans:
            if view.between(*span).any():
                yield _largest(view, view.current_phase_pu, span, limit)


def surely_over(view: View, end_s: float) -> float:
    """A step that was found in a record is seen a cycle late."""
    found = view.grid.found and any(step["at_s"] == end_s for step in view.grid.steps)
    return end_s - view.cycle_s if found else end_s


def _largest(view: View, phases: np.ndarray, span: Window, limit: float) -> Recomputed:
    here = np.flatnonzero(view.between(*span))
    highest, at = -1.0, 0
    for phase in finite(phases[:, here], "the current"):
        k = int(phase.argmax())
        if phase[k] > highest:
            highest, at = float(phase[k]), int(here[k])
    return at_most("current_limit", highest, limit, float(view.t_s[at]), "pu")


def least_of_largest(view: View, window: Window) -> tuple[float, float]:
    """The least that the phase with the most carries in a window (pu), and when."""
    here = view.between(*window)
    largest = finite(view.current_phase_pu[:, here], "the current").max(axis=0)
    k = int(largest.argmin())
    return float(largest[k]), float(view.t_s[here][k])


def is_blocked(view: View, window: Window) -> bool:
    """Whether no phase carries current for a cycle somewhere in a window."""
    return least_of_largest(view, window)[0] < view.blocked_pu


def no_load_in(view: View, window: Window) -> tuple[float, float]:
    """Mean V+ and V- without the inverter's current."""
    positive, negative = (average(view, view.amplitude_pu(view.source, k), window, "the voltage") for k in (0, 1))
    return positive, negative


def let_off_if_blocked(view: View, window: Window, below_pu: float) -> None:
    """Blocking is allowed below a V+."""
    if is_blocked(view, window) and voltages_in(view, window)[0] < below_pu:
        raise Off("blocking is allowed")


def destroyed_voltage(view: View, kind: str, window: Window) -> Recomputed | None:
    """A failure where the terminals have no V+ although the grid has."""
    least, floor = view.threshold("least_sequence_pu"), view.threshold("voltage_floor_pu")
    here = view.between(*window)
    series = finite(view.v_plus[here], "V+")
    mean, k = voltages_in(view, window)[0], int(series.argmin())
    if mean >= least and series[k] >= floor:
        return None
    if no_load_in(view, window)[0] < least:
        raise Off("the grid has no positive sequence")
    measured, needed = (mean, least) if mean < least else (float(series[k]), floor)
    return at_least(kind, measured, needed, float(view.t_s[here][k]), "pu")._replace(status="fail")


def blocked_where_due(view: View, kind: str, window: Window) -> Recomputed:
    """A failure of a blocked bridge."""
    largest, at_s = least_of_largest(view, window)
    return at_least(kind, largest, view.blocked_pu, at_s, "pu")._replace(status="fail")
