"""What compiled series go through a record by: blocks of samples of one frequency, a channel a row.

Each step of the work is a loop of its own over a block, which the processor does several samples of at once. Integrals
run on from block to block; those of the last cycle stay in memory, and make room when it is full.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.simulation.streaming.windows import TWO_PI, Cycle, cycle_of, longest_cycle
from pvlvrt_compliance.waveforms.container import Samples

LENGTH = 512
"""Samples of a block, at most; chosen: all that is made of one stays in the processor's fastest memory."""

_FURTHER = 3 * LENGTH  # samples that memory holds besides those of the longest cycle

Rows = NDArray[np.float64]


class Block(NamedTuple):
    """Samples of one frequency, one after the other."""

    begin: int  # the first, in the record
    samples: int
    at: int  # where the first lies in memory
    angle: float  # turned back by at the first (rad)
    step: float  # and from each to the next
    frequency: float  # (Hz)
    window: Cycle


@kernel
def alike_from(frequency: Samples, k: int, n: int) -> int:
    """How many samples from k on have the frequency of the first, up to the length of a block."""
    most = min(LENGTH, n - k)
    if len(frequency) == 1:
        return most
    count = 1
    while count < most and frequency[k + count] == frequency[k]:
        count += 1
    return count


@kernel
def first_block(frequency: Samples, dt: float, n: int) -> Block:
    """Return the block that a record of n samples begins with, at angle 0."""
    f = frequency[0]
    return Block(0, alike_from(frequency, 0, n), 0, 0.0, TWO_PI * dt * f, f, cycle_of(f * dt))


@kernel
def following(b: Block, frequency: Samples, dt: float, n: int) -> Block:
    """Return the block after another; it has no samples at the end of the record."""
    begin, at = b.begin + b.samples, b.at + b.samples
    if begin >= n:
        return Block(begin, 0, at, 0.0, 0.0, b.frequency, b.window)
    angle = b.angle + (b.samples - 1) * b.step
    f, step, window = b.frequency, b.step, b.window
    if len(frequency) > 1 and frequency[begin] != f:
        angle += math.pi * dt * f
        f = frequency[begin]
        angle += math.pi * dt * f
        step, window = TWO_PI * dt * f, cycle_of(f * dt)
    else:
        angle += step
    angle -= TWO_PI * math.floor(angle / TWO_PI)
    return Block(begin, alike_from(frequency, begin, n), at, angle, step, f, window)


@kernel
def with_room(b: Block, memory: Rows) -> Block:
    """Return a block with room for it in memory, where what is older than the longest cycle is let go."""
    if b.at + b.samples <= memory.shape[1]:
        return b
    kept = memory.shape[1] - _FURTHER
    for row in range(memory.shape[0]):
        x = memory[row]
        for j in range(kept):
            x[j] = x[b.at - kept + j]
    return Block(b.begin, b.samples, kept, b.angle, b.step, b.frequency, b.window)


@kernel
def next_block(b: Block, frequency: Samples, dt: float, n: int, memory: Rows) -> Block:
    """Return the block after another, with room for it in memory."""
    return with_room(following(b, frequency, dt, n), memory)


@kernel
def turns_into(b: Block, x: Samples, y: Samples) -> None:
    """Write real and imaginary part of exp(-j angle) at each sample of a block: some, then as many again, turned on."""
    x[0], y[0] = math.cos(b.angle), -math.sin(b.angle)
    done = 1
    while done < b.samples:
        more = min(done, b.samples - done)
        step_x, step_y = math.cos(done * b.step), -math.sin(done * b.step)
        later_x, later_y = x[done : done + more], y[done : done + more]
        for j in range(more):
            later_x[j] = x[j] * step_x - y[j] * step_y
            later_y[j] = x[j] * step_y + y[j] * step_x
        done += more


@kernel
def integrated(x: Samples, y: Samples, x_sum: float, y_sum: float) -> tuple[float, float]:
    """Put in place of each sample of two channels the integral up to there; return the sums, which it goes on from."""
    for j in range(len(x)):
        x_now, y_now = x[j], y[j]
        x_sum += x_now
        y_sum += y_now
        x[j] = x_sum - 0.5 * x_now
        y[j] = y_sum - 0.5 * y_now
    return x_sum, y_sum


@kernel
def means_into(b: Block, integral: Samples, gain: float, out: Samples) -> None:
    """Write means of the cycle that ends at each sample, times a gain; not a number where none has passed.

    Parameters
    ----------
    b : Block
        The samples.
    integral : array, shape (room,)
        A row of memory.
    gain : float
        What the means are multiplied by.
    out : array, shape (count,)
        The means.
    """
    window = b.window
    unknown = min(max(window.back + 1 - b.begin, 0), b.samples)
    for j in range(unknown):
        out[j] = math.nan
    known = b.samples - unknown
    if known > 0:
        now, first = b.at + unknown, b.at + unknown - window.back - 1
        of_now, mean = integral[now : now + known], out[unknown : unknown + known]
        before, at = integral[first : first + known], integral[first + 1 : first + 1 + known]
        after, later = integral[first + 2 : first + 2 + known], integral[first + 3 : first + 3 + known]
        factor = gain * window.share
        for j in range(known):
            past = window.before * before[j] + window.at * at[j] + window.after * after[j] + window.later * later[j]
            mean[j] = (of_now[j] - past) * factor


@kernel
def mean_at(integral: Samples, k: int, window: Cycle) -> float:
    """Mean of the cycle that ends at sample k, which has a cycle and a sample behind it; shape (n,)."""
    first = k - window.back - 1
    past: float = (
        window.before * integral[first]
        + window.at * integral[first + 1]
        + window.after * integral[first + 2]
        + window.later * integral[first + 3]
    )
    now: float = integral[k]
    return (now - past) * window.share


def memory_for(frequency_hz: Samples, dt_s: float, rows: int) -> Rows:
    """Memory for the longest cycle of some frequencies and some blocks, shape (rows, room); errors as of `ring_for`."""
    return np.empty((rows, math.ceil(longest_cycle(frequency_hz, dt_s)) + 2 + _FURTHER))
