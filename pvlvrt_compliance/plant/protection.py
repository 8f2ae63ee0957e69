"""Protection relays of the inverter. They see the plant's quantities, never the controller's estimates."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.sogi import SogiState, in_steady_state, sequences, sogi_step
from pvlvrt_compliance.space_vectors import SQRT2_3, SQRT3_2
from pvlvrt_compliance.vectors import Rotation, scaled

NO_TRIP, OVERCURRENT, DC_OVERVOLTAGE, UNDERVOLTAGE, FREQUENCY, BY_CONTROLLER = range(6)
"""Causes of a trip by code; `waveforms.trip_causes` has them in words."""

_K = math.sqrt(2)  # gain of the relay's own quadrature generator, fixed at the nominal frequency
_SMALL = 1e-4  # square of the positive sequence below which its turning is not measured any more (pu)
_FREQUENCY_FILTER = 0.02  # time constant of the relay's frequency measurement (s)


class ProtectionParams(NamedTuple):
    """Settings of the relays."""

    i_max: float  # instantaneous overcurrent, phase peak (A)
    v_dc_max: float  # DC overvoltage (V)
    u_nom: float  # nominal length of the voltage vector (V)
    u_low: float  # the time of a sag counts below it: the curve's last level (pu)
    curve_delay: float  # by which the relay trails the curve (s)
    w_nom: float  # nominal angular frequency (rad/s)
    w_min: float  # underfrequency (rad/s)
    w_max: float  # overfrequency (rad/s)
    t_frequency: float  # how long the frequency must be off (s)
    turn: Rotation  # turn at nominal frequency in one plant step


class UndervoltageCurve(NamedTuple):
    """Lowest positive-sequence voltage that is ridden through, by the time since it fell: straight lines."""

    t: NDArray[np.float64]  # instants (s)
    u: NDArray[np.float64]  # positive sequence (pu)


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
    if SQRT2_3**2 * (i.real**2 + i.imag**2) <= i_max**2:  # no phase can be larger than the vector
        return False
    along, across = -0.5 * i.real, SQRT3_2 * i.imag
    return SQRT2_3 * max(abs(i.real), abs(along + across), abs(along - across)) > i_max


@kernel
def undervoltage_limit(x: RelayState, p: ProtectionParams, curve: UndervoltageCurve) -> float:
    """Positive-sequence voltage (pu) below which the relay trips now: the curve as of ``curve_delay`` ago."""
    t = x.t_low - p.curve_delay
    level: float = curve.u[len(curve.u) - 1]
    for k in range(len(curve.t) - 1, 0, -1):
        if t < curve.t[k]:
            share = max((t - curve.t[k - 1]) / (curve.t[k] - curve.t[k - 1]), 0.0)
            level = curve.u[k - 1] + share * (curve.u[k] - curve.u[k - 1])
    return level


@kernel
def relays_step(
    x: RelayState, u: complex, i: complex, v_dc: float, u_min: float, p: ProtectionParams, T_S: float
) -> tuple[RelayState, int]:
    """Advance the relays by one plant step; return their state and the code of a trip, or 0.

    ``u_min`` (pu) is what `undervoltage_limit` gives; it moves so slowly that once a control period is enough.

    The frequency is how fast the positive sequence turns: with u+ = (u' + j qu')/2 of a generator at w_nom,
    du+/dt = j w_nom u+ + w_nom K e / 2.
    """
    e = u - x.cell.u
    u_pos, _ = sequences(x.cell)
    square = u_pos.real**2 + u_pos.imag**2
    across = u_pos.real * e.imag - u_pos.imag * e.real
    w_now = p.w_nom + 0.5 * _K * p.w_nom * across / max(square, _SMALL * p.u_nom**2)
    w = x.w + T_S / _FREQUENCY_FILTER * (w_now - x.w)
    low = square < (p.u_low * p.u_nom) ** 2
    t_low = x.t_low + T_S if low else 0.0
    off = not low and (w < p.w_min or w > p.w_max)
    t_off = x.t_off + T_S if off else 0.0
    after = RelayState(cell=sogi_step(x.cell, scaled(_K, e), p.turn), w=w, t_low=t_low, t_off=t_off)
    if exceeds(i, p.i_max):
        return after, OVERCURRENT
    if v_dc > p.v_dc_max:
        return after, DC_OVERVOLTAGE
    if low and square < (u_min * p.u_nom) ** 2:
        return after, UNDERVOLTAGE
    if t_off >= p.t_frequency:
        return after, FREQUENCY
    return after, NO_TRIP
