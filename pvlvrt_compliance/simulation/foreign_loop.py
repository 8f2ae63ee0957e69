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
from pvlvrt_compliance.plant.inverter import K_PWM, limit_modulation
from pvlvrt_compliance.plant.plant import (
    Observed,
    PlantParams,
    PlantState,
    PlantTables,
    advance,
    as_at,
    bridge,
    observe,
)
from pvlvrt_compliance.plant.protection import NO_TRIP, RelayState
from pvlvrt_compliance.simulation.loop import COMPLETED, NOT_FINITE, PLANT_CHANNELS, Outcome, record_plant
from pvlvrt_compliance.simulation.native_call import call_address
from pvlvrt_compliance.simulation.ports import PortTable, gather, scatter
from pvlvrt_compliance.simulation.recorder import RecordingPlan, next_row
from pvlvrt_compliance.vectors import Phases, Rotation, phases_of, rotation, scaled, turned, vector_of

CONTROLLER_FAILED, OUTPUT_NOT_FINITE, OUTPUT_OUT_OF_RANGE = range(2, 5)
"""How a run ended, besides what `loop` has."""

SIGNALS = (
    *("time_s", "u_a_v", "u_b_v", "u_c_v", "i_a_a", "i_b_a", "i_c_a", "v_dc_v", "i_dc_a", "i_pv_a"),
    *("m_a", "m_b", "m_c", "enabled", "connected", "irradiance_w_m2"),
    *("p_set_w", "q_set_var", "frequency_nominal_hz", "apparent_power_nominal_va", "voltage_nominal_v"),
)
"""What a controller can be given, in the order of the signals that its input ports are mapped to.

The loop writes those up to ``irradiance_w_m2``; the rest stays as it is given.
"""

_MESSAGE = 1  # what a controller's function returns that has something to say

COMMANDS = ("m_a", "m_b", "m_c", "u_a_ref_v", "u_b_ref_v", "u_c_ref_v")
"""What it can command: u_inv = m v_DC / 2, phase to the middle of the link, or that voltage itself (V)."""

RECORDED = (*PLANT_CHANNELS, "m_alpha", "m_beta")
"""Channels of every record; signals of the controller's own follow."""

LARGEST = {"m_a": 10.0, "u_a_ref_v": 1e5}
"""Largest command of either kind that is taken for one (-, V)."""

_M_MOST, _U_MOST = LARGEST["m_a"], LARGEST["u_a_ref_v"]
_PER_HALF_LINK = 0.5 / K_PWM  # modulating signal of the paper per one of half the link's voltage


class Timing(NamedTuple):
    """When things happen. A period is the plant's, of ``ratio`` plant steps, as in a record."""

    first: int  # period in which the controller begins to act (negative: unrecorded settling)
    armed: int  # period from which the relays trip
    ratio: int  # periods from one call of the controller to the next
    held: int  # calls before the first period, in which the controller sees the steady state
    sample_time: float  # as the controller has it: what its clock goes by (s)


class DoorTable(NamedTuple):
    """Addresses and memory of an open door."""

    address: int  # of the function that advances the controller by one sample
    first_address: int  # of one called before all others; 0: none
    hold_address: int  # of one called before it as long as the controller does not act yet; 0: none
    note_address: int  # of one called after any has returned `_MESSAGE`; 0: that is a failure
    argument: int  # address that all are called with
    inputs: PortTable  # from `SIGNALS`
    outputs: PortTable  # to `COMMANDS`, and further signals to record
    in_volts: bool  # whether voltages are commanded
    signals: NDArray[np.float64]  # shape (len(SIGNALS),)
    commands: NDArray[np.float64]  # shape (len(COMMANDS) + further signals,)


@kernel
def put_phases(x: NDArray[np.float64], k: int, ab: complex, zero: float) -> None:
    """Write the phases of a vector from an index on."""
    phases = phases_of(ab)
    x[k], x[k + 1], x[k + 2] = phases.a + zero, phases.b + zero, phases.c + zero


@kernel
def put_signals(
    x: NDArray[np.float64],
    t: float,
    seen: Measured,
    u_zero: float,
    plant: PlantState,
    m: complex,
    G: float,
    enabled: float,
) -> None:
    """Write what changes with time, in the order of `SIGNALS`; the sensors have no part in the bridge's current."""
    x[0] = t
    put_phases(x, 1, seen.u_g_ab, u_zero)
    put_phases(x, 4, seen.i_ab, 0.0)
    i_dc = bridge(limit_modulation(m), plant.i, plant.v_dc, plant.trip != NO_TRIP).i_dc
    x[7], x[8], x[9] = seen.v_dc, i_dc, seen.i_pv
    put_phases(x, 10, scaled(1 / _PER_HALF_LINK, m), 0.0)
    x[13], x[14], x[15] = enabled, 1.0 if plant.closed else 0.0, 1000.0 * G


@kernel
def seen_at(n: int, plant: PlantState, y: Observed, hardware: Hardware | None) -> Measured:
    """What sensors make of the plant at call ``n``."""
    seen = Measured(u_g_ab=y.u_ab, i_ab=plant.i, v_dc=plant.v_dc, i_pv=plant.i_pv)
    if hardware is None:
        return seen
    return read(seen, y.u_zero, n, 0, hardware)


@kernel
def put_commands(x: NDArray[np.float64], m: complex, v_dc: float) -> None:
    """Write the commands that a modulating signal stands for."""
    put_phases(x, 0, scaled(1 / _PER_HALF_LINK, m), 0.0)
    put_phases(x, 3, scaled(K_PWM * v_dc, m), 0.0)


@kernel
def fault_of(commands: NDArray[np.float64], in_volts: bool) -> int:
    """What is wrong with the commands, or `COMPLETED`."""
    begin, most = (3, _U_MOST) if in_volts else (0, _M_MOST)
    for k in range(begin, begin + 3):
        if not math.isfinite(commands[k]):
            return OUTPUT_NOT_FINITE
        if abs(commands[k]) > most:
            return OUTPUT_OUT_OF_RANGE
    return COMPLETED


@kernel
def is_well(door: DoorTable, address: int) -> bool:
    """Call a function of the controller, and have what it says noted; whether all is well."""
    answer = call_address(address, door.argument)
    if answer == _MESSAGE and door.note_address != 0:
        answer = call_address(door.note_address, door.argument)
    return answer == 0


@kernel
def call(door: DoorTable) -> int:
    """Hand over the signals, let the controller work, take its commands."""
    gather(door.signals, door.inputs)
    if not is_well(door, door.address):
        return CONTROLLER_FAILED
    scatter(door.outputs, door.commands)
    return fault_of(door.commands, door.in_volts)


@kernel
def hold(door: DoorTable, first: bool) -> int:
    """Tell a controller that it does not act yet: its outputs are set to what acts in its place."""
    gather(door.commands[: len(COMMANDS)], held_part(door.outputs))
    gather(door.signals, door.inputs)
    if first and door.first_address != 0 and not is_well(door, door.first_address):
        return CONTROLLER_FAILED
    if door.hold_address != 0 and not is_well(door, door.hold_address):
        return CONTROLLER_FAILED
    return COMPLETED


@kernel
def held_part(outputs: PortTable) -> PortTable:
    """Outputs that command; those that are only recorded come after them."""
    n = 0
    while n < len(outputs.signal) and outputs.signal[n] < len(COMMANDS):
        n += 1
    return PortTable(
        memory=outputs.memory,
        kind=outputs.kind[:n],
        place=outputs.place[:n],
        signal=outputs.signal[:n],
        gain=outputs.gain[:n],
        offset=outputs.offset[:n],
    )


@kernel
def commanded(door: DoorTable, v_dc: float) -> complex:
    """Modulating signal of the paper, within the linear range; voltages go by the link's voltage (V) as sampled."""
    c = door.commands
    if door.in_volts:
        m = scaled(1 / (K_PWM * max(v_dc, 1.0)), vector_of(Phases(a=c[3], b=c[4], c=c[5])))
    else:
        m = scaled(_PER_HALF_LINK, vector_of(Phases(a=c[0], b=c[1], c=c[2])))
    return limit_modulation(m)


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
        progress[0] = t - ahead
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
    later as the delay lines are long, and is held in between.

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
    progress : array, shape (1,)
        Kept at the instant (s) of the latest call.

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
            progress[0] = t
            seen = seen_at(calls, plant, y, hardware)
            since = (calls + timing.held) * timing.sample_time
            put_signals(door.signals, since, seen, y.u_zero, plant, m, now.G, 1.0)
            status = call(door)
            if status != COMPLETED:
                return Outcome(status=status, periods=n, plant=plant)
            latest = commanded(door, seen.v_dc)
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
