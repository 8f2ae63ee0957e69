"""Edges of regions of voltage: what an inverter may do in each, for how long, and where they meet."""

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

from edges.edge import (
    FAIL,
    FREE,
    LEVEL_PU,
    LONG_S,
    NO_SAG,
    PASS,
    RATED_KVA,
    SHORT_STEP_S,
    STEP_S,
    Edge,
    Record,
    Statuses,
    held,
    record,
    until,
)
from pvlvrt_compliance.profile.curves import Side
from pvlvrt_compliance.profile.regions import CEASE, FOR_EVER, STAY_CONNECTED, Region, RegionTable

LONG_STEP_S = 2 / 480
"""Distance in time of records longer than `LONG_S`: two samples of eight a cycle."""


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


def region_edges(table: RegionTable, tolerance: float, nominal_hz: float) -> Iterator[Edge]:
    """Times, responses, pauses and least current of each region, the levels between them, times that add up."""
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
    worse_u, milder_u = edge + sign * LEVEL_PU, edge - sign * LEVEL_PU
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
