"""Protection relays of the inverter. They see the plant's quantities, never the controller's estimates."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.control.sogi import Rotation, SogiState, in_steady_state, sogi_step
from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.space_vectors import SQRT2_3, SQRT3_2

NO_TRIP, OVERCURRENT, DC_OVERVOLTAGE, UNDERVOLTAGE, FREQUENCY = range(5)
CAUSES = ("none", "overcurrent", "DC overvoltage", "undervoltage", "frequency")
"""Causes of a trip by code."""

_K = math.sqrt(2)  # gain of the relay's own quadrature generator, fixed at the nominal frequency
_FREQUENCY_FILTER = 0.02  # time constant of the relay's frequency measurement (s)


class ProtectionParams(NamedTuple):
    """Settings of the relays."""

    i_max: float  # instantaneous overcurrent, phase peak (A)
    v_dc_max: float  # DC overvoltage (V)
    u_nom: float  # nominal length of the voltage vector (V)
    curve_t: NDArray[np.float64]  # undervoltage curve, instants (s)
    curve_u: NDArray[np.float64]  # undervoltage curve, positive sequence (pu)
    curve_delay: float  # by which the relay trails the curve (s)
    w_nom: float  # nominal angular frequency (rad/s)
    w_min: float  # underfrequency (rad/s)
    w_max: float  # overfrequency (rad/s)
    t_frequency: float  # how long the frequency must be off (s)
    turn: Rotation  # turn at nominal frequency in one plant step


class RelayState(NamedTuple):
    """Memory of the relays."""

    cell: SogiState  # quadrature generator on the PCC voltage (V)
    w: float  # filtered frequency (rad/s)
    t_low: float  # time since V+ fell below the curve's upper level (s)
    t_off: float  # time since the frequency left its band (s)


def relays_at_rest(u_pos: complex, w: float) -> RelayState:
    """Relays that have long seen this positive sequence (V) at this frequency (rad/s)."""
    return RelayState(cell=in_steady_state(u_pos), w=w, t_low=0.0, t_off=0.0)


@kernel
def exceeds(i: complex, i_max: float) -> bool:
    """Whether the current of any phase is beyond a limit (A), from the current vector (A)."""
    if SQRT2_3 * abs(i) <= i_max:  # no phase can be larger than the vector
        return False
    along, across = -0.5 * i.real, SQRT3_2 * i.imag
    return SQRT2_3 * max(abs(i.real), abs(along + across), abs(along - across)) > i_max


@kernel
def curve_at(t: float, p: ProtectionParams) -> float:
    """Undervoltage curve at a time (pu): straight lines, held before and after."""
    n = len(p.curve_t)
    if t <= p.curve_t[0]:
        return p.curve_u[0]
    for k in range(1, n):
        if t < p.curve_t[k]:
            share = (t - p.curve_t[k - 1]) / (p.curve_t[k] - p.curve_t[k - 1])
            return p.curve_u[k - 1] + share * (p.curve_u[k] - p.curve_u[k - 1])
    return p.curve_u[n - 1]


@kernel
def relays_step(
    x: RelayState, u: complex, i: complex, v_dc: float, p: ProtectionParams, T_S: float
) -> tuple[RelayState, int]:
    """Advance the relays by one plant step; return their state and the code of a trip, or 0.

    The frequency is how fast the positive sequence turns: with u+ = (u' + j qu')/2 of a generator at w_nom,
    du+/dt = j w_nom u+ + w_nom K e / 2.
    """
    e = u - x.cell.u
    u_pos = 0.5 * (x.cell.u + 1j * x.cell.qu)
    square = u_pos.real**2 + u_pos.imag**2
    V_pos = math.sqrt(square) / p.u_nom
    floor = max(square, 1e-4 * p.u_nom**2)
    w_now = p.w_nom * (1 + 0.5 * _K * (u_pos.real * e.imag - u_pos.imag * e.real) / floor)
    w = x.w + T_S / _FREQUENCY_FILTER * (w_now - x.w)
    low = V_pos < p.curve_u[len(p.curve_u) - 1]
    t_low = x.t_low + T_S if low else 0.0
    off = not low and (w < p.w_min or w > p.w_max)
    t_off = x.t_off + T_S if off else 0.0
    after = RelayState(cell=sogi_step(x.cell, _K * e, p.turn), w=w, t_low=t_low, t_off=t_off)
    if exceeds(i, p.i_max):
        return after, OVERCURRENT
    if v_dc > p.v_dc_max:
        return after, DC_OVERVOLTAGE
    if low and V_pos < curve_at(t_low - p.curve_delay, p):
        return after, UNDERVOLTAGE
    if t_off >= p.t_frequency:
        return after, FREQUENCY
    return after, NO_TRIP
