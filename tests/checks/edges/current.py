"""Edges of currents: their limit, support by a curve of V+, its share, and that it does not toggle."""

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np

from edges.edge import (
    CURRENT_PU,
    FAIL,
    LEVEL_PU,
    PASS,
    RATED_KVA,
    SHORT_STEP_S,
    STEP_S,
    Edge,
    Record,
    Statuses,
    between,
    hz,
    kvar,
    record,
    two_phase,
    until,
)
from pvlvrt_compliance.profile import Profile
from pvlvrt_compliance.profile.requirements import (
    CurrentLimit,
    ReactiveRatio,
    ReactiveSupport,
    Toggling,
)
from pvlvrt_compliance.scenario.sag import Sag

SIDES = ((PASS, 1 - CURRENT_PU), (FAIL, 1 + CURRENT_PU))
"""Factors on a limit."""


def current_limit(demand: CurrentLimit, profile: Profile) -> Iterator[Edge]:
    """The settled fundamental in the sag and after it, the peak, and the time to settle."""
    allowed = demand.limit_pu.value + demand.tolerance_pu.value
    size = ("limit_pu", "tolerance_pu")
    sides = ((PASS, allowed * (1 - CURRENT_PU)), (FAIL, allowed * (1 + CURRENT_PU)))
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
        pulses = ((s, _pulse(phase, peak * by)) for s, by in ((PASS, 1 - CURRENT_PU), (FAIL, 1 + CURRENT_PU)))
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
        sides = ((PASS, edge + CURRENT_PU), (FAIL, edge - CURRENT_PU))
        yield Edge(f"share at {u:g} pu", ("curve", "tolerance"), *(sharing(s, u, constant(x)) for s, x in sides))
    # From all active to all reactive current in one step: a cycle later the share is whole.
    late = ((PASS, -STEP_S), (FAIL, STEP_S))
    top = points[0][1] - tolerance
    # Of n parts reactive in a cycle, the share is n / sqrt(n^2 + (1 - n)^2).
    part = 1 / (1 + math.sqrt(1 / top**2 - 1))
    latest_s = within_s - part * cycle_s
    yield Edge("time", ("within_s",), *(sharing(s, 0.3, until(latest_s + d, 0.0, 1.0)) for s, d in late))
    least = demand.least_current_pu.value
    sides = ((PASS, least + CURRENT_PU), (FAIL, least - CURRENT_PU))
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
            (s, high + way * CURRENT_PU * (name == "on_pu"), low + way * CURRENT_PU * (name == "off_pu"))
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
