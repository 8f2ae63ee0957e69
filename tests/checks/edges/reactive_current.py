"""Edges of reactive current by K, in both sequences, and of how fast it comes."""

import math
from collections.abc import Iterator
from typing import Any

from edges.edge import (
    CURRENT_PU,
    FAIL,
    LET_OFF,
    LEVEL_PU,
    PASS,
    STEP_S,
    Edge,
    Record,
    Statuses,
    held,
    hz,
    kvar,
    record,
    two_phase,
    until,
)
from pvlvrt_compliance.profile import Profile
from pvlvrt_compliance.profile.requirements import (
    ReactiveCurrent,
    SupportDynamics,
)
from pvlvrt_compliance.scenario.sag import Sag


def reactive_current(demand: ReactiveCurrent, profile: Profile) -> Iterator[Edge]:
    """Both edges of the band in sags and swells, the dead band, the clip, the reference, and blocking."""
    yield from _bands_in_sags(demand, profile)
    dead, k = demand.dead_band_pu.value, demand.k.value
    plus, minus = demand.tolerance_plus_pu.value, demand.tolerance_minus_pu.value
    mode = demand.dead_band_mode.value
    threshold = profile.detection.enter_below_pu.value if profile.detection else 1.0
    assert abs(1 - dead - threshold) < 1e-9, "below: the dead band ends where an event begins"
    full = _beyond(dead + LEVEL_PU, dead, mode)
    little = 0.5 * (k * full - minus) if k * full > minus else None
    names = ("dead_band_pu", "dead_band_mode", "k")
    if little is not None:
        # Within the dead band nothing is wanted; just beyond it at least K times what counts.
        sides = (
            (PASS, 1 - dead + LEVEL_PU, min(little, 0.5 * plus)),
            (FAIL, 1 - dead - LEVEL_PU, min(little, 0.5 * plus)),
        )
        yield Edge("dead band", names, *(_supporting(s, u, i) for s, u, i in sides))
    for sign, edge in ((1, plus), (-1, minus)):
        u = 1 - dead + LEVEL_PU
        bounds = ((PASS, sign * (edge - CURRENT_PU)), (FAIL, sign * (edge + CURRENT_PU)))
        yield Edge("without an event", names, *(_supporting(s, u, i) for s, i in bounds))
    if profile.detection and profile.detection.enter_above_pu is None:
        # A swell is no event then: from K delta u to nothing at all, and a tolerance beyond either.
        wanted = max(k * _beyond(-0.2, dead, mode), -demand.limit_pu.value)
        for edge, sign in ((wanted - plus, -1), (minus, 1)):
            bounds = ((PASS, edge - sign * CURRENT_PU), (FAIL, edge + sign * CURRENT_PU))
            yield Edge("swell", names, *(_supporting(s, 1.2, i) for s, i in bounds))
    allowed_below = demand.blocking_allowed_below_pu.value
    sides = ((LET_OFF, allowed_below - LEVEL_PU), (FAIL, allowed_below + LEVEL_PU))
    blocked = (record(s, Sag(depth=1 - u), flows=lambda t: 1.0 - ((t >= 0) & (t < 0.3))) for s, u in sides)
    yield Edge("blocking", ("blocking_allowed_below_pu",), *blocked)


def _bands_in_sags(demand: ReactiveCurrent, profile: Profile) -> Iterator[Edge]:
    """Balanced sags: shallow, deep enough to be clipped, and one from a high voltage."""
    assert profile
    dead, k, limit = demand.dead_band_pu.value, demand.k.value, demand.limit_pu.value
    mode = demand.dead_band_mode.value
    from_before = demand.reference.value == "prefault"
    names = ("k", "dead_band_pu", "dead_band_mode", "tolerance_plus_pu", "tolerance_minus_pu")
    for label, fall, healthy, more in (
        ("shallow", dead + 0.05, 1.0, ()),
        ("clipped", 0.5, 1.0, ("limit_pu",)),
        ("from a high voltage", dead + 0.05, 1.03, ("reference",)),
    ):
        u = 1 - fall
        delta = (healthy - u) if from_before else fall
        wanted = min(k * _beyond(delta, dead, mode), limit)
        for sign, tolerance in ((1, demand.tolerance_plus_pu.value), (-1, demand.tolerance_minus_pu.value)):
            edge = wanted + sign * tolerance
            bounds = ((PASS, edge - sign * CURRENT_PU), (FAIL, edge + sign * CURRENT_PU))
            sides = (_supporting(s, u, i, healthy_pu=healthy) for s, i in bounds)
            yield Edge(f"{label}, {'most' if sign > 0 else 'least'}", (*names, *more), *sides)


def _supporting(statuses: Statuses, u: float, current_pu: float, **settings: Any) -> Record:
    scenario = {"events": [held(u, 0.3)]} if u > 1 else {}
    asked = Sag(depth=max(1 - u, 0.0))
    return record(statuses, asked, 0.3, scenario, q_sag_kvar=kvar(current_pu, u), **settings)


def _beyond(delta: float, dead: float, mode: str) -> float:
    """What a dead band leaves of a change of the voltage."""
    if mode == "none":
        return delta
    if abs(delta) <= dead:
        return 0.0
    return delta if mode == "step" else math.copysign(abs(delta) - dead, delta)


def negative_sequence_current(demand: ReactiveCurrent, profile: Profile) -> Iterator[Edge]:
    """Both edges of the band in two-phase sags, clipped with the positive sequence; dead band; blocking."""
    dead, limit, k = demand.dead_band_pu.value, demand.limit_pu.value, demand.k.value
    mode = demand.dead_band_mode.value
    other = profile.requirements.reactive_current
    assert other is not None

    def wanted(v_negative: float) -> float:
        # V+ falls by as much as V- rises.
        demands = [
            k * _beyond(v_negative, dead, mode),
            other.k.value * _beyond(v_negative, other.dead_band_pu.value, other.dead_band_mode.value),
        ]
        return demands[0] * min(1.0, limit / max(sum(demands), 1e-9))

    def made(statuses: Statuses, v_negative: float, current_pu: float, **settings: Any) -> Record:
        return record(statuses, two_phase(v_negative), negative_reactive_pu=current_pu, **settings)

    names = ("k", "dead_band_pu", "dead_band_mode", "tolerance_plus_pu", "tolerance_minus_pu")
    plus, minus = demand.tolerance_plus_pu.value, demand.tolerance_minus_pu.value
    for v_negative, alone in ((0.25, False), (dead + 0.05, True)):
        share = min(k * _beyond(v_negative, dead, mode), limit) if alone else wanted(v_negative)
        for sign, tolerance in ((1, plus), (-1, minus)):
            edge = share + sign * tolerance
            bounds = ((PASS, edge - sign * CURRENT_PU), (FAIL, edge + sign * CURRENT_PU))
            more = () if alone else ("limit_pu",)
            label = f"V- = {v_negative:g} pu, {'alone' if alone else 'both'}, {'most' if sign > 0 else 'least'}"
            yield Edge(label, (*names, *more), *(made(s, v_negative, i) for s, i in bounds), alone=alone)
    little = 0.5 * min(plus, wanted(dead + LEVEL_PU) - minus)
    sides = ((PASS, dead - LEVEL_PU), (FAIL, dead + LEVEL_PU))
    yield Edge("dead band", ("dead_band_pu", "dead_band_mode"), *(made(s, v, little) for s, v in sides))
    low = demand.blocking_allowed_below_pu.value
    sides = ((LET_OFF, low - LEVEL_PU), (FAIL, low + LEVEL_PU))
    # With the dead band of the profile nothing is due where V+ and V- differ by enough for a current.
    only = {"dead_band_pu": 0.05}
    yield Edge("blocking", ("blocking_allowed_below_pu",), *(_blocked(s, v) for s, v in sides), only)


def _blocked(statuses: Statuses, v_positive: float) -> Record:
    """Current away through an isolated two-phase sag that a voltage profile brings down to a V+."""
    sag = two_phase(0.3)
    factor = v_positive / 0.7
    scenario = {"events": [held(factor, 0.3)]}
    return record(statuses, sag, 0.3, scenario, flows=lambda t: 1.0 - ((t >= 0) & (t < 0.3)))


def support_dynamics(demand: SupportDynamics, profile: Profile) -> Iterator[Edge]:
    """Activation, response and settling of steps whose one-cycle mean is a straight line; the least change."""
    cycle_s, final, u = 1 / hz(profile), 0.5, 0.5
    detection = profile.detection
    seen_s = cycle_s * (1 - detection.enter_below_pu.value) / (1 - u) if detection else 0.0
    active, share = demand.activation_pu.value, demand.response_fraction.value

    def timed(statuses: Statuses, current: Any) -> Record:
        return record(statuses, Sag(depth=1 - u), q_sag_kvar=lambda t: kvar(1, u) * current(t))

    by = ((PASS, -STEP_S), (FAIL, STEP_S))
    latest_s = seen_s + demand.activation_s.value - active / final * cycle_s
    for sign in (-1, 1):
        yield Edge(
            "activation",
            ("activation_pu", "activation_s"),
            *(timed(s, until(latest_s + d, 0.0, sign * final)) for s, d in by),
        )
    early = 3 * active
    latest_s = seen_s + demand.response_s.value - (share * final - early) / (final - early) * cycle_s
    yield Edge(
        "response", ("response_fraction", "response_s"), *(timed(s, until(latest_s + d, early, final)) for s, d in by)
    )
    bands = (("band_plus", 1 + demand.band_plus.value, 0.06), ("band_minus", 1 - demand.band_minus.value, -0.06))
    for name, edge, further in bands:
        level = final * (edge + further)
        begun_s = max(active / level * cycle_s, seen_s)
        part_s = (level - edge * final) / (level - final) * cycle_s
        latest_s = begun_s + demand.settling_s.value - part_s
        only = {"response_s": 0.2}
        yield Edge(
            f"settling, {name}",
            (name, "settling_s", "activation_pu"),
            *(timed(s, until(latest_s + d, level, final)) for s, d in by),
            only,
        )
    least = demand.least_change_pu.value
    late = seen_s + demand.activation_s.value + 0.02
    sides = ((LET_OFF, least - CURRENT_PU), (FAIL, least + CURRENT_PU))
    yield Edge("least change", ("least_change_pu",), *(timed(s, until(late, 0.0, i)) for s, i in sides))
