"""How far something swings about a straight line, how fast, and whether it dies away."""

import math
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.measure.durations import is_one_step, mean_over_time
from pvlvrt_compliance.measure.extremes import largest
from pvlvrt_compliance.waveforms.container import Samples

_STEP_S = 1e-3
_PIECE = 256  # samples that are looked at by their highest and lowest first ...
_FEW = 12  # ... and so many pieces that it pays to look into one by one
"""Step of the series that a frequency is looked for in: swings of a control are far below the 500 Hz it carries (s)."""

_PADDING = 8
"""Length that the series is filled up to, in its own: lines of the spectrum then lie an eighth of 1/length apart."""


_ROUND_OFF = 1e-12
"""Part of a series' size below which it does not swing."""


class Swing(NamedTuple):
    """How far a series goes to and fro."""

    peak_to_peak: float
    mean: float
    at: int
    """First sample that lies furthest from its straight line."""
    ends: tuple[float, float]
    """First and last value of the line, moved to the middle between what swings above and below it."""


class Tone(NamedTuple):
    """The strongest oscillation of a series."""

    frequency_hz: float
    damping_ratio: float
    """Of the decay e^(-damping 2 pi f t); 0 where it holds, negative where it grows."""


def without_line(t_s: Samples, x: Samples, step_s: Samples) -> Samples:
    """A series less its least-squares straight line, shape (n,), each sample counting as long as it lasts."""
    since = t_s - mean_over_time(t_s, step_s)
    rest: Samples = x - mean_over_time(x, step_s)
    lever = since if is_one_step(step_s) else step_s * since
    spread = np.einsum("n,n->", lever, since)
    if spread > 0:
        since *= np.einsum("n,n->", lever, rest) / spread
        rest -= since
    return rest


def swing(t_s: Samples, x: Samples, step_s: Samples, scale: float | None = None) -> Swing:
    """Peak to peak of a series about its straight line, but no more than it goes both up and down by.

    What only rises, however it does, is a recovery and no swing; of a sinusoid of one and a half periods or more its
    peak to peak is left.

    Parameters
    ----------
    t_s, x, step_s : array, shape (n,)
        Instants (s), values, and how long each sample lasts (s).
    scale : float
        What the rounding of the values is a part of, same unit (`measure.extremes`); without it their own size.
    """
    rest = without_line(t_s, x, step_s)
    lowest, highest = float(rest.min()), float(rest.max())
    size = min(highest - lowest, to_and_fro(x))
    middle = (highest + lowest) / 2
    ends = (float(x[0] - rest[0]) + middle, float(x[-1] - rest[-1]) + middle)
    at = largest(np.abs(rest), float(np.abs(x).max()) if scale is None else scale).at
    return Swing(size, mean_over_time(x, step_s), at, ends)


def to_and_fro(x: Samples) -> float:
    """The smaller of a series' largest rise and its largest fall, each from any sample to a later one."""
    if x.argmin() < x.argmax():  # then nothing falls further than from the lowest to the highest it rises
        return _largest_fall(x)
    return _largest_fall(-x)


def _largest_fall(x: Samples) -> float:
    """The largest fall of a series from a sample to a later one, shape (n,).

    Between pieces by their highest and lowest values; inside of one only where it spans more than is found by then.
    """
    pieces = np.concatenate([x, np.full(-len(x) % _PIECE, x[-1])]).reshape(-1, _PIECE)
    high, low = pieces.max(axis=1), pieces.min(axis=1)
    fallen = float((np.maximum.accumulate(high)[:-1] - low[1:]).max(initial=0.0))
    wide = np.flatnonzero(high - low > fallen)
    if len(wide) > _FEW:
        return float((np.maximum.accumulate(x) - x).max())
    inside = (float((np.maximum.accumulate(pieces[k]) - pieces[k]).max()) for k in wide)
    return max(fallen, *inside, 0.0)


def tone(t_s: Samples, x: Samples, step_s: Samples) -> Tone | None:
    """The strongest line of the spectrum of a series about its straight line, and how it dies away.

    The damping is taken from the rms of the first and of the second half: e^(-a t) makes their ratio e^(-a T/2) over a
    length T. None where the series does not swing.

    Parameters
    ----------
    t_s, x, step_s : array, shape (n,)
        As `swing`.
    """
    rest = without_line(t_s, x, step_s)
    grid = np.arange(t_s[0], t_s[-1], _STEP_S)
    if len(grid) < 4:
        return None
    y = np.interp(grid, t_s, rest)
    size = _PADDING * len(grid)
    spectrum = np.abs(np.fft.rfft(y * np.hanning(len(y)), size))
    line = int(spectrum[1:].argmax()) + 1
    frequency_hz = line / (size * _STEP_S)
    half = len(y) // 2
    first, second = (math.sqrt(float(np.mean(part**2))) for part in (y[:half], y[-half:]))
    if min(first, second) <= _ROUND_OFF * float(np.abs(x).max()):
        return None
    decay = math.log(first / second) / (half * _STEP_S)
    return Tone(frequency_hz, decay / math.hypot(decay, 2 * math.pi * frequency_hz))
