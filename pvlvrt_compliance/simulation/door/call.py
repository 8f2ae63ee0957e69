"""One call of a controller from outside: hand over signals, let it work, take its commands."""

import math

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.measured import Measured
from pvlvrt_compliance.plant.inverter import K_PWM, limit_modulation
from pvlvrt_compliance.plant.plant import PlantState, dc_current
from pvlvrt_compliance.simulation.columns import phases_at, put_phases
from pvlvrt_compliance.simulation.door.exchange import (
    ACTING_M,
    COMMAND,
    COMMANDED_M,
    COMMANDED_U,
    COMMANDS,
    FIXED,
    IGNORED_AT,
    IGNORED_STATUS,
    LARGEST,
    LATER,
    LATEST_CALL,
    ON,
    SEEN_I,
    SEEN_U,
    SIGNAL,
    TRIP_SEEN,
)
from pvlvrt_compliance.simulation.door.native_call import call_address
from pvlvrt_compliance.simulation.door.ports import PortTable, gather, scatter
from pvlvrt_compliance.simulation.door.table import HELD_EACH, RUNS_FREE, DoorTable
from pvlvrt_compliance.simulation.outcome import (
    COMPLETED,
    CONTROLLER_FAILED,
    OUTPUT_NOT_FINITE,
    OUTPUT_OUT_OF_RANGE,
)
from pvlvrt_compliance.space_vectors import SQRT2_3
from pvlvrt_compliance.vectors import Phases, length, rotation, scaled, turned, vector_of

IGNORED = -1
"""No end of a run: a call after a trip that gave no command, or was not made."""

MESSAGE = 1
"""What a controller's function returns that has something to say."""

_M_MOST, _U_MOST = LARGEST["m_a"], LARGEST["u_a_ref_v"]
_PER_HALF_LINK = 0.5 / K_PWM  # modulating signal of the paper per one of half the link's voltage


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
    """Write what changes with time; the sensors have no part in the bridge's current."""
    x[SIGNAL.time_s] = t
    put_phases(x, SEEN_U, seen.u_g_ab, u_zero)
    put_phases(x, SEEN_I, seen.i_ab, 0.0)
    x[SIGNAL.v_dc_v] = seen.v_dc
    x[SIGNAL.i_dc_a] = dc_current(plant, m)
    x[SIGNAL.i_pv_a] = seen.i_pv
    put_phases(x, ACTING_M, scaled(1 / _PER_HALF_LINK, m), 0.0)
    x[SIGNAL.enabled] = enabled
    x[SIGNAL.connected] = 1.0 if plant.closed else 0.0
    x[SIGNAL.irradiance_w_m2] = 1000.0 * G


@kernel
def put_powers(door: DoorTable, G: float) -> None:
    """Write the active power that there is at an irradiance, and that is asked for: all of it, at most the nominal."""
    low, high, last = door.irradiance[0], door.irradiance[1], len(door.available) - 1
    place = last * (G - low) / (high - low) if high > low else 0.0
    k = min(max(int(place), 0), max(last - 1, 0))
    before, after = door.available[k], door.available[min(k + 1, last)]
    p = before + (place - k) * (after - before)
    door.signals[LATER.p_available_w] = p
    door.signals[SIGNAL.p_set_w] = min(p, door.signals[FIXED.apparent_power_nominal_va])


@kernel
def put_slow_task(door: DoorTable, k: int) -> None:
    """Write whether the slow task is due in sample ``k`` of all that the controller sees, from 0."""
    door.signals[LATER.slow_task_due] = 1.0 if k % door.timing.every == 0 else 0.0


@kernel
def put_commands(x: NDArray[np.float64], m: complex, v_dc: float) -> None:
    """Write the commands that a modulating signal stands for, of a bridge that is neither tripped nor blocked."""
    put_phases(x, COMMANDED_M, scaled(1 / _PER_HALF_LINK, m), 0.0)
    put_phases(x, COMMANDED_U, scaled(K_PWM * v_dc, m), 0.0)
    x[COMMAND.u_d_ref_v], x[COMMAND.u_q_ref_v] = SQRT2_3 * K_PWM * v_dc * length(m), 0.0
    x[COMMAND.angle_rad] = math.atan2(m.imag, m.real)
    x[COMMAND.trip], x[COMMAND.block], x[COMMAND.restart] = 0.0, 0.0, 0.0


@kernel
def out_of_the_frame(x: NDArray[np.float64]) -> complex:
    """Voltage vector (V) of what is commanded in a frame, as amplitudes of the phases."""
    u = scaled(1 / SQRT2_3, complex(x[COMMAND.u_d_ref_v], x[COMMAND.u_q_ref_v]))
    return turned(u, rotation(x[COMMAND.angle_rad]))


@kernel
def fault_of(commands: Phases, most: float) -> int:
    """What is wrong with the commands of three phases, or `COMPLETED`."""
    for command in (commands.a, commands.b, commands.c):
        if not math.isfinite(command):
            return OUTPUT_NOT_FINITE
        if abs(command) > most:
            return OUTPUT_OUT_OF_RANGE
    return COMPLETED


@kernel
def is_well(door: DoorTable, address: int) -> bool:
    """Call a function of the controller, and have what it says noted; whether all is well."""
    answer = call_address(address, door.argument)
    if answer == MESSAGE and door.note_address != 0:
        answer = call_address(door.note_address, door.argument)
    well: bool = answer == 0
    return well


@kernel
def call(door: DoorTable) -> int:
    """Hand over the signals, let the controller work, take its commands."""
    gather(door.signals, door.inputs)
    if not is_well(door, door.address):
        return CONTROLLER_FAILED
    scatter(door.outputs, door.commands)
    if door.in_a_frame:
        put_phases(door.commands, COMMANDED_U, out_of_the_frame(door.commands), 0.0)
    x = door.commands
    if not math.isfinite(x[COMMAND.trip] + x[COMMAND.block] + x[COMMAND.restart]):
        return OUTPUT_NOT_FINITE
    # A bridge that is blocked takes no voltage, however far regulators have wound up.
    if door.in_volts:
        return fault_of(phases_at(x, COMMANDED_U), _U_MOST if x[COMMAND.block] < ON else math.inf)
    return fault_of(phases_at(x, COMMANDED_M), _M_MOST if x[COMMAND.block] < ON else math.inf)


@kernel
def call_or_ignore(door: DoorTable, t: float, is_tripped: bool) -> int:
    """Let the controller work at an instant (s). After a trip none of its faults counts, and the first ends the calls.

    Commands are out of the plant's reach then: the bridge is blocked. A controller that is still called sees that it
    is no longer connected, and its further signals are recorded; only one that has failed is left alone.

    Returns
    -------
    int
        How the run goes on: `COMPLETED`; after a trip also `IGNORED`, with no command to take.
    """
    progress = door.progress
    progress[LATEST_CALL] = t
    if not is_tripped:
        return call(door)
    if math.isnan(progress[TRIP_SEEN]):
        progress[TRIP_SEEN] = t
    if not door.after_trip or progress[IGNORED_STATUS] == CONTROLLER_FAILED:
        return IGNORED
    status = call(door)
    if status == COMPLETED:
        return COMPLETED
    if math.isnan(progress[IGNORED_AT]) or status == CONTROLLER_FAILED:
        progress[IGNORED_AT], progress[IGNORED_STATUS] = t, float(status)
    return IGNORED


@kernel
def hold(door: DoorTable, first: bool) -> int:
    """Tell a controller that it does not act yet, as often as it is told: outputs are set to what acts in its place.

    One that runs free is initialised all the same, but its outputs stay as they are.
    """
    if not first and door.timing.hold != HELD_EACH:
        return COMPLETED
    if door.timing.hold != RUNS_FREE:
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
    if door.in_volts:
        m = scaled(1 / (K_PWM * max(v_dc, 1.0)), vector_of(phases_at(door.commands, COMMANDED_U)))
    else:
        m = scaled(_PER_HALF_LINK, vector_of(phases_at(door.commands, COMMANDED_M)))
    return limit_modulation(m)
