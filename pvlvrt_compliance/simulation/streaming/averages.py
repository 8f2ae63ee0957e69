"""Phasors and powers of one cycle, compiled: `measure.sequences`, `measure.power`, `measure.fourier.one_cycle_mean`."""

import math

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import cached_kernel, kernel
from pvlvrt_compliance.simulation.streaming.blocks import (
    LENGTH,
    Block,
    Rows,
    first_block,
    integrated,
    means_into,
    memory_for,
    next_block,
    turns_into,
)
from pvlvrt_compliance.simulation.streaming.windows import SILENT, components, three_phase
from pvlvrt_compliance.waveforms.container import Samples, Segment, ThreePhase

Frequency = float | Samples
"""One for all samples, or one at each, shape (n,) (Hz)."""

Parts = NDArray[np.float64]
"""Complex numbers by real and imaginary part, shape (..., n, 2)."""

_OF_PHASORS, _OF_POWERS, _WORK = 6, 2, 7  # rows


@kernel
def components_into(abc: ThreePhase, b: Block, alpha: Samples, beta: Samples, zero: Samples) -> None:
    """Write real and imaginary part of the positive sequence of a block's samples, and their zero sequence."""
    end = b.begin + b.samples
    a, second, c = abc.a[b.begin : end], abc.b[b.begin : end], abc.c[b.begin : end]
    for j in range(b.samples):
        alpha[j], beta[j], _ = components(a[j], second[j], c[j])
    for j in range(b.samples):
        _, _, zero[j] = components(a[j], second[j], c[j])


@kernel
def turned_vector(alpha: Samples, beta: Samples, sign: float, x: Samples, y: Samples, re: Samples, im: Samples) -> None:
    """Write a vector turned back, the sign -1 for the one that turns the other way; shapes (count,) and more."""
    for j in range(len(re)):
        across = sign * beta[j]
        re[j] = alpha[j] * x[j] - across * y[j]
        im[j] = alpha[j] * y[j] + across * x[j]


@kernel
def turned_signal(signal: Samples, x: Samples, y: Samples, re: Samples, im: Samples) -> None:
    """Write a signal turned back; shapes (count,) and more."""
    for j in range(len(re)):
        re[j] = signal[j] * x[j]
        im[j] = signal[j] * y[j]


@cached_kernel
def phasors_into(
    abc: ThreePhase,
    dt: float,
    frequency: Samples,
    as_sequences: bool,
    base: float,
    sums: Samples,
    work: Rows,
    memory: Rows,
    phasors: Parts,
    amplitudes: Rows,
) -> None:
    """Write one-cycle phasors of the sequences or the phases of three phases, or their amplitudes, or both.

    Parameters
    ----------
    abc : ThreePhase
        Three phases, shape (n,) each.
    dt : float
        Sampling step (s).
    frequency : array, shape (n,) or (1,)
        At each sample, or one for all (Hz).
    as_sequences : bool
        Whether of the sequences.
    base : float
        What the amplitudes are divided by.
    sums : array, shape (6,)
        Zeros.
    work : array, shape (7, LENGTH)
        Of no value before or after.
    memory : array, shape (6, room)
        As `memory_for` gives it.
    phasors : array, shape (3, n, 2) or (0, n, 2)
        Real and imaginary parts.
    amplitudes : array, shape (m, n), m up to 3
        Amplitudes of the first.
    """
    x, y, alpha, beta, zero, mean_x, mean_y = work[0], work[1], work[2], work[3], work[4], work[5], work[6]
    per_base = 1.0 / base
    b = first_block(frequency, dt, len(abc.a))
    while b.samples > 0:
        turns_into(b, x, y)
        if as_sequences:
            components_into(abc, b, alpha, beta, zero)
        end = b.begin + b.samples
        for number in range(max(len(phasors), len(amplitudes))):
            of_x, of_y = memory[2 * number], memory[2 * number + 1]
            re, im = of_x[b.at : b.at + b.samples], of_y[b.at : b.at + b.samples]
            if as_sequences and number < 2:
                turned_vector(alpha, beta, 1.0 - 2.0 * number, x, y, re, im)
            else:
                signal = zero if as_sequences else abc[number][b.begin : end]
                turned_signal(signal, x, y, re, im)
            sums[2 * number], sums[2 * number + 1] = integrated(re, im, sums[2 * number], sums[2 * number + 1])
            means_into(b, of_x, 2.0, mean_x)
            means_into(b, of_y, 2.0, mean_y)
            if number < len(phasors):
                phasor = phasors[number, b.begin : end]
                for j in range(b.samples):
                    phasor[j, 0], phasor[j, 1] = mean_x[j], mean_y[j]
            if number < len(amplitudes):
                amplitude = amplitudes[number, b.begin : end]
                for j in range(b.samples):
                    amplitude[j] = per_base * math.sqrt(mean_x[j] * mean_x[j] + mean_y[j] * mean_y[j])
        b = next_block(b, frequency, dt, len(abc.a), memory)


@cached_kernel
def powers_into(
    u: ThreePhase, i: ThreePhase, dt: float, frequency: Samples, base: float, memory: Rows, p: Samples, q: Samples
) -> None:
    """Write means of p and q by a base, over the cycle that ends at each sample; parameters as `phasors_into`, (n,)."""
    p_sum = q_sum = 0.0
    b = first_block(frequency, dt, len(p))
    while b.samples > 0:
        end = b.begin + b.samples
        u_a, u_b, u_c = u.a[b.begin : end], u.b[b.begin : end], u.c[b.begin : end]
        i_a, i_b, i_c = i.a[b.begin : end], i.b[b.begin : end], i.c[b.begin : end]
        p_now, q_now = memory[0, b.at : b.at + b.samples], memory[1, b.at : b.at + b.samples]
        for j in range(b.samples):
            u_alpha, u_beta, _ = components(u_a[j], u_b[j], u_c[j])
            i_alpha, i_beta, _ = components(i_a[j], i_b[j], i_c[j])
            p_now[j] = 6.0 * (u_alpha * i_alpha + u_beta * i_beta)
            q_now[j] = 6.0 * (u_beta * i_alpha - u_alpha * i_beta)
        p_sum, q_sum = integrated(p_now, q_now, p_sum, q_sum)
        means_into(b, memory[0], 1.0 / base, p[b.begin : end])
        means_into(b, memory[1], 1.0 / base, q[b.begin : end])
        b = next_block(b, frequency, dt, len(p), memory)


@cached_kernel
def current_into(
    u: ThreePhase,
    i: ThreePhase,
    dt: float,
    frequency: Samples,
    sign: float,
    floor: float,
    base: float,
    sums: Samples,
    work: Rows,
    memory: Rows,
    active: Samples,
    reactive: Samples,
) -> None:
    """Write active and reactive current of a sequence by a base, shapes (n,); none below a floor of its voltage.

    Parameters as `phasors_into`, with memory of four rows; the sign is 1 for the positive sequence, -1 for the other.
    """
    x, y, alpha, beta, zero, i_x, i_y = work[0], work[1], work[2], work[3], work[4], work[5], work[6]
    b = first_block(frequency, dt, len(active))
    while b.samples > 0:
        end = b.at + b.samples
        turns_into(b, x, y)
        for first in range(0, 4, 2):
            components_into(u if first == 0 else i, b, alpha, beta, zero)
            re, im = memory[first, b.at : end], memory[first + 1, b.at : end]
            turned_vector(alpha, beta, sign, x, y, re, im)
            sums[first], sums[first + 1] = integrated(re, im, sums[first], sums[first + 1])
        means_into(b, memory[0], 2.0, x)
        means_into(b, memory[1], 2.0, y)
        means_into(b, memory[2], 2.0, i_x)
        means_into(b, memory[3], 2.0, i_y)
        of_active, of_reactive = active[b.begin : b.begin + b.samples], reactive[b.begin : b.begin + b.samples]
        for j in range(b.samples):
            amplitude = math.sqrt(x[j] * x[j] + y[j] * y[j])
            per_volt = 1.0 / (base * amplitude) if amplitude >= floor else math.nan
            of_active[j] = (x[j] * i_x[j] + y[j] * i_y[j]) * per_volt
            of_reactive[j] = (y[j] * i_x[j] - x[j] * i_y[j]) * per_volt
        b = next_block(b, frequency, dt, len(active), memory)


@SILENT
def _measure(
    segment: Segment,
    kind: str,
    frequency_hz: Frequency,
    phasors: Parts,
    amplitudes: Rows,
    base: float = 1.0,
    *,
    as_sequences: bool = True,
) -> None:
    """Call `phasors_into` for a segment."""
    abc, frequency = three_phase(segment, kind), np.array(frequency_hz, dtype=np.float64, ndmin=1)
    if len(segment):
        memory = memory_for(frequency, segment.dt_s, _OF_PHASORS)
        sums, work = np.zeros(_OF_PHASORS), np.empty((_WORK, LENGTH))
        phasors_into(abc, segment.dt_s, frequency, as_sequences, base, sums, work, memory, phasors, amplitudes)


def sequence_phasors(segment: Segment, kind: str, frequency_hz: Frequency) -> NDArray[np.complex128]:
    """Sequences of the cycle that ends at each sample, shape (3, n): `measure.sequences.sequence_phasors`."""
    found, n = np.empty((3, len(segment), 2)), len(segment)
    _measure(segment, kind, frequency_hz, found, np.empty((0, n)))
    return found.view(np.complex128)[..., 0]


def sequence_amplitudes(segment: Segment, kind: str, frequency_hz: Frequency, base: float) -> Samples:
    """Amplitudes of the first two of these by a base, shape (2, n)."""
    found, n = np.empty((2, len(segment))), len(segment)
    _measure(segment, kind, frequency_hz, np.empty((0, n, 2)), found, base)
    return found


def phase_amplitudes(segment: Segment, kind: str, frequency_hz: Frequency, base: float) -> Samples:
    """Amplitudes of the phases by a base, shape (3, n): `measure.sequences.phase_amplitudes`."""
    found, n = np.empty((3, len(segment))), len(segment)
    _measure(segment, kind, frequency_hz, np.empty((0, n, 2)), found, base, as_sequences=False)
    return found


@SILENT
def mean_powers(segment: Segment, frequency_hz: Frequency, base: float = 1.0) -> Samples:
    """Means of P (W) and Q (var) by a base over the cycle that ends at each sample, shape (2, n)."""
    u, i = three_phase(segment, "u"), three_phase(segment, "i")
    out = np.empty((_OF_POWERS, len(segment)))
    frequency = np.array(frequency_hz, dtype=np.float64, ndmin=1)
    if len(segment):
        memory = memory_for(frequency, segment.dt_s, _OF_POWERS)
        powers_into(u, i, segment.dt_s, frequency, base, memory, out[0], out[1])
    return out


@SILENT
def sequence_current(segment: Segment, index: int, frequency_hz: Frequency, floor: float, base: float) -> Samples:
    """Current of a sequence (0 positive, 1 negative) by a base, shape (2, n): `measure.power.sequence_current`."""
    u, i = three_phase(segment, "u"), three_phase(segment, "i")
    found, frequency = np.empty((2, len(segment))), np.array(frequency_hz, dtype=np.float64, ndmin=1)
    if len(segment):
        memory, work = memory_for(frequency, segment.dt_s, 4), np.empty((_WORK, LENGTH))
        sign = -1.0 if index else 1.0
        sums = np.zeros(4)
        current_into(u, i, segment.dt_s, frequency, sign, floor, base, sums, work, memory, found[0], found[1])
    return found
