"""What compiled series are made of: the cycle that ends at a sample, and the turn by an angle that goes on.

Where each sample has a cycle of its own, sums of the last one lie in a ring, a row a sample.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.space_vectors import SQRT3_2
from pvlvrt_compliance.waveforms.container import Samples, Segment, ThreePhase

# As `measure.sliding` has it: a cycle that misses a whole number of samples by less than this is taken to be whole.
ROUND_OFF = 1e-9

TWO_PI = 2 * math.pi

# Compiled code warns of no sum that is not finite; where compilation is turned off, numpy's scalars would.
SILENT = np.errstate(invalid="ignore")

# A turn made of so many small ones is made anew, so that their rounding does not add up.
MOST_TURNS = 256

# Angle below which a series of five terms has its sine and cosine to the last digit.
SMALL = 0.04


class Cycle(NamedTuple):
    """Where the cycle that ends at a sample begins."""

    samples: float  # its length, in sampling steps
    share: float  # of a step in it
    back: int  # whole steps that hold it
    before: float  # weights of the integral at the four samples around its beginning
    at: float
    after: float
    later: float


class Turn(NamedTuple):
    """exp(-j angle), the angle being turned on by one step a sample."""

    angle: float
    x: float  # of exp(-j angle)
    y: float
    step: float  # angle of one step
    step_x: float  # of exp(-j step)
    step_y: float
    left: int  # steps until the turn is made anew


@kernel
def cycle_of(share: float) -> Cycle:
    """Return the cycle that a step is such a share of, with Lagrange's weights of a cubic."""
    samples = 1.0 / share
    back = math.ceil(samples - ROUND_OFF)
    f = max(back - samples, 0.0)
    a, b = f * (f - 1.0), (f + 1.0) * (f - 2.0)
    return Cycle(samples, share, back, -a * (f - 2.0) / 6.0, (f - 1.0) * b / 2.0, -f * b / 2.0, (f + 1.0) * a / 6.0)


@kernel
def components(a: float, b: float, c: float) -> tuple[float, float, float]:
    """Real and imaginary part of Fortescue's positive sequence of three samples, and their zero sequence."""
    return (a - 0.5 * (b + c)) / 3.0, (b - c) * (SQRT3_2 / 3.0), (a + b + c) / 3.0


@kernel
def turn_by(angle: float) -> tuple[float, float]:
    """Return exp(-j angle)."""
    if not abs(angle) < SMALL:
        return math.cos(angle), -math.sin(angle)
    q = angle * angle
    x = 1.0 - q / 2.0 * (1.0 - q / 12.0 * (1.0 - q / 30.0 * (1.0 - q / 56.0)))
    return x, -angle * (1.0 - q / 6.0 * (1.0 - q / 20.0 * (1.0 - q / 42.0 * (1.0 - q / 72.0))))


@kernel
def turned_on(t: Turn, step: float) -> Turn:
    """Return a turn after one more step of an angle."""
    angle = t.angle + step
    if angle > math.pi:
        angle -= TWO_PI
    step_x, step_y = t.step_x, t.step_y
    if step != t.step:
        step_x, step_y = turn_by(step)
    if t.left == 0:
        return Turn(angle, math.cos(angle), -math.sin(angle), step, step_x, step_y, MOST_TURNS)
    return Turn(angle, t.x * step_x - t.y * step_y, t.x * step_y + t.y * step_x, step, step_x, step_y, t.left - 1)


@kernel
def window_mean(ring: NDArray[np.float64], k: int, channel: int, c: Cycle) -> float:
    """Mean of the cycle that ends at sample k, by what its integral is there and a cycle ago."""
    mask = max(len(ring) - 1, 0)  # which LLVM then knows to be no index from the end
    first = k - c.back - 1
    past: float = (
        c.before * ring[first & mask, channel]
        + c.at * ring[(first + 1) & mask, channel]
        + c.after * ring[(first + 2) & mask, channel]
        + c.later * ring[(first + 3) & mask, channel]
    )
    now: float = ring[k & mask, channel]
    return (now - past) * c.share


def three_phase(segment: Segment, kind: str) -> ThreePhase:
    """Three phases of a segment, as compiled code takes them."""
    return ThreePhase(*(np.ascontiguousarray(x, dtype=np.float64) for x in segment.three_phase(kind)))


def longest_cycle(frequency_hz: Samples, dt_s: float) -> float:
    """Sampling steps of the longest cycle of some frequencies.

    Raises
    ------
    MeasurementError
        When the shortest has fewer than two.
    """
    shortest, longest = (1 / (f * dt_s) for f in (float(frequency_hz.max()), float(frequency_hz.min())))
    if math.ceil(shortest - ROUND_OFF) < 2:
        raise MeasurementError("fewer than two samples a cycle")
    return longest


def ring_for(frequency_hz: Samples, dt_s: float, columns: int) -> NDArray[np.float64]:
    """Memory for the longest cycle of some frequencies: rows, and as many columns as asked for; errors as there."""
    return np.empty((1 << math.ceil(math.log2(longest_cycle(frequency_hz, dt_s) + 6)), columns))
