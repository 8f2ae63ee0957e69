"""Grid source: symmetrical components that change at breakpoints, turning at the grid's frequency."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import kernel


class GridParams(NamedTuple):
    """Piecewise constant phasors: entry k holds from ``t[k]`` to ``t[k + 1]``; the last for ever."""

    t: NDArray[np.float64]  # instants of change, the first before the run (s)
    theta: NDArray[np.float64]  # angle at t[k] (rad)
    w: NDArray[np.float64]  # angular frequency (rad/s)
    u_pos: NDArray[np.complex128]  # space vector of the positive sequence at angle 0 (V)
    u_neg: NDArray[np.complex128]  # space vector of the negative sequence at angle 0 (V)
    u_zero: NDArray[np.complex128]  # phasor of the zero sequence, peak, phase to neutral (V)


class GridState(NamedTuple):
    """Where the source is: which entry holds, and the angle as a unit vector."""

    k: int  # index of the entry (-)
    turn: complex  # exp(j theta) at this instant (-)
    rate: complex  # turn of exp(j theta) in one plant step (-)


@kernel
def grid_at(t: float, k: int, T_S: float, p: GridParams) -> GridState:
    """State of the source at an instant (s), from entry ``k`` or a later one; no error accumulates."""
    while k + 1 < len(p.t) and t >= p.t[k + 1]:
        k += 1
    theta = p.theta[k] + p.w[k] * (t - p.t[k])
    return GridState(
        k=k,
        turn=complex(math.cos(theta), math.sin(theta)),
        rate=complex(math.cos(p.w[k] * T_S), math.sin(p.w[k] * T_S)),
    )


@kernel
def grid_step(x: GridState, t_next: float, T_S: float, p: GridParams) -> GridState:
    """Advance the source by one plant step, to the instant ``t_next`` (s)."""
    if x.k + 1 < len(p.t) and t_next >= p.t[x.k + 1]:
        return grid_at(t_next, x.k, T_S, p)
    return GridState(k=x.k, turn=x.turn * x.rate, rate=x.rate)


@kernel
def source_voltage(x: GridState, p: GridParams) -> complex:
    """Space vector of the source (V)."""
    return p.u_pos[x.k] * x.turn + p.u_neg[x.k] * x.turn.conjugate()


@kernel
def zero_sequence(x: GridState, p: GridParams) -> float:
    """Zero-sequence voltage of the source, phase to neutral (V); it drives no current through three wires."""
    return (p.u_zero[x.k] * x.turn).real
