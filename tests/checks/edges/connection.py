"""Edges of staying connected: envelopes, angles, and the power that must come back; regions are in `regions`."""

import math
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Any

import numpy as np

from edges.edge import (
    FAIL,
    FREE,
    LET_OFF,
    LEVEL_PU,
    LONG_S,
    PASS,
    RATED_KVA,
    STEP_S,
    Edge,
    Record,
    Statuses,
    between,
    held,
    hz,
    record,
    until,
)
from edges.regions import region_edges
from pvlvrt_compliance.profile import Profile
from pvlvrt_compliance.profile.curves import Envelope, Side
from pvlvrt_compliance.profile.requirements import PhaseJumpRideThrough, RideThrough
from pvlvrt_compliance.scenario.sag import Sag

JUMP_S = 0.1

LONGEST_S = 3500.0
"""No test may be asked to last longer than an hour: what is demanded for one has no side beyond it."""

HARDLY_KW = 20.0
"""Power that shows a working bridge, and nothing else."""

AWAY_S = 2.0
"""How long a trip waits where time does not decide."""


def ride_through(demand: RideThrough, profile: Profile) -> Iterator[Edge]:
    """Every corner of the envelopes and regions, the tolerance, and the recovery."""
    tolerance = demand.envelope_tolerance_pu.value
    for name, side in (
        ("envelope", Side.LOW),
        ("envelope_two_phase", Side.LOW),
        ("envelope_over_voltage", Side.HIGH),
    ):
        if (envelope := getattr(demand, name)) is not None:
            yield from _envelope(name, envelope, side, tolerance, hz(profile))
    if demand.regions is not None:
        yield from region_edges(demand.regions, tolerance, hz(profile))
    if demand.recovery_fraction is not None and demand.recovery_time_s is not None:
        names = ("recovery_fraction", "recovery_time_s")
        fraction, time_s = demand.recovery_fraction.value, demand.recovery_time_s.value
        made = {"asked": Sag(depth=0.3), "duration_s": 0.3, "p_sag_kw": 0.7 * RATED_KVA}
        yield from recovery(names, fraction, time_s, 1 / hz(profile), _after_clearing, **made)


Power = Callable[[float, float], dict[str, Any]]
"""What the bench needs for P (kW) to come back at a time."""


def recovery(
    names: tuple[str, str], fraction: float, time_s: float, cycle_s: float, power: Power, **made: Any
) -> Iterator[Edge]:
    """P comes back in one step; its one-cycle mean reaches the share by that part of a cycle later."""
    scenario = {"after_s": time_s + 0.3} | made.pop("scenario", {})

    def back(ok: bool, at_s: float, level_kw: float) -> Record:
        return record(PASS if ok else FAIL, scenario=scenario, **made, **power(at_s, level_kw))

    latest_s, share_kw = time_s - fraction * cycle_s, fraction * RATED_KVA
    too_late = back(False, latest_s + STEP_S, RATED_KVA)
    yield Edge("recovery time", names, back(True, latest_s - STEP_S, RATED_KVA), too_late)
    yield Edge("recovery share", names, back(True, 0.05, share_kw + 0.5), back(False, 0.05, share_kw - 0.5))


def _after_clearing(at_s: float, level_kw: float) -> dict[str, Any]:
    return {"p_after_kw": until(at_s, HARDLY_KW, level_kw)}


def _after_jump(at_s: float, level_kw: float) -> dict[str, Any]:
    lost = between(JUMP_S, JUMP_S + at_s, RATED_KVA - HARDLY_KW)
    short = until(JUMP_S, 0.0, RATED_KVA - level_kw)
    return {"p_kw": lambda t: RATED_KVA - np.maximum(lost(t), short(t))}


def _at_level(name: str, u_pu: float, duration_s: float) -> dict[str, Any]:
    """A voltage of all phases, or two-phase with that lowest phase voltage, for a time."""
    if name != "envelope_two_phase":
        return {"duration_s": duration_s, "scenario": {"events": [held(u_pu, duration_s)]}}
    depth = 1 - math.sqrt((u_pu**2 - 0.25) / 0.75)  # phases b and c of type C: sqrt(1/4 + 3/4 (1 - depth)^2)
    return {"duration_s": duration_s, "asked": Sag(depth=depth, phases="bc", two_phase=True)}


def _trip(name: str, u_pu: float, at_s: float, statuses: Statuses, nominal_hz: float, lasts_s: float = 0.0) -> Record:
    held_s = max(lasts_s, at_s + AWAY_S)
    settings: dict[str, Any] = {"p_sag_kw": 50.0, "disconnected_after_s": at_s}
    if held_s > LONG_S:
        settings["dt_s"] = 1 / (8 * nominal_hz)
    return record(statuses, **settings, **_at_level(name, u_pu, held_s))


def _envelope(name: str, envelope: Envelope, side: Side, tolerance: float, nominal_hz: float) -> Iterator[Edge]:
    """Times at each level of a corner and between two, and the levels that are not joined by a line."""
    sign = 1 if side is Side.LOW else -1
    levels = sorted({u for _, u in envelope.points})
    for u in sorted({*levels, *(0.5 * (a + b) for a, b in pairwise(levels))}):
        time_s = envelope.time_of(u, side)
        if time_s and time_s < LONGEST_S and sign * (levels[-1] - u if side is Side.LOW else levels[0] - u) > tolerance:
            # The record goes on until the envelope has passed the voltage by more than the tolerance.
            passed_s = (envelope.time_of(u + sign * tolerance, side) or 0.0) + 0.1
            by_s = 2 / (8 * nominal_hz) if passed_s > LONG_S else STEP_S  # two samples
            late = _trip(name, u, time_s + by_s, PASS, nominal_hz, passed_s)
            early = _trip(name, u, time_s - by_s, FAIL, nominal_hz, passed_s)
            yield Edge(f"{name}: {u:g} pu for {time_s:g} s", (name,), late, early)
    for at_s, level in (found for found in _sharp_levels(envelope) if found[0] < LONGEST_S):
        edge = level - sign * tolerance
        if edge > (0.5 if name == "envelope_two_phase" else LEVEL_PU):
            by = sign * LEVEL_PU
            beyond, within = (
                _trip(name, edge + sign_by, at_s, statuses, nominal_hz)
                for sign_by, statuses in ((-by, FREE), (by, FAIL))
            )
            yield Edge(f"{name}: level {level:g} pu", (name, "envelope_tolerance_pu"), beyond, within)


def _sharp_levels(envelope: Envelope) -> Iterator[tuple[float, float]]:
    """Levels that a voltage is above or below, and an instant at which they hold (s, pu)."""
    points = envelope.points
    ends_s = [*(t for t, _ in points[1:]), points[-1][0] + 2.0]
    for index, ((from_s, level), to_s) in enumerate(zip(points, ends_s, strict=True)):
        if envelope.interpolation == "step" or index in {0, len(points) - 1}:
            yield (0.05 if index == 0 else 0.5 * (from_s + to_s)), level


def phase_jump_ride_through(demand: PhaseJumpRideThrough, profile: Profile) -> Iterator[Edge]:
    """Jumps of all phases either way and of one, and the power after them."""

    def jumped(statuses: Statuses, angle: float) -> Record:
        events = {"events": [{"kind": "phase_jump", "t_s": 0.2, "angle_deg": angle}]}
        return record(statuses, duration_s=0.5, scenario=events, p_sag_kw=RATED_KVA, disconnected_after_s=0.3)

    limit = demand.all_phases_deg.value + 0.1  # an angle is known to 0.1 deg
    for sign in (-1, 1):
        edges = sign * (limit - 0.03), sign * (limit + 0.03)
        yield Edge(
            f"jump by {sign * limit:g} deg", ("all_phases_deg",), jumped(LET_OFF, edges[1]), jumped(FAIL, edges[0])
        )
    if demand.single_phase_deg is not None:
        for sign in (-1, 1):
            sags = [
                Sag(depth=0, phases="b", angle_deg=sign * (demand.single_phase_deg.value + 0.1 + by))
                for by in (-0.03, 0.03)
            ]
            yield Edge(
                f"one phase by {sign * demand.single_phase_deg.value:g} deg",
                ("single_phase_deg",),
                *(
                    record(s, asked=sag, duration_s=0.5, p_sag_kw=RATED_KVA)
                    for s, sag in zip((PASS, LET_OFF), sags, strict=True)
                ),
            )
    events = {"events": [{"kind": "phase_jump", "t_s": JUMP_S, "angle_deg": 10}]}
    names = ("recovery_fraction", "recovery_time_s")
    fraction, time_s = demand.recovery_fraction.value, demand.recovery_time_s.value
    yield from recovery(names, fraction, time_s, 1 / hz(profile), _after_jump, duration_s=0.4, scenario=events)
