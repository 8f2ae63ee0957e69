"""Recomputes the verdicts of `results.json` from waveforms and profile, by `docs/measurements.md` alone.

It shares no code with the package that is judged: one-cycle values are direct sums over samples, phasors of windows
least squares, searches plain loops.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from recomputing import current, dynamics, faults, frequencies, jumps, power, quality, ride_through, support
from recomputing.grid import Stretch
from recomputing.numbers import Missing, Off, Recomputed, Table, worst_of
from recomputing.validity import does_not_count
from recomputing.view import View

Parts = Callable[[View], list[Stretch]]
JudgePart = Callable[[View, Table, Stretch], Recomputed]


def judge(result: Table, profile: Table, waveforms: dict[str, np.ndarray]) -> list[Recomputed]:
    """Recompute every verdict of one test.

    Parameters
    ----------
    result : dict
        The test as `results.json` has it: disturbance, rating, expect, by_s, k_factor, available_power_kw, and the
        kinds of its checks. Nothing that was measured is read.
    profile : dict
        The resolved profile, as ``pvlvrt-check profiles show NAME --json`` prints it.
    waveforms : dict of array, shape (n,)
        The channels of the CSV, `t_s` among them.

    Returns
    -------
    list
        One for each check of the result that is of one record; rules of several runs are left out.
    """
    view = View(result, profile, waveforms)
    kinds = [check["check"] for check in result["checks"] if check["check"] in JUDGES]
    if does_not_count(view):
        return [Recomputed(kind, "not_evaluated") for kind in kinds]
    found = [_judge(kind, view, profile["requirements"][kind]) for kind in kinds]
    nothing = all(verdict.status == "not_applicable" for verdict in found)
    if found and nothing and result.get("expect") != "may_trip":
        found[0] = found[0]._replace(status="not_evaluated")
    return found


def _judge(kind: str, view: View, demand: Table) -> Recomputed:
    try:
        return JUDGES[kind](view, demand)
    except Off:
        return Recomputed(kind, "not_applicable")
    except Missing:
        return Recomputed(kind, "not_evaluated")


def _each(parts: Parts, one: JudgePart) -> Callable[[View, Table], Recomputed]:
    """Judge each stretch; the worst counts, and what cannot be measured only where nothing failed."""

    def judged(view: View, demand: Table) -> Recomputed:
        found, reasons, missing = [], [], []
        for part in parts(view):
            try:
                found.append(one(view, demand, part))
            except Off as reason:
                reasons.append(reason)
            except Missing as reason:
                missing.append(reason)
        if missing and not any(verdict.status == "fail" for verdict in found):
            raise missing[0]
        if not found:
            raise reasons[0] if reasons else Off("there is no such stretch")
        return worst_of(found)

    return judged


def _supported(view: View) -> list[Stretch]:
    return view.disturbed("release")


def _stepped(view: View) -> list[Stretch]:
    return [part for part in _supported(view) if part["begin_s"] in view.grid.steps_of("voltage")]


def _of_voltage(view: View) -> list[Stretch]:
    return view.grid.of_voltage(view.stretches("trip")[-1]["end_s"])


def _unless_tripped(one: Callable[[View, Table], Recomputed]) -> Callable[[View, Table], Recomputed]:
    def judged(view: View, demand: Table) -> Recomputed:
        if view.opened_s is not None:
            raise Off("not judged after the trip")
        return one(view, demand)

    return judged


def _reactive_current(index: int) -> JudgePart:
    def judged(view: View, demand: Table, part: Stretch) -> Recomputed:
        return support.judge_reactive_current(view, demand, part, index)

    return judged


JUDGES: dict[str, Any] = {
    "ride_through": ride_through.judge,
    "frequency_ride_through": frequencies.judge,
    "phase_jump_ride_through": jumps.judge,
    "current_limit": current.judge_limit,
    "reactive_support": _each(_supported, support.judge_reactive_power),
    "reactive_current": _each(_supported, _reactive_current(0)),
    "negative_sequence_current": _each(_supported, _reactive_current(1)),
    "support_dynamics": _each(_stepped, dynamics.judge),
    "reactive_ratio": _each(_supported, support.judge_share),
    "toggling": _each(_of_voltage, support.judge_toggling),
    "active_power_support": _each(_supported, power.judge_active_power),
    "active_power_recovery": _each(faults.faults, faults.judge_recovery),
    "consumption": _each(faults.faults, faults.judge_consumption),
    "constant_power": _each(power.departed, power.judge_constant_power),
    "oscillation": _each(lambda view: view.stretches("release"), power.judge_oscillation),
    "return_to_prefault": _unless_tripped(power.judge_return),
    "overfrequency_power": frequencies.judge_overfrequency,
    "dc_ripple": _each(power.departed, power.judge_dc_ripple),
    "harmonics": quality.judge_harmonics,
    "dc_injection": quality.judge_dc,
}
