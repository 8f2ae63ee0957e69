"""Windows of whole cycles, compiled: `measure.window_sums` and `measure.frequency.fundamental_frequency`."""

import math

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import cached_kernel, kernel
from pvlvrt_compliance.simulation.streaming.averages import components_into, turned_vector
from pvlvrt_compliance.simulation.streaming.blocks import (
    LENGTH,
    Rows,
    first_block,
    following,
    integrated,
    mean_at,
    turns_into,
)
from pvlvrt_compliance.simulation.streaming.windows import SILENT, TWO_PI, components, three_phase
from pvlvrt_compliance.waveforms.container import Samples, Segment, ThreePhase

# As `measure.frequency` has them: how often a frequency is corrected, until by how little, by how many angles a cycle.
ITERATIONS = 20
SETTLED_HZ = 1e-6
ANGLES_A_CYCLE = 16


@cached_kernel
def sums_into(
    u: ThreePhase,
    i: ThreePhase,
    v_dc: Samples,
    dt: float,
    frequency: Samples,
    end_weight: float,
    work: Rows,
    out: Samples,
) -> None:
    """Write sums over the samples of whole cycles, of which the first and the last have a weight of their own.

    Parameters
    ----------
    u, i, v_dc
        Voltages, currents and DC voltage, shape (n,) each.
    dt : float
        Sampling step (s).
    frequency : array, shape (1,)
        That the cycles are counted of (Hz).
    end_weight : float
        Of the first sample and the last, all others having 1.
    work : array, shape (2, LENGTH)
        Of no value before or after.
    out : array, shape (20,)
        Of the voltages a, b, c, turned back: real and imaginary parts (6); of p, of q, of p turned back twice (2); of
        the DC voltage less its first value, plain (without weights), by the place in the window (the middle being 0),
        with weights, and turned back twice (2); of 1 (2) and of the place, turned back twice (2); of its square.
    """
    n, x, y = len(v_dc), work[0], work[1]
    middle, v_first = 0.5 * (n - 1), v_dc[0]
    a_x = a_y = b_x = b_y = c_x = c_y = 0.0
    p_sum = q_sum = p_x = p_y = 0.0
    v_plain = v_place = v_sum = v_x = v_y = 0.0
    one_x = one_y = place_x = place_y = squares = 0.0
    b = first_block(frequency, dt, n)
    while b.samples > 0:
        turns_into(b, x, y)
        for j in range(b.samples):
            k = b.begin + j
            weight = end_weight if k == 0 or k == n - 1 else 1.0
            w_x, w_y = weight * x[j], weight * y[j]
            a_x, a_y = a_x + u.a[k] * w_x, a_y + u.a[k] * w_y
            b_x, b_y = b_x + u.b[k] * w_x, b_y + u.b[k] * w_y
            c_x, c_y = c_x + u.c[k] * w_x, c_y + u.c[k] * w_y
            u_alpha, u_beta, _ = components(u.a[k], u.b[k], u.c[k])
            i_alpha, i_beta, _ = components(i.a[k], i.b[k], i.c[k])
            p = 6.0 * (u_alpha * i_alpha + u_beta * i_beta)
            p_sum += weight * p
            q_sum += weight * (6.0 * (u_beta * i_alpha - u_alpha * i_beta))
            twice_x, twice_y = w_x * x[j] - w_y * y[j], 2.0 * w_x * y[j]
            p_x, p_y = p_x + p * twice_x, p_y + p * twice_y
            place, v = k - middle, v_dc[k] - v_first
            v_plain, v_place, v_sum = v_plain + v, v_place + v * place, v_sum + v * weight
            v_x, v_y = v_x + v * twice_x, v_y + v * twice_y
            one_x, one_y = one_x + twice_x, one_y + twice_y
            place_x, place_y = place_x + place * twice_x, place_y + place * twice_y
            squares += place * place
        b = following(b, frequency, dt, n)
    out[0], out[1], out[2], out[3], out[4], out[5] = a_x, a_y, b_x, b_y, c_x, c_y
    out[6], out[7], out[8], out[9] = p_sum, q_sum, p_x, p_y
    out[10], out[11], out[12], out[13], out[14] = v_plain, v_place, v_sum, v_x, v_y
    out[15], out[16], out[17], out[18], out[19] = one_x, one_y, place_x, place_y, squares


@kernel
def turning_hz(
    abc: ThreePhase, dt: float, frequency: Samples, floor: float, work: Rows, memory: Rows
) -> tuple[bool, float]:
    """Return whether a frequency can be corrected, and its correction; parameters as `settled_hz`."""
    n, x, y, alpha, beta, zero = len(abc.a), work[0], work[1], work[2], work[3], work[4]
    x_sum = y_sum = 0.0
    b = first_block(frequency, dt, n)
    window = b.window
    if n - math.ceil(window.samples) - 1 < 0.45 * window.samples or window.back < 2:
        return False, 0.0
    while b.samples > 0:
        end = b.at + b.samples
        turns_into(b, x, y)
        components_into(abc, b, alpha, beta, zero)
        turned_vector(alpha, beta, 1.0, x, y, memory[0, b.at : end], memory[1, b.at : end])
        x_sum, y_sum = integrated(memory[0, b.at : end], memory[1, b.at : end], x_sum, y_sum)
        b = following(b, frequency, dt, n)
    stride = max(int(window.samples / ANGLES_A_CYCLE), 1)
    k = first = math.ceil(window.samples) + 1
    middle = 0.5 * ((n - 1 - first) // stride)
    place, angle, by_place, squares = -middle, 0.0, 0.0, 0.0
    x_before = y_before = 0.0
    while k < n:
        x_now, y_now = mean_at(memory[0], k, window), mean_at(memory[1], k, window)
        if not 4.0 * (x_now * x_now + y_now * y_now) >= floor * floor:
            return False, 0.0
        if k > first:
            angle += math.atan2(y_now * x_before - x_now * y_before, x_now * x_before + y_now * y_before)
        x_before, y_before = x_now, y_now
        by_place += place * angle
        squares += place * place
        place += 1.0
        k += stride
    return True, by_place / squares / (TWO_PI * stride * dt)


@cached_kernel
def settled_hz(
    abc: ThreePhase, dt: float, nominal: float, floor: float, frequency: Samples, work: Rows, memory: Rows
) -> bool:
    """Look for the frequency that a phasor stands still at, and return whether there is one.

    Parameters
    ----------
    abc : ThreePhase
        Three phases, shape (n,) each.
    dt : float
        Sampling step (s).
    nominal, floor : float
        As of `fundamental_frequency`.
    frequency : array, shape (1,)
        Where the search starts; afterwards what it came to (Hz).
    work, memory : array, shapes (5, LENGTH) and (2, n)
        Of no value before or after.
    """
    for _ in range(ITERATIONS):
        is_known, correction = turning_hz(abc, dt, frequency, floor, work, memory)
        frequency[0] += correction
        if not (is_known and abs(frequency[0] - nominal) <= 0.5 * nominal):
            return False
        if abs(correction) < SETTLED_HZ:
            return True
    return False


@SILENT
def window_sums(
    segment: Segment, frequency_hz: float, samples: int, length: float
) -> tuple[NDArray[np.complex128], tuple[float, float, float], tuple[float, float]]:
    """What `measure.window_sums` takes over whole cycles of so many samples, and so many sampling steps long."""
    u, i = (ThreePhase(*(x[:samples] for x in three_phase(segment, kind))) for kind in ("u", "i"))
    v_dc = np.ascontiguousarray(segment["v_dc_v"][:samples], dtype=np.float64)
    end_weight, out = 0.5 * (1 + length - (samples - 1)), np.empty(20)
    sums_into(u, i, v_dc, segment.dt_s, np.array([frequency_hz]), end_weight, np.empty((2, LENGTH)), out)
    p, q, p_x, p_y, v_plain, v_place, v, v_x, v_y, one_x, one_y, place_x, place_y, squares = out[6:].tolist()
    level, slope = v_plain / samples, v_place / squares
    of_2f = math.hypot(v_x - level * one_x - slope * place_x, v_y - level * one_y - slope * place_y)
    powers = (p / length, q / length, 2 / length * math.hypot(p_x, p_y))
    return out[:6].view(np.complex128) * (2 / length), powers, (v / length + float(v_dc[0]), 2 / length * of_2f)


@SILENT
def fundamental_frequency(segment: Segment, nominal_hz: float, kind: str, floor: float) -> float | None:
    """`measure.frequency.fundamental_frequency`; None where it finds none."""
    abc, frequency = three_phase(segment, kind), np.array([nominal_hz])
    work, memory = np.empty((5, LENGTH)), np.empty((2, len(segment)))
    found = len(segment) > 0 and settled_hz(abc, segment.dt_s, nominal_hz, floor, frequency, work, memory)
    return float(frequency[0]) if found else None
