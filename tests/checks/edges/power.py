"""Edges of power during a sag and after it."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from edges.edge import (
    FAIL,
    FINE_STEP_S,
    LET_OFF,
    LEVEL_PU,
    NO_SAG,
    PASS,
    RATED_KVA,
    SHARE,
    STEP_S,
    Edge,
    Record,
    Statuses,
    between,
    hz,
    record,
    two_phase,
    until,
)
from pvlvrt_compliance.profile import Profile
from pvlvrt_compliance.profile.requirements import (
    ActivePowerRecovery,
    ActivePowerSupport,
    ConstantPower,
    Consumption,
    Oscillation,
    ReturnToPrefault,
)
from pvlvrt_compliance.profile.requirements.power import ConsumptionZones
from pvlvrt_compliance.scenario.sag import Sag

SWING_HZ = 10.0
"""Swings of the records: a half-cycle mean hardly lowers them, and whole periods lie in the stretches."""


def active_power_support(demand: ActivePowerSupport, profile: Profile) -> Iterator[Edge]:
    """Eq (10) by hand at 0.70 pu, for V+ that is off, and from when on it is due."""
    cycle_s = 1 / hz(profile)
    low = 0.70 - demand.voltage_pu.value
    curve_pu = 0.75 * (0.85 - low) / 0.35
    due_kw = RATED_KVA * math.sqrt(low**2 - curve_pu**2)
    tolerance_kw, settling_s = demand.tolerance_fraction.value * RATED_KVA, demand.settling_s.value
    made = (record(s, Sag(depth=0.3), p_sag_kw=due_kw - tolerance_kw + d) for s, d in ((PASS, 0.1), (FAIL, -0.1)))
    yield Edge("eq (10)", ("tolerance_fraction", "voltage_pu"), *made)
    # Nothing until so late that the mean of a cycle is back at what is due as it begins to count.
    come_s = settling_s - (1 - tolerance_kw / due_kw) * cycle_s
    sides = ((PASS, come_s - STEP_S), (FAIL, come_s + STEP_S))
    made = (record(s, Sag(depth=0.3), p_sag_kw=until(t, 0.0, due_kw)) for s, t in sides)
    yield Edge("from when it is due", ("settling_s",), *made)


def oscillation(demand: Oscillation, profile: Profile) -> Iterator[Edge]:
    """The swing of P and of Q, from when on it counts after either kind of step, and in how short a stretch."""
    cycle_s, settling_s = 1 / hz(profile), demand.settling_s.value
    limit = demand.limit_fraction.value * RATED_KVA
    half = math.pi * SWING_HZ * cycle_s / 2
    amplitude = 0.5 * limit / (math.sin(half) / half)

    def swing(times: float) -> Any:
        """Cosine whose mean of half a cycle, a quarter of one late, begins at its peak: its line is level."""
        return lambda t: times * amplitude * np.cos(2 * np.pi * SWING_HZ * (t - settling_s + 0.25 * cycle_s))

    for key in ("p_sag_kw", "q_sag_kvar"):
        sides = ((PASS, 1 - SHARE), (FAIL, 1 + SHARE))
        made = (record(s, Sag(depth=0.5), settling_s + 0.5, **{key: swing(x)}) for s, x in sides)
        yield Edge(f"swing of {key[0]}", ("limit_fraction",), *made)
    darker = {"events": [{"kind": "irradiance", "t_s": 0, "to_w_m2": 900}]}
    for name, sag, scenario in (("settling_s", Sag(depth=0.5), None), ("array_settling_s", NO_SAG, darker)):
        # A pulse of one cycle that the mean of half a cycle has left behind as it begins to count, or not.
        after_s = getattr(demand, name).value
        sides = ((PASS, after_s - 1.5 * cycle_s - STEP_S), (FAIL, after_s - STEP_S))
        made = (
            record(s, sag, 0.6, scenario, p_sag_kw=between(t, t + cycle_s, 3 * limit), p_after_kw=0.0) for s, t in sides
        )
        yield Edge(name, (name,), *made)
    lasts_s = settling_s + demand.least_cycles.value * cycle_s
    fast = lambda t: 4 * limit * np.cos(2 * np.pi * 0.6 / cycle_s * t)  # noqa: E731
    sides = ((PASS, lasts_s - STEP_S), (FAIL, lasts_s + STEP_S))  # the stretch that follows passes
    made = (record(s, Sag(depth=0.5), d, p_sag_kw=fast) for s, d in sides)
    yield Edge("shortest stretch", ("least_cycles",), *made)


def active_power_recovery(demand: ActivePowerRecovery, profile: Profile) -> Iterator[Edge]:
    """Both times of each depth, both shares, and the depths themselves."""
    cycle_s, return_pu = 1 / hz(profile), demand.return_pu.value
    fraction, tolerance = demand.first_fraction.value, demand.tolerance_fraction.value
    rows = sorted(demand.rows.rows, key=lambda row: row.residual_pu)
    longest_s = max(row.first_s + row.final_extra_s for row in rows)

    def made(statuses: Statuses, residual: float, p_after: Any) -> Record:
        return record(statuses, Sag(depth=1 - residual), 0.3, {"after_s": longest_s + 0.4}, p_after_kw=p_after)

    for row in rows:
        residual = 0.5 * sum(row.residual_pu)
        returned_s = cycle_s * max(return_pu - residual, 0.0) / (1 - residual)
        first_s, last_s = returned_s + row.first_s, returned_s + row.first_s + row.final_extra_s
        by = ((PASS, -STEP_S), (FAIL, STEP_S))
        late_s = first_s - fraction * cycle_s
        sides = (made(s, residual, until(late_s + d, 0.0, RATED_KVA)) for s, d in by)
        yield Edge(f"first time at {residual:g} pu", ("rows", "return_pu", "first_fraction"), *sides)
        for sign in (-1, 1):
            # From twice the tolerance off, the mean is within it half a cycle after the step.
            far = RATED_KVA * (1 + sign * min(2 * tolerance, 0.99 * (1 - fraction) if sign < 0 else 1.0))
            part = (abs(far - RATED_KVA) - tolerance * RATED_KVA) / abs(far - RATED_KVA)
            if part <= 0:
                continue  # the first share is within the tolerance
            sides = (made(s, residual, until(last_s - part * cycle_s + d, far, RATED_KVA)) for s, d in by)
            yield Edge(f"last time at {residual:g} pu", ("rows", "tolerance_fraction", "return_pu"), *sides)
    for sign in (-1, 1):
        edge = tolerance * RATED_KVA
        if sign < 0 and 1 - tolerance <= fraction + 1e-9:
            edge = (1 - fraction) * RATED_KVA  # below, the first share is the stricter one, or the same
        sides = (made(s, 0.6, RATED_KVA + sign * (edge + d)) for s, d in ((PASS, -0.5), (FAIL, 0.5)))
        yield Edge("share" if sign < 0 else "above", ("first_fraction", "tolerance_fraction"), *sides)
    for lower, upper in zip(rows, [*rows[1:], None], strict=True):
        level = lower.residual_pu[1]
        if upper is None:
            sides = [(LET_OFF, level + LEVEL_PU), (FAIL, level - LEVEL_PU)]
            back: Any = 0.5 * RATED_KVA
        else:
            on_it_pu = level - profile.thresholds.voltage_tolerance_pu.value  # nearer to it is the upper row's
            sides = [(PASS, on_it_pu - LEVEL_PU), (FAIL, on_it_pu + LEVEL_PU)]
            back = until(0.5 * (lower.first_s + upper.first_s), 0.0, RATED_KVA)
        yield Edge(f"depth to {level:g} pu", ("rows",), *(made(s, u, back) for s, u in sides))


FAULT_S = 0.4


def consumption(demand: Consumption, profile: Profile) -> Iterator[Edge]:
    """Each limit of each zone alone, where the zones meet, and what makes a fault unbalanced."""
    cycle_s = 1 / hz(profile)
    for name, zones, asked in (
        ("balanced", demand.balanced, Sag(depth=0.5)),
        ("unbalanced", demand.unbalanced, two_phase(0.25)),
    ):
        if zones is None:
            continue
        for limit, number in zones:
            if limit != "transient_s" and number is not None:
                blank = {n: None for n, x in zones if n not in {"transient_s", limit} and x is not None}
                only = {name: zones.model_copy(update=blank)}
                sides = (
                    _taking(s, asked, limit, number.value * by, zones.transient_s.value)
                    for s, by in ((PASS, 1 - SHARE), (FAIL, 1 + SHARE))
                )
                yield Edge(f"{name}: {limit}", (f"{name}.{limit}",), *sides, only)
        yield _transient(name, zones, asked, cycle_s)
    if demand.unbalanced is not None and demand.unbalanced.reactive_power_b and demand.balanced.reactive_power_b:
        taken = 0.5 * (demand.unbalanced.reactive_power_b.value + demand.balanced.reactive_power_b.value)
        blank = {"balanced": _reactive_b_only(demand.balanced), "unbalanced": _reactive_b_only(demand.unbalanced)}
        edge = demand.unbalanced_from_pu.value
        sides = ((PASS, edge + LEVEL_PU), (FAIL, edge - LEVEL_PU))
        yield Edge(
            "unbalance",
            ("unbalanced_from_pu",),
            *(record(s, two_phase(v), FAULT_S, q_sag_kvar=between(0.2, 0.3, -taken * RATED_KVA)) for s, v in sides),
            blank,
        )


def _reactive_b_only(zones: ConsumptionZones) -> ConsumptionZones:
    blank = {n: None for n, x in zones if n not in {"transient_s", "reactive_power_b"} and x is not None}
    return zones.model_copy(update=blank)


def _taking(statuses: Statuses, asked: Sag, limit: str, value: float, transient_s: float) -> Record:
    """A record that takes this much (per unit, or seconds of rated power) in the limit's zone."""
    zone = limit.removesuffix("_s").removesuffix("_pu")[-1]
    spans = {"a": (0.0, transient_s), "b": (transient_s, FAULT_S), "c": (0.0, transient_s)}
    begin_s, end_s = spans[zone]
    size = RATED_KVA * value / (end_s - begin_s) if "energy" in limit else RATED_KVA * value
    key = "p_sag_kw" if limit.startswith("active") else "q_after_kvar" if zone == "c" else "q_sag_kvar"
    settings: dict[str, Any] = {key: between(begin_s, end_s, -size), "dt_s": FINE_STEP_S}
    return record(statuses, asked, FAULT_S, **settings)


def _transient(name: str, zones: ConsumptionZones, asked: Sag, cycle_s: float) -> Edge:
    """Twice the limit of zone B taken until so late that one cycle of zone B holds half of that, or a little more."""
    limit = zones.reactive_power_b
    assert limit is not None
    latest_s = zones.transient_s.value + 0.5 * cycle_s
    only = {name: _reactive_b_only(zones)}
    sides = (
        record(s, asked, FAULT_S, q_sag_kvar=between(0.0, latest_s + d, -2 * limit.value * RATED_KVA))
        for s, d in ((PASS, -STEP_S), (FAIL, STEP_S))
    )
    return Edge(f"{name}: where the zones meet", (f"{name}.transient_s",), *sides, only)


def constant_power(demand: ConstantPower, profile: Profile) -> Iterator[Edge]:
    """Negative-sequence current n against V+ swings P by n V+ S at twice the frequency."""
    nominal_hz = hz(profile)

    def swinging(size_pu: float) -> Any:
        def current(t: np.ndarray) -> np.ndarray:
            angle = 2 * np.pi * nominal_hz * t + np.array([0, 2, -2])[:, np.newaxis] * np.pi / 3
            return size_pu * (t >= profile.procedure.before_s.value) * np.cos(angle)

        return current

    size = demand.limit_fraction.value / 0.5
    sides = ((PASS, size * (1 - SHARE)), (FAIL, size * (1 + SHARE)))
    yield Edge(
        "ripple of P",
        ("limit_fraction",),
        *(record(s, Sag(depth=0.5), extra_current_pu=swinging(x), p_sag_kw=100.0) for s, x in sides),
    )


def return_to_prefault(demand: ReturnToPrefault, profile: Profile) -> Iterator[Edge]:
    """P and Q at the end, above and below what they were."""
    assert profile
    for name, key, before in (
        ("active_fraction", "p_after_kw", RATED_KVA),
        ("reactive_fraction", "q_after_kvar", 0.0),
        ("reactive_pu", "q_after_kvar", 0.0),
    ):
        if (number := getattr(demand, name)) is None:
            continue
        limit_kva = RATED_KVA * number.value  # V+ is 1 pu
        for sign in (-1, 1):
            sides = ((PASS, limit_kva * (1 - SHARE)), (FAIL, limit_kva * (1 + SHARE)))
            yield Edge(
                f"{name}, {sign:+d}",
                (name,),
                *(record(s, Sag(depth=0.5), **{key: before + sign * x}) for s, x in sides),
            )
