"""What passes between the loop and a controller from outside, by name: signals, commands, and what is told of a run."""

from typing import NamedTuple

from pvlvrt_compliance.places import PhasePlaces, numbered


class ChangingSignals(NamedTuple):
    """What a controller can be given that the loop writes before every call."""

    time_s: int
    u_a_v: int
    u_b_v: int
    u_c_v: int
    i_a_a: int
    i_b_a: int
    i_c_a: int
    v_dc_v: int
    i_dc_a: int
    i_pv_a: int
    m_a: int
    m_b: int
    m_c: int
    enabled: int
    connected: int
    irradiance_w_m2: int
    p_set_w: int


class FixedSignals(NamedTuple):
    """What it can be given that stays as it is in a run."""

    q_set_var: int
    frequency_nominal_hz: int
    apparent_power_nominal_va: int
    voltage_nominal_v: int


class LaterSignals(NamedTuple):
    """What came later and stands behind all others: what a class is told by their order stays. The first two change."""

    p_available_w: int
    slow_task_due: int
    v_dc_nominal_v: int
    filter_inductance_h: int
    filter_resistance_ohm: int
    dc_link_capacitance_f: int


class Commands(NamedTuple):
    """What it can command: u_inv = m v_DC / 2, phase to the middle of the link, or that voltage itself (V); switches.

    The voltage by phase, or in a frame: u_a = u_d cos(angle) - u_q sin(angle), phases b and c a third of a turn behind.
    Switches are on from 0.5: open the breaker; turn no device on; go on after having turned none on.
    """

    m_a: int
    m_b: int
    m_c: int
    u_a_ref_v: int
    u_b_ref_v: int
    u_c_ref_v: int
    trip: int
    block: int
    restart: int
    u_d_ref_v: int
    u_q_ref_v: int
    angle_rad: int


SIGNAL = numbered(ChangingSignals)
FIXED = numbered(FixedSignals, len(SIGNAL))
LATER = numbered(LaterSignals, len(SIGNAL) + len(FIXED))
COMMAND = numbered(Commands)

SIGNALS = (*ChangingSignals._fields, *FixedSignals._fields, *LaterSignals._fields)
"""What a controller can be given, in the order of the signals that its input ports are mapped to."""

COMMANDS = Commands._fields
"""What it can command, in the order that its output ports are mapped to."""

SEEN_U = PhasePlaces(SIGNAL.u_a_v, SIGNAL.u_b_v, SIGNAL.u_c_v)
SEEN_I = PhasePlaces(SIGNAL.i_a_a, SIGNAL.i_b_a, SIGNAL.i_c_a)
ACTING_M = PhasePlaces(SIGNAL.m_a, SIGNAL.m_b, SIGNAL.m_c)
"""Signals of three phases."""

COMMANDED_M = PhasePlaces(COMMAND.m_a, COMMAND.m_b, COMMAND.m_c)
COMMANDED_U = PhasePlaces(COMMAND.u_a_ref_v, COMMAND.u_b_ref_v, COMMAND.u_c_ref_v)
"""The two kinds of voltages that are commanded."""

SWITCHES = ("trip", "block", "restart")
"""Commands besides those: who gives none of them never trips and never blocks."""

ON = 0.5
"""From which on a switch is on: halfway between 0 and 1."""

LARGEST = {"m_a": 10.0, "u_a_ref_v": 1e5}
"""Largest command of either kind that is taken for one (-, V)."""

RAREST = 1_000_000
"""Samples from one run of a slow task to the next at most, chosen: of 10 us, ten seconds."""

LATEST_CALL, TRIP_SEEN, IGNORED_AT, IGNORED_STATUS = range(4)
"""What a run tells of its progress: instants (s) of the latest call, of the first after a trip, and of the first fault
of the controller after it, with how that would have ended the run."""

PROGRESSES = len((LATEST_CALL, TRIP_SEEN, IGNORED_AT, IGNORED_STATUS))
"""Numbers of it."""
