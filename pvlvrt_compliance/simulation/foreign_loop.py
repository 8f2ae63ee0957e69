"""The loop over time with a controller from outside, called by address once in so many periods of the plant.

What plant, sensors and recorder do is that of `loop`; only the controller is somebody else's.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.control.controller import Measured
from pvlvrt_compliance.control.delays import DelayLines, acting, put
from pvlvrt_compliance.control.hardware import Hardware, read
from pvlvrt_compliance.kernel import cached_kernel, kernel
from pvlvrt_compliance.plant.grid import source_at
from pvlvrt_compliance.plant.plant import (
    Observed,
    PlantParams,
    PlantState,
    PlantTables,
    advance,
    as_at,
    observe,
)
from pvlvrt_compliance.plant.protection import NO_TRIP, RelayState
from pvlvrt_compliance.simulation.exchange import (
    COMMANDS,
    IGNORED,
    LATEST_CALL,
    DoorTable,
    call,
    call_or_ignore,
    commanded,
    hold,
    put_commands,
    put_signals,
)
from pvlvrt_compliance.simulation.loop import COMPLETED, NOT_FINITE, PLANT_CHANNELS, Outcome, record_plant
from pvlvrt_compliance.simulation.recorder import RecordingPlan, next_row
from pvlvrt_compliance.vectors import Rotation, rotation, turned

RECORDED = (*PLANT_CHANNELS, "m_alpha", "m_beta")
"""Channels of every record; signals of the controller's own follow."""


class Timing(NamedTuple):
    """When things happen. A period is the plant's, of ``ratio`` plant steps, as in a record."""

    first: int  # period in which the controller begins to act (negative: unrecorded settling)
    armed: int  # period from which the relays trip
    ratio: int  # periods from one call of the controller to the next
    held: int  # calls before the first period, in which the controller sees the steady state
    sample_time: float  # as the controller has it: what its clock goes by (s)


@kernel
def seen_at(n: int, plant: PlantState, y: Observed, hardware: Hardware | None) -> Measured:
    """What sensors make of the plant at call ``n``."""
    seen = Measured(u_g_ab=y.u_ab, i_ab=plant.i, v_dc=plant.v_dc, i_pv=plant.i_pv)
    if hardware is None:
        return seen
    return read(seen, y.u_zero, n, 0, hardware)


@kernel
def untripped(x: PlantState, relay: RelayState) -> PlantState:
    """Undo a trip."""
    return PlantState(
        i=x.i,
        v_dc=x.v_dc,
        x_pv=x.x_pv,
        i_pv=x.i_pv,
        relay=relay,
        trip=NO_TRIP,
        t_trip=0.0,
        closed=True,
        mean=x.mean,
    )


@kernel
def is_finite_plant(x: PlantState, m: complex) -> bool:
    """Whether every number that the next sample depends on is one: a sum is finite only if all its terms are."""
    return math.isfinite(x.v_dc + x.i.real + x.i.imag + x.i_pv + m.real + m.imag)


@kernel
def record_foreign(row: NDArray[np.float64], m: complex, commands: NDArray[np.float64]) -> None:
    """Write what is known of the controller, after the plant's channels."""
    n = len(PLANT_CHANNELS)
    row[n], row[n + 1] = m.real, m.imag
    for k in range(len(COMMANDS), len(commands)):
        row[n + 2 + k - len(COMMANDS)] = commands[k]


@kernel
def turned_state(x: PlantState, by: Rotation) -> PlantState:
    """State with its current at another angle; relays and means stay."""
    return PlantState(
        i=turned(x.i, by),
        v_dc=x.v_dc,
        x_pv=x.x_pv,
        i_pv=x.i_pv,
        relay=x.relay,
        trip=x.trip,
        t_trip=x.t_trip,
        closed=x.closed,
        mean=x.mean,
    )


@kernel
def synchronised_controller(
    plant: PlantState,
    m: complex,
    timing: Timing,
    p: PlantParams,
    tables: PlantTables,
    door: DoorTable,
    progress: NDArray[np.float64],
) -> tuple[int, int, int]:
    """Let the controller see the steady state that the plant will begin in, turned back in time; nothing moves.

    Returns
    -------
    tuple of int
        How it ended, the period in which it did, and the entry of the grid's breakpoints as the plant begins.
    """
    T_c = timing.ratio * p.ratio * p.T_S
    t = timing.first * p.ratio * p.T_S
    source = source_at(t, 0, tables.grid)
    now = as_at(t, source.k, p, tables)
    y = observe(plant, m, source, t, now, tables)
    for k in range(max(timing.held, 1)):  # who is never held is told where to begin all the same
        ahead = (timing.held - k) * T_c
        back = rotation(-tables.grid.w[0] * ahead)
        progress[LATEST_CALL] = t - ahead
        then, m_then = turned_state(plant, back), turned(m, back)
        seen = Measured(u_g_ab=turned(y.u_ab, back), i_ab=then.i, v_dc=then.v_dc, i_pv=then.i_pv)
        put_signals(door.signals, k * timing.sample_time, seen, 0.0, then, m_then, now.G, 0.0)
        put_commands(door.commands, m_then, then.v_dc)
        status = hold(door, k == 0)
        if status == COMPLETED and timing.held > 0:
            status = call(door)
        if status != COMPLETED:
            return status, timing.first - (timing.held - k) * timing.ratio, source.k
    return COMPLETED, timing.first, source.k


@cached_kernel
def run_foreign(
    plant: PlantState,
    m: complex,
    timing: Timing,
    plant_params: PlantParams,
    tables: PlantTables,
    hardware: Hardware | None,
    lines: DelayLines,
    door: DoorTable,
    plan: RecordingPlan,
    samples: NDArray[np.float64],
    progress: NDArray[np.float64],
) -> Outcome:
    """Simulate from the first period to the end of the plan.

    First the controller sees the steady state that the plant is in, turned back in time, and its commands do not act.
    Then it samples at the beginning of every ``ratio``-th period; its command acts as many of its own sample times
    later as the delay lines are long, and is held in between. After a trip what it commands is ignored, whatever it is.

    Parameters
    ----------
    plant, m : PlantState, complex
        State at the beginning of the first period, and what modulates then.
    hardware : Hardware or None
        Sensors, if they are not ideal. Its delay of the modulating signal is not used.
    lines : DelayLines
        Delay of the modulating signal.
    samples : array, shape (n, len(RECORDED) + further signals)
        Filled with the record, a row for every period of the plan.
    progress : array, shape (`exchange.PROGRESSES`,)
        Not a number at first; kept at the instant (s) of the latest call, and at what `exchange.call_or_ignore` says of
        a trip.

    Returns
    -------
    Outcome
        ``periods`` is the period in which the run ended.
    """
    T = plant_params.ratio * plant_params.T_S
    status, period, k_grid = synchronised_controller(plant, m, timing, plant_params, tables, door, progress)
    if status != COMPLETED:
        return Outcome(status=status, periods=period, plant=plant)
    relay, latest = plant.relay, m
    row, stretch, due = 0, 0, plan.first[0]
    calls = 0
    for n in range(timing.first, plan.first[-1]):
        t = n * T
        source = source_at(t, k_grid, tables.grid)
        k_grid = source.k
        called = (n - timing.first) % timing.ratio == 0
        if called:
            m = acting(lines, calls)
        now = as_at(t, k_grid, plant_params, tables)
        y = observe(plant, m, source, t, now, tables)
        if called:
            seen = seen_at(calls, plant, y, hardware)
            since = (calls + timing.held) * timing.sample_time
            put_signals(door.signals, since, seen, y.u_zero, plant, m, now.G, 1.0)
            status = call_or_ignore(door, t, plant.trip != NO_TRIP, progress)
            if status == COMPLETED:
                latest = commanded(door, seen.v_dc)
            elif status != IGNORED:
                return Outcome(status=status, periods=n, plant=plant)
        if not is_finite_plant(plant, latest):
            return Outcome(status=NOT_FINITE, periods=n, plant=plant)
        if n == due:
            record_plant(samples[row], plant, y, now.G)
            record_foreign(samples[row], latest, door.commands)
            row += 1
            stretch, due = next_row(stretch, n, plan)
        if called:
            put(lines, calls, latest)
            m = acting(lines, calls)
            calls += 1
        plant = advance(plant, m, source, t, now, tables)
        if n < timing.armed and plant.trip != NO_TRIP:
            plant = untripped(plant, relay)
    return Outcome(status=COMPLETED, periods=plan.first[-1], plant=plant)
