"""Sequences and powers of one cycle, compiled: `measure.sequences` and `measure.fourier.one_cycle_mean`."""

import math

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import cached_kernel
from pvlvrt_compliance.simulation.streaming.windows import (
    MOST_TURNS,
    SILENT,
    Turn,
    components,
    cycle_of,
    ring_for,
    three_phase,
    turned_on,
    window_mean,
)
from pvlvrt_compliance.waveforms.container import Samples, Segment, ThreePhase


@cached_kernel
def sequences_into(abc: ThreePhase, dt: float, frequency: Samples, sums: Samples, ring: Samples, out: Samples) -> None:
    """Write one-cycle phasors of the sequences of three phases, as `sequence_phasors` gives them.

    Parameters
    ----------
    abc : ThreePhase
        Three phases, shape (n,) each.
    dt : float
        Sampling step (s).
    frequency : array, shape (n,) or (1,)
        At each sample, or one for all (Hz).
    sums : array, shape (6,)
        Zeros.
    ring : array, shape (rows, 6)
        Of a power of two of rows, for a cycle and four samples.
    out : array, shape (3, n, 2)
        Real and imaginary parts of the sequences.
    """
    mask, each = max(len(ring) - 1, 0), len(frequency) > 1
    f_before = frequency[0]
    window = cycle_of(f_before * dt)
    turn = Turn(0.0, 1.0, 0.0, 0.0, 1.0, 0.0, MOST_TURNS)
    for k in range(out.shape[1]):
        f = frequency[k] if each else f_before
        if f != f_before:
            window = cycle_of(f * dt)
        if k > 0:
            turn = turned_on(turn, math.pi * dt * (f_before + f))
        f_before = f
        alpha, beta, zero = components(abc.a[k], abc.b[k], abc.c[k])
        ax, ay, bx, by = alpha * turn.x, alpha * turn.y, beta * turn.x, beta * turn.y
        now = (ax - by, ay + bx, ax + by, ay - bx, zero * turn.x, zero * turn.y)
        for channel in range(6):
            sums[channel] += now[channel]
            ring[k & mask, channel] = sums[channel] - 0.5 * now[channel]
        for channel in range(6):
            known = 2.0 * window_mean(ring, k, channel, window) if k > window.back else math.nan
            out[channel // 2, k, channel % 2] = known


@cached_kernel
def powers_into(
    u: ThreePhase, i: ThreePhase, dt: float, frequency: Samples, ring: Samples, p: Samples, q: Samples
) -> None:
    """Write means of p and q over the cycle that ends at each sample; parameters as `sequences_into`, shapes (n,)."""
    mask, each = max(len(ring) - 1, 0), len(frequency) > 1
    f_before = frequency[0]
    window = cycle_of(f_before * dt)
    p_sum = q_sum = 0.0
    for k in range(len(p)):
        f = frequency[k] if each else f_before
        if f != f_before:
            window = cycle_of(f * dt)
        f_before = f
        u_alpha, u_beta, _ = components(u.a[k], u.b[k], u.c[k])
        i_alpha, i_beta, _ = components(i.a[k], i.b[k], i.c[k])
        p_now = 6.0 * (u_alpha * i_alpha + u_beta * i_beta)
        q_now = 6.0 * (u_beta * i_alpha - u_alpha * i_beta)
        p_sum += p_now
        q_sum += q_now
        ring[k & mask, 0] = p_sum - 0.5 * p_now
        ring[k & mask, 1] = q_sum - 0.5 * q_now
        p[k] = window_mean(ring, k, 0, window) if k > window.back else math.nan
        q[k] = window_mean(ring, k, 1, window) if k > window.back else math.nan


@SILENT
def sequence_phasors(segment: Segment, kind: str, frequency_hz: float | Samples) -> NDArray[np.complex128]:
    """Sequences of the cycle that ends at each sample, shape (3, n): `measure.sequences.sequence_phasors`."""
    abc, out = three_phase(segment, kind), np.empty((3, len(segment), 2))
    frequency = np.array(frequency_hz, dtype=np.float64, ndmin=1)
    if len(segment):
        sequences_into(abc, segment.dt_s, frequency, np.zeros(6), ring_for(frequency, segment.dt_s, 6), out)
    return out.view(np.complex128)[..., 0]


@SILENT
def mean_powers(segment: Segment, frequency_hz: float | Samples) -> NDArray[np.float64]:
    """Means of P (W) and Q (var) over the cycle that ends at each sample, shape (2, n)."""
    u, i = three_phase(segment, "u"), three_phase(segment, "i")
    out = np.empty((2, len(segment)))
    frequency = np.array(frequency_hz, dtype=np.float64, ndmin=1)
    if len(segment):
        powers_into(u, i, segment.dt_s, frequency, ring_for(frequency, segment.dt_s, 2), out[0], out[1])
    return out
