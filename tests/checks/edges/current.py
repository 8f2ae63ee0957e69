"""Edges of currents: their limit, and the support of the voltage in its size, share, times and steadiness."""

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np

from edges.edge import (
    FAIL,
    LET_OFF,
    PASS,
    RATED_KVA,
    SHORT_STEP_S,
    STEP_S,
    Edge,
    Record,
    Statuses,
    between,
    held,
    hz,
    kvar,
    record,
    two_phase,
    until,
)
from pvlvrt_compliance.profile import Profile
from pvlvrt_compliance.profile.requirements import (
    CurrentLimit,
    ReactiveCurrent,
    ReactiveRatio,
    ReactiveSupport,
    SupportDynamics,
    Toggling,
)
from pvlvrt_compliance.scenario.sag import Sag

SHARE = 1e-3
"""Distance in current, as a fraction of nominal."""

LEVEL_PU = 1e-3
"""Distance in voltage."""

SIDES = ((PASS, 1 - SHARE), (FAIL, 1 + SHARE))
"""Factors on a limit."""


def current_limit(demand: CurrentLimit, profile: Profile) -> Iterator[Edge]:
    """The settled fundamental in the sag and after it, the peak, and the time to settle."""
    allowed = demand.limit_pu.value + demand.tolerance_pu.value
    size = ("limit_pu", "tolerance_pu")
    sides = ((PASS, allowed * (1 - SHARE)), (FAIL, allowed * (1 + SHARE)))
    yield Edge("in the sag", size, *(record(s, Sag(depth=0.5), q_sag_kvar=kvar(x, 0.5)) for s, x in sides))
    yield Edge("after it", size, *(record(s, _SLIGHT, p_sag_kw=400.0, p_after_kw=RATED_KVA * x) for s, x in sides))
    cycle_s, settling_s = 1 / hz(profile), demand.settling_s.value
    for start_s in (0.0, 0.3):
        # A tenth too much until one cycle before the end of the settling, and a part of that cycle.
        part_s = cycle_s * 2 * demand.tolerance_pu.value / 0.1 / demand.limit_pu.value
        stops = [(PASS, settling_s - cycle_s - STEP_S), (FAIL, settling_s - cycle_s + part_s)]
        surges = ((s, between(start_s, start_s + stop, 0.1)) for s, stop in stops)
        settled = (record(s, _SLIGHT, p_kw=_surging(surge, demand.limit_pu.value)) for s, surge in surges)
        yield Edge(f"settling from {start_s:g} s", ("settling_s",), *settled)
    yield from _stages(demand, profile)
    peak = demand.peak_pu.value
    for phase in range(3):
        # The bench feeds nothing in the sag, so that the peak is that of the pulse alone.
        pulses = ((s, _pulse(phase, peak * by)) for s, by in ((PASS, 1 - SHARE), (FAIL, 1 + SHARE)))
        yield Edge(
            f"peak in phase {'abc'[phase]}",
            ("peak_pu",),
            *(record(s, Sag(depth=0.5), extra_current_pu=x, p_sag_kw=0.0) for s, x in pulses),
        )


_SLIGHT = Sag(depth=0.02)
"""A step of the voltage that leaves it normal."""


def _stages(demand: CurrentLimit, profile: Profile) -> Iterator[Edge]:
    """The limit before the current is settled, and from when on it counts."""
    if demand.stage_pu is None or demand.stage_from_cycles is None:
        return
    cycle_s, limit, stage = 1 / hz(profile), demand.limit_pu.value, demand.stage_pu.value
    lasts_s = demand.settling_s.value - cycle_s - STEP_S
    for start_s in (0.0, 0.3):
        sizes = ((s, between(start_s, start_s + lasts_s, stage * by - limit)) for s, by in SIDES)
        edge = (record(s, _SLIGHT, p_kw=_surging(surge, limit)) for s, surge in sizes)
        yield Edge(f"unsettled from {start_s:g} s", ("stage_pu",), *edge)
        # Twice what is allowed: of a cycle that ends when the limit begins to count, half may still be so. What two
        # samples more or less do to a phase differs by its angle; hence the little less.
        until_s = start_s + (demand.stage_from_cycles.value - 1 + 0.5) * cycle_s
        twice = 2 * (stage - limit)
        times = ((PASS, -STEP_S, 0.98 * twice), (FAIL, STEP_S, twice))
        surges = ((s, between(start_s, until_s + d, x)) for s, d, x in times)
        edge = (record(s, _SLIGHT, p_kw=_surging(surge, limit)) for s, surge in surges)
        yield Edge(f"unsettled, time from {start_s:g} s", ("stage_from_cycles",), *edge)


def _surging(surge: Any, limit_pu: float) -> Any:
    """Active power of a current at its limit from the start of a slight sag on, and what comes on top of it."""
    u = lambda t: np.where((t >= 0) & (t < 0.3), 1 - _SLIGHT.depth, 1.0)  # noqa: E731
    return lambda t: RATED_KVA * u(t) * np.where(t < 0, 1.0, limit_pu + surge(t))


def _pulse(phase: int, size_pu: float) -> Any:
    """A sample and its opposite, which together leave the fundamental as it is."""

    def current(t: np.ndarray) -> np.ndarray:
        extra = np.zeros((3, len(t)))
        at = int(np.searchsorted(t, 0.425))  # in the sag
        extra[phase, at : at + 2] = -size_pu, size_pu
        return extra

    return current


def reactive_support(demand: ReactiveSupport, profile: Profile) -> Iterator[Edge]:
    """The curve at its corners and between, with the clip; no support, on both sides; the level between the two."""
    assert profile
    points, from_pu = demand.curve.points, demand.no_support_from_pu.value
    tolerance = demand.tolerance_pu.value
    levels = [u for u, _ in points] + [0.5 * (a + b) for (a, _), (b, _) in pairwise(points)]
    for u in sorted({min(u, from_pu - LEVEL_PU) for u in levels if u > 0}):
        by_curve = float(np.interp(u, *zip(*points, strict=True)))
        wanted = min(by_curve, u) if demand.clip_to_capability.value else by_curve
        edge = RATED_KVA * (wanted - tolerance * u)
        names = ("curve", "tolerance_pu", *(("clip_to_capability",) if wanted < by_curve else ()))
        sides = ((PASS, edge + 0.1), (FAIL, edge - 0.1))
        yield Edge(f"least support at {u:g} pu", names, *(record(s, Sag(depth=1 - u), q_sag_kvar=q) for s, q in sides))
    if demand.clip_to_capability.value:
        # V+ - V- of a two-phase sag with V- = 0.3 pu is 0.4 pu: less than the curve asks for at 0.7 pu, or not.
        by_curve = float(np.interp(0.62, *zip(*points, strict=True)))
        wanted = min(by_curve, 0.62 - 0.38)
        edge = RATED_KVA * (wanted - tolerance * 0.62)
        sides = ((PASS, edge + 0.1), (FAIL, edge - 0.1))
        yield Edge(
            "clip in an unbalanced sag",
            ("clip_to_capability",),
            *(record(s, two_phase(0.38), q_sag_kvar=q) for s, q in sides),
        )
    for u in (from_pu + LEVEL_PU, 0.95):
        for sign in (-1, 1):
            sides = ((PASS, tolerance * u * RATED_KVA - 0.1), (FAIL, tolerance * u * RATED_KVA + 0.1))
            yield Edge(
                f"no support at {u:g} pu",
                ("no_support_from_pu", "tolerance_pu"),
                *(record(s, Sag(depth=1 - u), q_sag_kvar=sign * q) for s, q in sides),
            )
    much = 2 * tolerance * RATED_KVA
    sides = ((PASS, from_pu - LEVEL_PU), (FAIL, from_pu + LEVEL_PU))
    yield Edge(
        "level of no support",
        ("no_support_from_pu",),
        *(record(s, Sag(depth=1 - u), q_sag_kvar=much) for s, u in sides),
    )


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
        bounds = ((PASS, sign * (edge - SHARE)), (FAIL, sign * (edge + SHARE)))
        yield Edge("without an event", names, *(_supporting(s, u, i) for s, i in bounds))
    if profile.detection and profile.detection.enter_above_pu is None:
        # A swell is no event then: from K delta u to nothing at all, and a tolerance beyond either.
        wanted = max(k * _beyond(-0.2, dead, mode), -demand.limit_pu.value)
        for edge, sign in ((wanted - plus, -1), (minus, 1)):
            bounds = ((PASS, edge - sign * SHARE), (FAIL, edge + sign * SHARE))
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
            bounds = ((PASS, edge - sign * SHARE), (FAIL, edge + sign * SHARE))
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
            bounds = ((PASS, edge - sign * SHARE), (FAIL, edge + sign * SHARE))
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
    sides = ((LET_OFF, least - SHARE), (FAIL, least + SHARE))
    yield Edge("least change", ("least_change_pu",), *(timed(s, until(late, 0.0, i)) for s, i in sides))


def reactive_ratio(demand: ReactiveRatio, profile: Profile) -> Iterator[Edge]:
    """The share at the corners of the curve and between, from the time on, above the least current."""
    points, tolerance = demand.curve.points, demand.tolerance.value
    cycle_s, within_s = 1 / hz(profile), demand.within_s.value

    def sharing(statuses: Statuses, u: float, share: Any, total_pu: float = 0.8) -> Record:
        p = lambda t: kvar(total_pu, u) * np.sqrt(1 - np.asarray(share(t)) ** 2)  # noqa: E731
        q = lambda t: kvar(total_pu, u) * np.asarray(share(t))  # noqa: E731
        return record(statuses, Sag(depth=1 - u), p_sag_kw=p, q_sag_kvar=q)

    def constant(share: float) -> Any:
        return lambda t: share + 0.0 * t

    levels = [u for u, _ in points if u > 0] + [0.5 * (a + b) for (a, _), (b, _) in pairwise(points)]
    for u in levels:
        edge = float(np.interp(u, *zip(*points, strict=True))) - tolerance
        sides = ((PASS, edge + SHARE), (FAIL, edge - SHARE))
        yield Edge(f"share at {u:g} pu", ("curve", "tolerance"), *(sharing(s, u, constant(x)) for s, x in sides))
    # From all active to all reactive current in one step: a cycle later the share is whole.
    late = ((PASS, -STEP_S), (FAIL, STEP_S))
    top = points[0][1] - tolerance
    # Of n parts reactive in a cycle, the share is n / sqrt(n^2 + (1 - n)^2).
    part = 1 / (1 + math.sqrt(1 / top**2 - 1))
    latest_s = within_s - part * cycle_s
    yield Edge("time", ("within_s",), *(sharing(s, 0.3, until(latest_s + d, 0.0, 1.0)) for s, d in late))
    least = demand.least_current_pu.value
    sides = ((PASS, least + SHARE), (FAIL, least - SHARE))
    yield Edge("least current", ("least_current_pu",), *(sharing(s, 0.3, constant(1.0), i) for s, i in sides))


def toggling(demand: Toggling, profile: Profile) -> Iterator[Edge]:
    """One activation more than allowed, the levels of on and off, and when the count begins."""
    assert profile
    on, off, most = demand.on_pu.value, demand.off_pu.value, int(demand.most_activations.value)
    settling_s, u = demand.settling_s.value, 0.9
    begin_s = settling_s + 0.1
    every_s = 0.12

    def pulses(count: int, high: float, low: float = 0.0, from_s: float = begin_s) -> Any:
        on_now = lambda t: ((t - from_s) % every_s < 0.06) & (t >= from_s) & (t < from_s + count * every_s)  # noqa: E731
        # What comes before the first pulse is none at all, so that the first is an activation.
        return lambda t: kvar(1, u) * np.where(on_now(t), high, np.where(t < from_s, 0.0, low))

    def made(statuses: Statuses, q: Any) -> Record:
        return record(statuses, Sag(depth=1 - u), begin_s + (most + 2) * every_s, p_sag_kw=100.0, q_kvar=q)

    names = ("most_activations",)
    yield Edge("one more than allowed", names, made(PASS, pulses(most, 3 * on)), made(FAIL, pulses(most + 1, 3 * on)))
    for name, low, high in (("on_pu", 0.0, on), ("off_pu", off, 3 * on)):
        ways = (-1, 1) if name == "on_pu" else (1, -1)
        sides = [
            (s, high + way * SHARE * (name == "on_pu"), low + way * SHARE * (name == "off_pu"))
            for s, way in zip((PASS, FAIL), ways, strict=True)
        ]
        yield Edge(name, (name,), *(made(s, pulses(most + 1, h, x)) for s, h, x in sides))
    # The first of too many pulses is no more off when the count begins, or still is.
    reach_s = off / (3 * on) / hz(profile)
    sides = ((PASS, -2 * SHORT_STEP_S), (FAIL, 2 * SHORT_STEP_S))
    yield Edge(
        "settling",
        ("settling_s",),
        *(made(s, pulses(most + 1, 3 * on, 0.0, settling_s - reach_s + d)) for s, d in sides),
    )
