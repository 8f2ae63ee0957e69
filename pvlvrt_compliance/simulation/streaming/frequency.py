"""Frequency at each sample, compiled: `measure.tracking.tracked_frequency`."""

import math

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import cached_kernel, kernel
from pvlvrt_compliance.simulation.streaming.averages import components_into, turned_vector
from pvlvrt_compliance.simulation.streaming.blocks import (
    LENGTH,
    Rows,
    first_block,
    integrated,
    means_into,
    memory_for,
    next_block,
    turns_into,
)
from pvlvrt_compliance.simulation.streaming.windows import (
    MOST_TURNS,
    SILENT,
    SMALL,
    TWO_PI,
    Turn,
    components,
    cycle_of,
    ring_for,
    three_phase,
    turned_on,
    window_mean,
)
from pvlvrt_compliance.waveforms.container import Samples, Segment, ThreePhase

Flags = NDArray[np.uint8]

# How far a frequency is followed, and how often it is corrected: as `measure.tracking` has it.
LOWEST, HIGHEST = 0.75, 1.25
PASSES = 3

# Of nominal: a frequency that has changed by less leaves what is measured with it as it is.
STILL = 2e-12


@kernel
def angle_of(x: float, y: float) -> float:
    """Angle of x + jy."""
    if not abs(y) < SMALL * x:
        return math.atan2(y, x)
    return small_angle_of(y / x)


@kernel
def small_angle_of(r: float) -> float:
    """Angle of 1 + jr, r being small."""
    q = r * r
    return r * (1.0 - q * (1.0 / 3.0 - q * (1.0 / 5.0 - q * (1.0 / 7.0 - q * (1.0 / 9.0 - q / 11.0)))))


@kernel
def followed(
    abc: ThreePhase,
    dt: float,
    nominal: float,
    floor: float,
    ring: Samples,
    assumed: Samples,
    stirred: Flags,
    found: Samples,
    begin: int,
    first: int,
) -> tuple[int, int]:
    """Follow the frequency from a sample on whose assumed frequency has changed; return where it ends, and ``first``.

    That is where nothing has changed for as long as a value rests on. Parameters as `frequency_pass`.
    """
    mask, n = max(len(ring) - 1, 0), len(assumed)
    reach = 2 * math.ceil(1.0 / (LOWEST * nominal * dt)) + 8
    start, end, is_known = max(begin - reach, 0), begin + reach, False
    held = found[begin - 1] if begin > 0 else 0.0
    f_before = assumed[start]
    window = cycle_of(f_before * dt)
    turn = Turn(0.0, 1.0, 0.0, 0.0, 1.0, 0.0, MOST_TURNS)
    x_sum = y_sum = reference = reference_sum = 0.0
    k = start
    while k < n and (k <= end or not is_known):
        f = assumed[k]
        if f != f_before:
            window = cycle_of(f * dt)
        if k > start:
            turn = turned_on(turn, math.pi * dt * (f_before + f))
            reference += math.pi * dt * (f_before + f - 2.0 * nominal)
        f_before = f
        alpha, beta, _ = components(abc.a[k], abc.b[k], abc.c[k])
        x, y = alpha * turn.x - beta * turn.y, alpha * turn.y + beta * turn.x
        x_sum += x
        y_sum += y
        reference_sum += reference
        row = k & mask
        ring[row, 0] = x_sum - 0.5 * x
        ring[row, 1] = y_sum - 0.5 * y
        ring[row, 2] = reference_sum - 0.5 * reference
        ring[row, 3] = -0.5 * window.samples
        for channel in range(3):
            ring[row, 4 + channel] = window_mean(ring, k, channel, window) if k - start > window.back else math.nan
        steps = round(window.samples)
        ago = max(k - steps, start) & mask
        x, y, x_ago, y_ago = 2.0 * ring[row, 4], 2.0 * ring[row, 5], 2.0 * ring[ago, 4], 2.0 * ring[ago, 5]
        if k >= begin:
            is_known = False
            if min(x * x + y * y, x_ago * x_ago + y_ago * y_ago) >= floor * floor:
                turned = angle_of(x * x_ago + y * y_ago, y * x_ago - x * y_ago) + ring[row, 6] - ring[ago, 6]
                value = nominal + turned / (TWO_PI * dt * (steps + ring[row, 3] - ring[ago, 3]))
                if math.isfinite(value):
                    held, is_known = min(max(value, LOWEST * nominal), HIGHEST * nominal), True
                    first = min(first, k)
            if stirred[k]:
                end = k + reach
            found[k] = held
            stirred[k] = abs(held - assumed[k]) > STILL * nominal
        k += 1
    return k, first


@cached_kernel
def frequency_pass(
    abc: ThreePhase,
    dt: float,
    nominal: float,
    floor: float,
    ring: Samples,
    assumed: Samples,
    stirred: Flags,
    found: Samples,
    first: int,
) -> int:
    """Measure the frequency with windows of an assumed one, and return the first sample that has one, n where none has.

    Where the assumed frequency has not changed, what it gives has not, either. A sample without a voltage of the floor
    has the value of the last that has one, or of the first where there is none.

    Parameters
    ----------
    abc : ThreePhase
        Three phases, shape (n,) each.
    dt : float
        Sampling step (s).
    nominal, floor : float
        As of `tracked_frequency`.
    ring : array, shape (rows, 7)
        Rows as of `sequences_into`. Sums of a phasor's two parts and of its reference, the middle of the window, these
        three themselves.
    assumed, found : array, shape (n,)
        Frequency that is assumed, and that is found (Hz), which has what is assumed to begin with.
    stirred : array of uint8, shape (n,)
        Whether the assumed frequency is another one than in the pass before; afterwards, whether the found one is.
    first : int
        What the pass before has returned.
    """
    k, n = 0, len(assumed)
    while k < n:
        if stirred[k]:
            k, first = followed(abc, dt, nominal, floor, ring, assumed, stirred, found, k, n if k == 0 else first)
        else:
            k += 1
    if first < n:
        changed = 0.0
        for k in range(first + 1):
            changed = max(changed, abs(found[first] - assumed[k]))
            found[k] = found[first]
        stirred[: first + 1] = changed > STILL * nominal
    return first


@cached_kernel
def steady_pass(
    abc: ThreePhase,
    dt: float,
    nominal: float,
    floor: float,
    steady: Samples,
    work: Rows,
    memory: Rows,
    stirred: Flags,
    found: Samples,
) -> tuple[int, bool]:
    """As `frequency_pass` where the nominal frequency is assumed throughout.

    Returns, too, whether all samples are finite; all of ``found`` and ``stirred`` is written.

    Parameters
    ----------
    steady : array, shape (1,)
        The nominal frequency (Hz).
    work : array, shape (6, LENGTH)
        Of no value before or after.
    memory : array, shape (4, room)
        As `memory_for` gives it: integrals of a phasor's two parts, and these themselves.
    """
    n, first, held = len(found), len(found), 0.0
    x, y, along, across, least, angle = work[0], work[1], work[2], work[3], work[4], work[5]
    x_sum = y_sum = 0.0
    b = first_block(steady, dt, n)
    steps = round(b.window.samples)
    per_turn = 1.0 / (TWO_PI * dt * steps)
    while b.samples > 0:
        end = b.at + b.samples
        turns_into(b, x, y)
        components_into(abc, b, along, across, angle)
        turned_vector(along, across, 1.0, x, y, memory[0, b.at : end], memory[1, b.at : end])
        x_sum, y_sum = integrated(memory[0, b.at : end], memory[1, b.at : end], x_sum, y_sum)
        means_into(b, memory[0], 2.0, memory[2, b.at : end])
        means_into(b, memory[1], 2.0, memory[3, b.at : end])
        known = min(max(steps - b.begin, 0), b.samples)  # samples that have one a cycle ago
        here, ago = b.at + known, b.at + known - steps
        turned_since(memory[2:, here:end], memory[2:, ago : end - steps], along, across, least, angle)
        for j in range(b.samples):
            k, at = b.begin + j, j - known
            if at >= 0 and least[at] >= floor * floor:
                if not abs(across[at]) < SMALL * along[at]:
                    angle[at] = math.atan2(across[at], along[at])
                value = nominal + angle[at] * per_turn
                if math.isfinite(value):
                    held = min(max(value, LOWEST * nominal), HIGHEST * nominal)
                    first = min(first, k)
            found[k] = held
            stirred[k] = abs(held - nominal) > STILL * nominal
        b = next_block(b, steady, dt, n, memory)
    if first < n:
        found[:first] = found[first]
        stirred[:first] = stirred[first]
    return first, math.isfinite(x_sum + y_sum)


@kernel
def turned_since(now: Rows, ago: Rows, along: Samples, across: Samples, least: Samples, angle: Samples) -> None:
    """Compare phasors (two rows) with those of a cycle ago: product, lesser square, and the angle where it is small."""
    x, y, x_ago, y_ago = now[0], now[1], ago[0], ago[1]
    for j in range(now.shape[1]):
        along[j] = x[j] * x_ago[j] + y[j] * y_ago[j]
        across[j] = y[j] * x_ago[j] - x[j] * y_ago[j]
    for j in range(now.shape[1]):
        least[j] = min(x[j] * x[j] + y[j] * y[j], x_ago[j] * x_ago[j] + y_ago[j] * y_ago[j])
    for j in range(now.shape[1]):
        angle[j] = small_angle_of(across[j] / along[j])


@SILENT
def tracked_frequency(segment: Segment, nominal_hz: float, kind: str = "u", floor: float = 1.0) -> Samples:
    """Frequency of the positive sequence at each sample: `measure.tracking.tracked_frequency`."""
    abc, n = three_phase(segment, kind), len(segment)
    ring = ring_for(np.array([LOWEST * nominal_hz, HIGHEST * nominal_hz]), segment.dt_s, 7)
    found, stirred, steady = np.empty(n), np.empty(n, dtype=np.uint8), np.array([nominal_hz])
    memory, work = memory_for(steady, segment.dt_s, 4), np.empty((6, LENGTH))
    first, is_finite = steady_pass(abc, segment.dt_s, nominal_hz, floor, steady, work, memory, stirred, found)
    since = first
    for _ in range(1, PASSES):
        if first == n or not stirred.any():
            break
        first = frequency_pass(abc, segment.dt_s, nominal_hz, floor, ring, found.copy(), stirred, found, first)
        since = max(since, first)
    found[: n if first == n else since] = np.nan
    if not is_finite:
        found[int(np.isfinite(sum(abc)).argmin()) :] = np.nan
    return found
