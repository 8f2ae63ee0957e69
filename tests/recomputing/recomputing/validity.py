"""When a test counts at all."""

import numpy as np

from recomputing.cycles import phasors, sequences
from recomputing.numbers import Missing, number
from recomputing.view import View
from recomputing.windows import average, powers_in


def does_not_count(view: View) -> bool:
    """Whether the record is too short, began otherwise, or the grid did something else."""
    reasons = (_too_short, _wrong_order, _open_before, _wrong_start, _wrong_sag)
    try:
        return any(reason(view) for reason in reasons)
    except Missing:
        return True


def _wrong_order(view: View) -> bool:
    """Phases in the order c, b, a, over five cycles before the start."""
    here = view.up_to(view.grid.start_s - 5 / view.nominal_hz, view.grid.start_s)
    if here.sum() * view.dt_s * view.nominal_hz < 2:
        return False
    found = np.abs(sequences(phasors(view.abc(view.source)[:, here], view.nominal_hz, view.dt_s)))
    found = found[:, np.isfinite(found).all(axis=0)]
    return bool(found.size) and bool(np.median(found[1]) > np.median(found[0]))


def _too_short(view: View) -> bool:
    grid = view.grid
    if view.last_s <= grid.clear_s:
        return True
    asked_s = grid.told.get("record_end_s")
    last_s = (view.last_s if asked_s is None else asked_s) - view.threshold("record_slack_s")
    return any(view.last_s < t < last_s for t in grid.steps_of("voltage"))


def _wrong_start(view: View) -> bool:
    meant, none = min(view.result["available_power_kw"], view.rated_kva), view.threshold("no_power_pu") * view.rated_kva
    share = number(view.profile["conditions"], "starting_power_fraction")
    allowed = none if meant <= none else share * meant
    return abs(powers_in(view, view.before)[0] - meant) > allowed


def _open_before(view: View) -> bool:
    before = view.t_s < view.grid.start_s - 2e-9
    if "trip_cause" in view.of and (view.of["trip_cause"][before] > 0).any():
        return True
    return view.opened_s is not None and view.opened_s < view.grid.start_s


def _wrong_sag(view: View) -> bool:
    grid = view.grid
    window = view.during(grid.start_s, grid.clear_s) or (grid.start_s + view.cycle_s, grid.clear_s)
    if view.source == "u" or not view.between(*window).any():
        return False
    asked = np.array([grid.level(float(t))[:2] for t in np.linspace(*window, 101)]).mean(axis=0)
    found = [average(view, view.amplitude_pu("u0", k), window, "u0") for k in (0, 1)]
    return bool((np.abs(found - asked) > number(view.profile["conditions"], "no_load_tolerance_pu")).any())
