"""Grid source: symmetrical components that change at breakpoints, turning at the grid's frequency."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.plant.lookup import count_until
from pvlvrt_compliance.vectors import scaled


class GridTable(NamedTuple):
    """Phasors along straight lines: entry k holds from ``t[k]`` to ``t[k + 1]``; the last for ever."""

    t: NDArray[np.float64]  # instants of change, the first before the run (s)
    theta: NDArray[np.float64]  # angle at t[k] (rad)
    w: NDArray[np.float64]  # angular frequency at t[k] (rad/s)
    dw: NDArray[np.float64]  # its rate of change (rad/s2)
    u_pos: NDArray[np.complex128]  # space vector of the positive sequence at angle 0, at t[k] (V)
    u_neg: NDArray[np.complex128]  # space vector of the negative sequence at angle 0, at t[k] (V)
    u_zero: NDArray[np.complex128]  # phasor of the zero sequence, peak, phase to neutral, at t[k] (V)
    du_pos: NDArray[np.complex128]  # rates of change of the three (V/s)
    du_neg: NDArray[np.complex128]
    du_zero: NDArray[np.complex128]
    half_rate: NDArray[np.complex128]  # turn of exp(j theta) in half a plant step at w[k] (-)
    half_step: float  # half a plant step (s)


class HarmonicTable(NamedTuple):
    """Harmonics of the source in order of ``t_on``; each is there from then to ``t_off``."""

    order: NDArray[np.int64]  # turns with that power of exp(j theta); negative: negative sequence (-)
    u: NDArray[np.complex128]  # space vector at angle 0 (V)
    u_zero: NDArray[np.complex128]  # phasor of a zero-sequence harmonic, peak (V)
    t_on: NDArray[np.float64]  # (s)
    t_off: NDArray[np.float64]  # (s)
    t_over: NDArray[np.float64]  # when this one and all before it are over (s)


class PlaybackTable(NamedTuple):
    """Recorded voltage that takes the source's place while it lasts; without samples there is none."""

    t: float  # instant of the first sample (s)
    dt: float  # (s)
    u: NDArray[np.complex128]  # space vectors (V)
    u_zero: NDArray[np.float64]  # zero sequence, phase to neutral (V)


class Source(NamedTuple):
    """The entry that holds, and the angle as a unit vector. No arrays: it is passed in every plant step."""

    k: int  # index of the entry (-)
    t_end: float  # until when it holds (s)
    u_pos: complex  # (V)
    u_neg: complex  # (V)
    u_zero: complex  # (V)
    turn: complex  # exp(j theta) at this instant (-)
    half_rate: complex  # turn of exp(j theta) in half a plant step (-)
    du_pos: complex  # change of u_pos in half a plant step (V)
    du_neg: complex  # change of u_neg in half a plant step (V)


@kernel
def source_at(t: float, k: int, table: GridTable) -> Source:
    """Source at an instant (s), from entry ``k`` or a later one; no error accumulates."""
    last = len(table.t) - 1
    while k < last and t >= table.t[k + 1]:
        k += 1
    since = t - table.t[k]
    theta = table.theta[k] + (table.w[k] + 0.5 * table.dw[k] * since) * since
    half_rate = table.half_rate[k]
    if table.dw[k] != 0.0:
        more = table.dw[k] * since * table.half_step
        half_rate = half_rate * complex(math.cos(more), math.sin(more))
    return Source(
        k=k,
        t_end=table.t[k + 1] if k < last else math.inf,
        u_pos=table.u_pos[k] + scaled(since, table.du_pos[k]),
        u_neg=table.u_neg[k] + scaled(since, table.du_neg[k]),
        u_zero=table.u_zero[k] + scaled(since, table.du_zero[k]),
        turn=complex(math.cos(theta), math.sin(theta)),
        half_rate=half_rate,
        du_pos=scaled(table.half_step, table.du_pos[k]),
        du_neg=scaled(table.half_step, table.du_neg[k]),
    )


@kernel
def later(x: Source, by: complex, halves: float) -> Source:
    """Source some half plant steps later, within its entry; ``by`` is the turn in that time."""
    return Source(
        k=x.k,
        t_end=x.t_end,
        u_pos=x.u_pos + scaled(halves, x.du_pos),
        u_neg=x.u_neg + scaled(halves, x.du_neg),
        u_zero=x.u_zero,
        turn=x.turn * by,
        half_rate=x.half_rate,
        du_pos=x.du_pos,
        du_neg=x.du_neg,
    )


@kernel
def half_step_later(x: Source) -> Source:
    """Source half a plant step later, within its entry."""
    return later(x, x.half_rate, 1.0)


@kernel
def step_later(x: Source) -> Source:
    """Source one plant step later, within its entry."""
    return later(x, x.half_rate * x.half_rate, 2.0)


@kernel
def power_of(turn: complex, order: int) -> complex:
    """exp(j order theta) from exp(j theta), by squaring."""
    base = turn if order >= 0 else turn.conjugate()
    n = abs(order)
    result = 1 + 0j
    while n > 0:
        if n & 1:
            result = result * base
        base = base * base
        n >>= 1
    return result


@kernel
def is_playing(t: float, table: PlaybackTable) -> bool:
    """Whether a recording holds at an instant (s)."""
    return table.t <= t < table.t + (len(table.u) - 1) * table.dt


@kernel
def playback_voltage(t: float, table: PlaybackTable) -> complex:
    """Space vector of the recording at an instant (V): straight lines between its samples."""
    place = (t - table.t) / table.dt
    k = min(int(place), len(table.u) - 2)
    before: complex = table.u[k]
    return before + scaled(place - k, table.u[k + 1] - before)


@kernel
def playback_zero_sequence(t: float, table: PlaybackTable) -> float:
    """Zero sequence of the recording at an instant (V)."""
    place = (t - table.t) / table.dt
    k = min(int(place), len(table.u_zero) - 2)
    before: float = table.u_zero[k]
    after: float = table.u_zero[k + 1]
    return before + (place - k) * (after - before)


@kernel
def harmonic_voltage(x: Source, t: float, table: HarmonicTable) -> complex:
    """Space vector of the harmonics at an instant (V)."""
    u = 0j
    for k in range(count_until(t, table.t_over), count_until(t, table.t_on)):
        if t < table.t_off[k]:
            u += table.u[k] * power_of(x.turn, table.order[k])
    return u


@kernel
def harmonic_zero_sequence(x: Source, t: float, table: HarmonicTable) -> float:
    """Zero sequence of the harmonics at an instant, phase to neutral (V)."""
    u = 0.0
    for k in range(count_until(t, table.t_over), count_until(t, table.t_on)):
        if t < table.t_off[k]:
            u += (table.u_zero[k] * power_of(x.turn, table.order[k])).real
    return u


@kernel
def source_voltage(x: Source) -> complex:
    """Space vector of the source (V)."""
    return x.u_pos * x.turn + x.u_neg * x.turn.conjugate()


@kernel
def zero_sequence(x: Source) -> float:
    """Zero-sequence voltage of the source, phase to neutral (V); it drives no current through three wires."""
    return (x.u_zero * x.turn).real


@kernel
def with_harmonics(e: complex, source: Source, t: float, table: HarmonicTable | None) -> complex:
    """Source voltage (V) with its harmonics, if any."""
    if table is None:
        return e
    return e + harmonic_voltage(source, t, table)


@kernel
def or_playback(e: complex, t: float, table: PlaybackTable | None) -> complex:
    """Source voltage (V), or the recording's while there is one."""
    if table is None:
        return e
    return playback_voltage(t, table) if is_playing(t, table) else e


@kernel
def zero_with_harmonics(u: float, source: Source, t: float, table: HarmonicTable | None) -> float:
    """Zero sequence (V) with that of the harmonics, if any."""
    if table is None:
        return u
    return u + harmonic_zero_sequence(source, t, table)


@kernel
def zero_or_playback(u: float, t: float, table: PlaybackTable | None) -> float:
    """Zero sequence (V), or the recording's while there is one."""
    if table is None:
        return u
    return playback_zero_sequence(t, table) if is_playing(t, table) else u
