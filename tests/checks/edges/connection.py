"""Edges of staying connected: envelopes, regions, angles, and the power that must come back."""

import math
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Any

import numpy as np

from edges.edge import (
    FAIL,
    FREE,
    LET_OFF,
    NO_SAG,
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
    record,
    until,
)
from pvlvrt_compliance.profile import Profile
from pvlvrt_compliance.profile.curves import Envelope, Side
from pvlvrt_compliance.profile.regions import CEASE, FOR_EVER, STAY_CONNECTED, Region, RegionTable
from pvlvrt_compliance.profile.requirements import PhaseJumpRideThrough, RideThrough
from pvlvrt_compliance.scenario.sag import Sag

U_PU = 1e-3
"""Distance in voltage."""

JUMP_S = 0.1

LONG_S = 100.0
LONG_STEP_S = 2 / 480
"""Distance in time of records longer than that: two samples of eight a cycle."""

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
            yield from _envelope(name, envelope, side, tolerance)
    if demand.regions is not None:
        yield from _regions(demand.regions, tolerance, hz(profile))
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


def _trip(name: str, u_pu: float, at_s: float, statuses: Statuses, lasts_s: float = 0.0) -> Record:
    held_s = max(lasts_s, at_s + AWAY_S)
    return record(statuses, p_sag_kw=50.0, disconnected_after_s=at_s, **_at_level(name, u_pu, held_s))


def _envelope(name: str, envelope: Envelope, side: Side, tolerance: float) -> Iterator[Edge]:
    """Times at each level of a corner and between two, and the levels that are not joined by a line."""
    sign = 1 if side is Side.LOW else -1
    levels = sorted({u for _, u in envelope.points})
    for u in sorted({*levels, *(0.5 * (a + b) for a, b in pairwise(levels))}):
        time_s = envelope.time_of(u, side)
        if time_s and time_s < LONGEST_S and sign * (levels[-1] - u if side is Side.LOW else levels[0] - u) > tolerance:
            # The record goes on until the envelope has passed the voltage by more than the tolerance.
            passed_s = (envelope.time_of(u + sign * tolerance, side) or 0.0) + 0.1
            late = _trip(name, u, time_s + STEP_S, PASS, passed_s)
            early = _trip(name, u, time_s - STEP_S, FAIL, passed_s)
            yield Edge(f"{name}: {u:g} pu for {time_s:g} s", (name,), late, early)
    for at_s, level in (found for found in _sharp_levels(envelope) if found[0] < LONGEST_S):
        edge = level - sign * tolerance
        if edge > (0.5 if name == "envelope_two_phase" else U_PU):
            by = sign * U_PU
            beyond, within = _trip(name, edge - by, at_s, FREE), _trip(name, edge + by, at_s, FAIL)
            yield Edge(f"{name}: level {level:g} pu", (name, "envelope_tolerance_pu"), beyond, within)


def _sharp_levels(envelope: Envelope) -> Iterator[tuple[float, float]]:
    """Levels that a voltage is above or below, and an instant at which they hold (s, pu)."""
    points = envelope.points
    ends_s = [*(t for t, _ in points[1:]), points[-1][0] + 2.0]
    for index, ((from_s, level), to_s) in enumerate(zip(points, ends_s, strict=True)):
        if envelope.interpolation == "step" or index in {0, len(points) - 1}:
            yield (0.05 if index == 0 else 0.5 * (from_s + to_s)), level


def _as_before_kw(u_pu: float) -> float:
    """Power of the current before, at a voltage of all phases: no least current is missed."""
    return RATED_KVA * u_pu


def _ceases(region: Region | None) -> bool:
    return region is not None and region.mode in CEASE


def _in_region(region: Region | None, u_pu: float, trip_s: float, statuses: Statuses, **more: Any) -> Record:
    """A trip at a level; where a region wants no current none flows from the start."""
    settings: dict[str, Any] = {"p_sag_kw": _as_before_kw(u_pu), "disconnected_after_s": trip_s} | more
    if _ceases(region):
        settings["flows"] = lambda t: (t < 0.01) * 1.0
    duration_s = trip_s + 0.5
    if duration_s > LONG_S:
        settings["dt_s"] = 0.5 * LONG_STEP_S
    return record(statuses, duration_s=duration_s, scenario={"events": [held(u_pu, duration_s)]}, **settings)


def _regions(table: RegionTable, tolerance: float, nominal_hz: float) -> Iterator[Edge]:
    numbers = ("regions", "envelope_tolerance_pu")
    for row in table.rows:
        low, high = row.voltage_pu
        middle = 0.5 * (low + high)
        if row.mode in STAY_CONNECTED and row.mode != "continuous" and row.ride_through_s(middle) < LONG_S:
            for u in (
                {middle, low + 0.25 * (high - low), high - 0.25 * (high - low)}
                if not isinstance(row.ride_s, float)
                else {middle}
            ):
                time_s = row.ride_through_s(u)
                yield Edge(
                    f"region {low:g} to {high:g} pu: {time_s:g} s at {u:g} pu",
                    ("regions",),
                    _in_region(row, u, time_s + STEP_S, FREE),
                    _in_region(row, u, time_s - STEP_S, FAIL),
                )
        if (row.respond_s is not None and row.voltage_pu[1] < 2) or row.mode in CEASE:
            yield _response(row, min(middle, 1.9))
        if row.mode == "mandatory":
            yield _pause(table, middle)
            if table.least_current_fraction is not None:
                yield _least(table.least_current_fraction.value, middle)
                if table.least_current_settling_s is not None:
                    share, settling_s = table.least_current_fraction.value, table.least_current_settling_s.value
                    yield _least_settled(share, settling_s, 1 / nominal_hz, middle)
    for lower, upper in pairwise(table.rows):
        yield from _border(table, lower, upper, tolerance, numbers)
    if table.cumulative_window_s is not None:
        yield from _cumulative(table, table.cumulative_window_s)


def _response(row: Region, u_pu: float) -> Edge:
    """The current gone just before and just after the time to respond."""
    assert row.respond_s is not None
    lasts_s = row.respond_s + 0.2
    events = {"events": [held(u_pu, lasts_s)]}

    def ceasing(statuses: Statuses, at_s: float) -> Record:
        flows = lambda t: ((t < at_s) | (t > lasts_s)) * 1.0  # noqa: E731
        return record(statuses, duration_s=lasts_s, scenario=events, p_sag_kw=50.0, flows=flows)

    return Edge(
        f"response at {u_pu:g} pu",
        ("regions",),
        ceasing(PASS, row.respond_s - STEP_S),
        ceasing(FAIL, row.respond_s + STEP_S),
        {"recovery_fraction": None, "recovery_time_s": None},
    )


def _pausing(statuses: Statuses, u_pu: float, pause_s: float, lasts_s: float = 0.2) -> Record:
    flows = lambda t: 1.0 - ((t > 0.1) & (t < 0.1 + pause_s))  # noqa: E731
    return record(
        statuses,
        duration_s=lasts_s,
        scenario={"events": [held(u_pu, lasts_s)]},
        p_sag_kw=_as_before_kw(u_pu),
        flows=flows,
    )


def _pause(table: RegionTable, u_pu: float) -> Edge:
    """Current away for a little less and a little more than a cycle (60 Hz), where no share of it has to flow."""
    any_current = table.model_copy(update={"least_current_fraction": None, "least_current_of": None})
    only = {"recovery_fraction": None, "recovery_time_s": None, "regions": any_current}
    cycle_s = 1 / 60
    return Edge(
        f"pause at {u_pu:g} pu",
        ("regions",),
        _pausing(PASS, u_pu, cycle_s - STEP_S),
        _pausing(FAIL, u_pu, cycle_s + STEP_S),
        only,
    )


def _least(fraction: float, u_pu: float) -> Edge:
    """Balanced current a little above and a little below the share of the current before."""

    def feeding(statuses: Statuses, share: float) -> Record:
        power = share * _as_before_kw(u_pu)
        return record(statuses, duration_s=0.3, scenario={"events": [held(u_pu, 0.3)]}, p_sag_kw=power)

    label, numbers = f"least current at {u_pu:g} pu", ("regions.least_current_fraction",)
    only = {"recovery_fraction": None, "recovery_time_s": None}
    return Edge(label, numbers, feeding(PASS, fraction + 0.005), feeding(FAIL, fraction - 0.005), only)


def _least_settled(fraction: float, settling_s: float, cycle_s: float, u_pu: float) -> Edge:
    """A current that comes on just before and just after a share of it is demanded: its amplitude rises in a cycle."""

    def coming(statuses: Statuses, at_s: float) -> Record:
        power = until(at_s, 0.1 * _as_before_kw(u_pu), _as_before_kw(u_pu))
        return record(statuses, duration_s=0.3, scenario={"events": [held(u_pu, 0.3)]}, p_sag_kw=power)

    label, numbers = f"least current settled at {u_pu:g} pu", ("regions.least_current_settling_s",)
    only = {"recovery_fraction": None, "recovery_time_s": None}
    latest_s = settling_s - cycle_s * (fraction - 0.1) / 0.9
    uneven_s = 0.2 * cycle_s  # in part of a cycle the largest of three phases lies up to a sixth above their mean
    return Edge(label, numbers, coming(PASS, latest_s - STEP_S), coming(FAIL, latest_s + uneven_s), only)


def _border(
    table: RegionTable, lower: Region, upper: Region, tolerance: float, numbers: tuple[str, ...]
) -> Iterator[Edge]:
    """The level between two regions: a trip that only the worse of them allows, or a pause."""
    level = lower.voltage_pu[1]
    side = table.side_of(lower) if lower.mode != "continuous" else Side.HIGH
    sign = -1 if side is Side.LOW else 1
    edge = level + sign * tolerance
    worse_u, milder_u = edge + sign * U_PU, edge - sign * U_PU
    worse, milder = (lower, upper) if side is Side.LOW else (upper, lower)
    worse_s = worse.ride_through_s(level)
    milder_s = milder.ride_through_s(level)
    label = f"level {level:g} pu"
    if worse_s != milder_s:
        at_s = worse_s + 0.6 * (min(milder_s, worse_s + 5.0) - worse_s)
        further = None
        if worse_s > LONG_S:  # one record fewer than an edge of its own
            at_s = worse_s + LONG_STEP_S
            further = _in_region(worse, worse_u, worse_s - LONG_STEP_S, FAIL)
        inside, outside = _in_region(worse, worse_u, at_s, FREE), _in_region(milder, milder_u, at_s, FAIL)
        yield Edge(label, numbers, inside, outside, further=further)
    elif "mandatory" in {worse.mode, milder.mode}:
        strict, free = (milder_u, worse_u) if milder.mode == "mandatory" else (worse_u, milder_u)
        yield Edge(label, numbers, _pausing(PASS, free, 0.05), _pausing(FAIL, strict, 0.05))


def _cumulative(table: RegionTable, window_s: float) -> Iterator[Edge]:
    """Two dips of 0.8 of the time; the second just early, and just late enough for the first to have slid away."""
    row = next(r for r in table.rows if r.mode == "mandatory" and isinstance(r.ride_s, float) and r.ride_s > 1)
    u, ride_s = 0.5 * sum(row.voltage_pu), row.ride_through_s(0)
    assert math.isfinite(ride_s)
    assert ride_s != FOR_EVER
    first_s, latest_s = 0.8 * ride_s, window_s - 0.2 * ride_s

    def twice(statuses: Statuses, second_s: float) -> Record:
        points = [*held(u, first_s)["points"], *held(u, ride_s, second_s)["points"]]
        scenario = {"events": [{"kind": "voltage_profile", "points": points}], "after_s": 0.6}
        trip_s = second_s + 0.5 * ride_s
        return record(
            statuses, NO_SAG, second_s + ride_s, scenario, p_sag_kw=_as_before_kw(u), disconnected_after_s=trip_s
        )

    by_s = 2 * SHORT_STEP_S
    yield Edge("times that add up", ("regions",), twice(PASS, latest_s - by_s), twice(FAIL, latest_s + by_s))


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
