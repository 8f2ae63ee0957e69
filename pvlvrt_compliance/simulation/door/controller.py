"""A controller from outside in the loop over time: what it sees first, one sample, and the time before it is judged."""

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.measured import Measured
from pvlvrt_compliance.plant.grid import source_at
from pvlvrt_compliance.plant.plant import PlantParams, PlantState, PlantTables, as_at, observe
from pvlvrt_compliance.plant.protection import NO_TRIP, RelayState
from pvlvrt_compliance.simulation.columns import FOREIGN, FURTHER
from pvlvrt_compliance.simulation.door.call import call, hold, put_commands, put_powers, put_signals, put_slow_task
from pvlvrt_compliance.simulation.door.exchange import COMMANDS, LATEST_CALL
from pvlvrt_compliance.simulation.door.table import DoorTable
from pvlvrt_compliance.simulation.outcome import COMPLETED
from pvlvrt_compliance.simulation.sample import Sample
from pvlvrt_compliance.vectors import Rotation, rotation, turned


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
        blocked=x.blocked,
        mean=x.mean,
    )


@kernel
def synchronised_controller(
    plant: PlantState, m: complex, first: int, p: PlantParams, tables: PlantTables, door: DoorTable, is_new: bool
) -> tuple[int, int]:
    """Let the controller see the steady state that the plant will begin in, turned back in time; nothing moves.

    One that is not new goes on from where it was.

    Returns
    -------
    tuple of int
        How it ended, and the period in which it did: the first one when all is well.
    """
    if not is_new:
        return COMPLETED, first
    timing = door.timing
    T_c = timing.ratio * p.ratio * p.T_S
    t = first * p.ratio * p.T_S
    source = source_at(t, 0, tables.grid)
    now = as_at(t, source.k, p, tables)
    y = observe(plant, m, source, t, now, tables)
    for k in range(max(timing.held, 1)):  # who is never held is told where to begin all the same
        ahead = (timing.held - k) * T_c
        back = rotation(-tables.grid.w[0] * ahead)
        door.progress[LATEST_CALL] = t - ahead
        then, m_then = turned_state(plant, back), turned(m, back)
        seen = Measured(u_g_ab=turned(y.u_ab, back), i_ab=then.i, v_dc=then.v_dc, i_pv=then.i_pv)
        put_powers(door, now.G)
        put_slow_task(door, k)
        put_signals(door.signals, k * timing.sample_time, seen, 0.0, then, m_then, now.G, 0.0)
        put_commands(door.commands, m_then, then.v_dc)
        status = hold(door, k == 0)
        if status == COMPLETED and timing.held > 0:
            status = call(door)
        if status != COMPLETED:
            return status, first - (timing.held - k) * timing.ratio
    return COMPLETED, first


@kernel
def put_sample(door: DoorTable, sample: Sample, plant: PlantState) -> None:
    """Write the signals of a sample in which the controller acts, by its own clock."""
    k = sample.k + door.timing.held
    since = k * door.timing.sample_time
    put_powers(door, sample.G)
    put_slow_task(door, k)
    put_signals(door.signals, since, sample.seen, sample.u_zero, plant, sample.m, sample.G, 1.0)


@kernel
def untripped(x: PlantState, relay: RelayState) -> PlantState:
    """Undo a trip, if there is one, and put the relays at rest: as long as they are not armed."""
    if x.trip == NO_TRIP:
        return x
    return PlantState(
        i=x.i,
        v_dc=x.v_dc,
        x_pv=x.x_pv,
        i_pv=x.i_pv,
        relay=relay,
        trip=NO_TRIP,
        t_trip=0.0,
        closed=True,
        blocked=x.blocked,
        mean=x.mean,
    )


@kernel
def record_foreign(row: NDArray[np.float64], m: complex, commands: NDArray[np.float64]) -> None:
    """Write what is known of the controller, after the plant's channels: its commands, and signals of its own."""
    row[FOREIGN.m_alpha] = m.real
    row[FOREIGN.m_beta] = m.imag
    for k in range(len(COMMANDS), len(commands)):
        row[FURTHER + k - len(COMMANDS)] = commands[k]
