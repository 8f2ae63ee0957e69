"""Extremes, means and response times of each stretch between steps."""

from typing import Any

import numpy as np

from recomputing.current import surely_over
from recomputing.dynamics import first_reached, last_entry
from recomputing.frequencies import held_hz
from recomputing.numbers import Missing, Off, Table
from recomputing.view import View
from recomputing.windows import Window, mean_in

Cursors = dict[tuple[float, str], dict[str, float | None]]
FLOORS = {"pu": 1e-4, "kw": 0.05, "kvar": 0.05, "v": 0.05, "hz": 1e-3}
TIME_FLOOR_S, SHARE, PERCENT = 1e-4, 1e-3, 0.1


def recompute(result: Table, profile: Table, waveforms: dict[str, np.ndarray]) -> Cursors:
    """All cursors of a test, by the beginning of their stretch and their quantity; parameters as of `judge`."""
    view = View(result, profile, waveforms)
    series = _series(view)
    found: Cursors = {}
    try:
        before = view.before
    except Missing:
        before = None
    for name, x in series.items():
        if before is not None and (levels := _extremes(view, x, before)) is not None:
            found[(before[0], name)] = levels
    for part in view.grid.following(view.until("trip")):
        for name, x in series.items():
            end_s = surely_over(view, part["end_s"])
            settled = (part["begin_s"] + view.threshold("settled_cycles") * view.cycle_s, end_s)
            if (cursor := _extremes(view, x, settled)) is not None:
                found[(part["begin_s"], name)] = {**cursor, **_timed(view, x, part, end_s, _least(view, name))}
    return found


def _series(view: View) -> dict[str, np.ndarray]:
    """Those that the record has the channels of."""
    limited = {band["quantity"] for band in view.result["bands"]}
    wanted: dict[str, Any] = {
        "voltage_positive_pu": lambda: view.v_plus,
        "voltage_negative_pu": lambda: view.v_minus,
        "active_power_kw": lambda: view.mean_powers[0],
        "reactive_power_kvar": lambda: view.mean_powers[1],
        "current_pu": lambda: view.current_phase_pu.max(axis=0),
        "dc_voltage_v": lambda: view.of["v_dc_v"],
    }
    for index, name in enumerate(("reactive_current_pu", "reactive_current_negative_pu")):
        if name in limited:
            wanted[name] = lambda index=index: view.reactive(index)
    if view.grid.frequency_moves:
        wanted["frequency_hz"] = lambda: held_hz(view)
    found = {}
    for name, made in wanted.items():
        try:
            found[name] = made()
        except (Missing, KeyError):
            continue
    return found


def _least(view: View, name: str) -> float:
    """Least change that is timed."""
    least = view.threshold("response_least_pu")
    if name == "frequency_hz":
        return view.threshold("frequency_deviation_hz")
    if name == "dc_voltage_v":
        try:
            return least * mean_in(view, view.of["v_dc_v"], view.before, "v_DC")
        except Missing:
            return np.inf
    return least * view.rated_kva if name in ("active_power_kw", "reactive_power_kvar") else least


def _extremes(view: View, x: np.ndarray, span: Window) -> dict[str, float | None] | None:
    here = x[view.up_to(*span)]
    if not len(here) or not np.isfinite(here).all():
        return None
    return {"minimum": float(here.min()), "maximum": float(here.max()), "mean": float(here.mean())}


def _timed(view: View, x: np.ndarray, part: Table, end_s: float, least: float) -> dict[str, float | None]:
    """Levels and times of the change at the beginning of a stretch."""
    try:
        a, b = view.settled({**part, "end_s": end_s})
    except Off:
        return {}
    last = view.whole(max(a, b - view.rule("after_length_s")), b)
    before_s = surely_over(view, part["begin_s"])
    levels = _extremes(view, x, (before_s - view.cycle_s, before_s)), last and _extremes(view, x, last)
    if levels[0] is None or levels[1] is None:
        return {}
    initial, final = levels[0]["mean"], levels[1]["mean"]
    found: dict[str, float | None] = {"initial": initial, "final": final}
    here = view.up_to(part["begin_s"], end_s)
    if abs(final - initial) < least or not np.isfinite(x[here]).all():
        return found
    t, y = view.t_s[here], (x[here] - initial) / (final - initial)
    band = view.threshold("response_band")
    reaction, response = first_reached(t, y, 0.1), first_reached(t, y, 0.9)
    settled = last_entry(t, y, 1 - band, 1 + band)
    since = {"reaction_s": reaction, "response_s": response, "settling_s": settled}
    found |= {name: at_s - part["begin_s"] for name, at_s in since.items() if at_s is not None}
    if reaction is not None and response is not None:
        found["rise_s"] = response - reaction
    return {**found, "overshoot_percent": 100 * max(float(y.max()) - 1, 0.0)}


def differences(told: list[Table], found: Cursors) -> list[str]:
    """What of the cursors of one test is not what was recomputed; empty where all is."""
    seen = {(round(part["begin_s"], 6), one["quantity"]): one for part in told for one in part["cursors"]}
    redone = {(round(begin_s, 6), name): one for (begin_s, name), one in found.items()}
    if seen.keys() != redone.keys():
        return [f"cursors of {sorted(seen.keys() ^ redone.keys())} are told or recomputed alone"]
    return [text for key, one in seen.items() for text in _apart(key, one, redone[key])]


def _apart(key: tuple[float, str], told: Table, found: dict[str, float | None]) -> list[str]:
    names = told.keys() - {"quantity"}
    if names != found.keys():
        return [f"{key}: told {sorted(names)}, recomputed {sorted(found)}"]
    return [
        f"{key}: {name} told {told[name]}, recomputed {found[name]}"
        for name in names
        if abs(told[name] - found[name]) > _allowed(key[1], name, told)
    ]


def _allowed(quantity: str, name: str, told: Table) -> float:
    if name == "overshoot_percent":
        return PERCENT
    if name.endswith("_s"):
        return TIME_FLOOR_S
    return max(FLOORS[quantity.rsplit("_", 1)[1]], SHARE * abs(told[name]))
