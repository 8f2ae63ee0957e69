"""What passes between the loop and a controller from outside: signals, commands, and the call itself."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.control.controller import Measured
from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.plant.inverter import K_PWM, limit_modulation
from pvlvrt_compliance.plant.plant import PlantState, bridge
from pvlvrt_compliance.plant.protection import NO_TRIP
from pvlvrt_compliance.simulation.loop import COMPLETED
from pvlvrt_compliance.simulation.native_call import call_address
from pvlvrt_compliance.simulation.ports import PortTable, gather, scatter
from pvlvrt_compliance.vectors import Phases, phases_of, scaled, vector_of

CONTROLLER_FAILED, OUTPUT_NOT_FINITE, OUTPUT_OUT_OF_RANGE = range(2, 5)
"""How a run ended, besides what `loop` has."""

IGNORED = 5
"""No end of a run: a call after a trip that gave no command, or was not made."""

SIGNALS = (
    *("time_s", "u_a_v", "u_b_v", "u_c_v", "i_a_a", "i_b_a", "i_c_a", "v_dc_v", "i_dc_a", "i_pv_a"),
    *("m_a", "m_b", "m_c", "enabled", "connected", "irradiance_w_m2"),
    *("p_set_w", "q_set_var", "frequency_nominal_hz", "apparent_power_nominal_va", "voltage_nominal_v"),
)
"""What a controller can be given, in the order of the signals that its input ports are mapped to.

The loop writes those up to ``irradiance_w_m2``; the rest stays as it is given.
"""

LATEST_CALL, TRIP_SEEN, IGNORED_AT, IGNORED_STATUS = range(4)
"""What a run tells of its progress: instants (s) of the latest call, of the first after a trip, and of the first fault
of the controller after it, with how that would have ended the run."""

PROGRESSES = 4
"""Numbers of it."""

_MESSAGE = 1  # what a controller's function returns that has something to say

COMMANDS = ("m_a", "m_b", "m_c", "u_a_ref_v", "u_b_ref_v", "u_c_ref_v")
"""What it can command: u_inv = m v_DC / 2, phase to the middle of the link, or that voltage itself (V)."""

LARGEST = {"m_a": 10.0, "u_a_ref_v": 1e5}
"""Largest command of either kind that is taken for one (-, V)."""

_M_MOST, _U_MOST = LARGEST["m_a"], LARGEST["u_a_ref_v"]
_PER_HALF_LINK = 0.5 / K_PWM  # modulating signal of the paper per one of half the link's voltage


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
    after_trip: bool  # whether it is called after a trip, too: one whose process ends then is not
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
    well: bool = answer == 0
    return well


@kernel
def call(door: DoorTable) -> int:
    """Hand over the signals, let the controller work, take its commands."""
    gather(door.signals, door.inputs)
    if not is_well(door, door.address):
        return CONTROLLER_FAILED
    scatter(door.outputs, door.commands)
    return fault_of(door.commands, door.in_volts)


@kernel
def call_or_ignore(door: DoorTable, t: float, is_tripped: bool, progress: NDArray[np.float64]) -> int:
    """Let the controller work at an instant (s). After a trip none of its faults counts, and the first ends the calls.

    Commands are out of the plant's reach then: the bridge is blocked. A controller that is still called sees that it
    is no longer connected, and its further signals are recorded; only one that has failed is left alone.

    Returns
    -------
    int
        How the run goes on: `COMPLETED`; after a trip also `IGNORED`, with no command to take.
    """
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
