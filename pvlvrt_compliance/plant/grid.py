"""Grid source: symmetrical components that change at breakpoints, turning at the grid's frequency."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import kernel


class GridTable(NamedTuple):
    """Piecewise constant phasors: entry k holds from ``t[k]`` to ``t[k + 1]``; the last for ever."""

    t: NDArray[np.float64]  # instants of change, the first before the run (s)
    theta: NDArray[np.float64]  # angle at t[k] (rad)
    w: NDArray[np.float64]  # angular frequency (rad/s)
    half_rate: NDArray[np.complex128]  # turn of exp(j theta) in half a plant step (-)
    u_pos: NDArray[np.complex128]  # space vector of the positive sequence at angle 0 (V)
    u_neg: NDArray[np.complex128]  # space vector of the negative sequence at angle 0 (V)
    u_zero: NDArray[np.complex128]  # phasor of the zero sequence, peak, phase to neutral (V)


class Source(NamedTuple):
    """The entry that holds, and the angle as a unit vector. No arrays: it is passed in every plant step."""

    k: int  # index of the entry (-)
    t_end: float  # until when it holds (s)
    u_pos: complex  # (V)
    u_neg: complex  # (V)
    u_zero: complex  # (V)
    turn: complex  # exp(j theta) at this instant (-)
    half_rate: complex  # turn of exp(j theta) in half a plant step (-)


@kernel
def source_at(t: float, k: int, table: GridTable) -> Source:
    """Source at an instant (s), from entry ``k`` or a later one; no error accumulates."""
    last = len(table.t) - 1
    while k < last and t >= table.t[k + 1]:
        k += 1
    theta = table.theta[k] + table.w[k] * (t - table.t[k])
    return Source(
        k=k,
        t_end=table.t[k + 1] if k < last else math.inf,
        u_pos=table.u_pos[k],
        u_neg=table.u_neg[k],
        u_zero=table.u_zero[k],
        turn=complex(math.cos(theta), math.sin(theta)),
        half_rate=table.half_rate[k],
    )


@kernel
def turned(x: Source, by: complex) -> Source:
    """Source with its angle turned, within its entry."""
    return Source(
        k=x.k, t_end=x.t_end, u_pos=x.u_pos, u_neg=x.u_neg, u_zero=x.u_zero, turn=x.turn * by, half_rate=x.half_rate
    )


@kernel
def half_step_later(x: Source) -> Source:
    """Source half a plant step later, within its entry."""
    return turned(x, x.half_rate)


@kernel
def step_later(x: Source) -> Source:
    """Source one plant step later, within its entry."""
    return turned(x, x.half_rate * x.half_rate)


@kernel
def source_voltage(x: Source) -> complex:
    """Space vector of the source (V)."""
    return x.u_pos * x.turn + x.u_neg * x.turn.conjugate()


@kernel
def zero_sequence(x: Source) -> float:
    """Zero-sequence voltage of the source, phase to neutral (V); it drives no current through three wires."""
    return (x.u_zero * x.turn).real
