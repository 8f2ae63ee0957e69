"""Records of several sampling steps, put on one grid where their grids fit each other.

They fit where every step is a whole multiple of the finest and all samples lie on one grid, so that the samples of the
coarsest step are there from the first segment to the last: what a simulated record of several steps is like.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.waveforms.container import Samples, Segment, Waveforms

INTERPOLATION_NODES = 8
"""Samples that an interpolated value is made from, half of them on either side."""

_NODES = np.arange(1 - INTERPOLATION_NODES // 2, INTERPOLATION_NODES // 2 + 1)
_ON_GRID = 1e-3  # of a step: samples this near are at one instant
_SPARE = 3  # samples that a one-cycle series loses, at most, besides those of the cycle


def window_on_one_grid(waveforms: Waveforms, start_s: float, stop_s: float) -> Segment:
    """Samples with ``start_s <= t < stop_s``; across a change of step, those on the grid of the coarsest one.

    Nothing is interpolated: the samples of the finer steps that lie on the coarsest grid are picked. What is faster
    than half the coarsest rate appears at other frequencies (there is no filter).

    Raises
    ------
    MeasurementError
        When the window leaves the record, or crosses a change of step between grids that do not fit each other.
    """
    whole = waveforms.segment_with(start_s, stop_s)
    if whole is not None:
        return whole.slice(start_s, stop_s)
    try:
        return _picked([segment.slice(start_s, stop_s) for segment in waveforms])
    except MeasurementError as error:
        raise MeasurementError(
            f"the window {start_s:.3f} s to {stop_s:.3f} s crosses a change of the sampling step: {error}"
        ) from None


def one_cycle_series(
    waveforms: Waveforms,
    series: Callable[[Segment], NDArray[Any]],
    frequency_hz: float,
    cycles: int = 1,
    channels: Iterable[str] | None = None,
) -> list[NDArray[Any]]:
    """Series whose values are made of the cycle, or several, that end at each sample, one array a segment.

    At the beginning of a segment that cycle lies in the record before it, which is put on the segment's own grid: by
    picking samples where the record before is at the same step or a finer one, else by interpolation between
    `INTERPOLATION_NODES` samples. A sinusoid of angular frequency w sampled every h comes out within 1.07e-3 (w h)^8 of
    its amplitude: at 60 Hz and 3 kHz 3e-10 for the fundamental, 1e-4 for the fifth and 1.3e-3 for the seventh
    harmonic. The nodes reach four coarse samples past the beginning, where the samples are there already.

    Parameters
    ----------
    waveforms : Waveforms
        The record.
    series : function
        Gives an array, shape (..., n), from a segment of n samples; NaN during its first cycle and a few samples.
    frequency_hz : float
        Frequency of the fundamental (Hz).
    cycles : int
        How many cycles a value is made of.
    channels : iterable of str, optional
        What of the record the series is made of; all of it by default.

    Returns
    -------
    list of array, shape (..., n)
        NaN in the first cycle of the record, and of a segment whose grid does not fit the record before it.
    """
    needed = waveforms.names if channels is None else [name for name in waveforms.names if name in set(channels)]
    found = []
    for index, segment in enumerate(waveforms):
        values = series(segment)
        if (
            index > 0
            and len(segment)
            and (head := _with_lead_in(waveforms, index, frequency_hz, cycles, needed)) is not None
        ):
            lead, extended = head
            known = series(extended)[..., lead:]
            values[..., : known.shape[-1]] = known
        found.append(values)
    return found


def _with_lead_in(
    waveforms: Waveforms, index: int, frequency_hz: float, cycles: int, channels: Sequence[str]
) -> tuple[int, Segment] | None:
    """First cycles of a segment behind as many before it, and how many samples the latter has; None if it has none."""
    segment = waveforms.segments[index]
    needed = math.ceil(cycles / (frequency_hz * segment.dt_s)) + _SPARE
    start_s = segment.t0_s - needed * segment.dt_s
    near = [s for s in waveforms.segments[: index + 1] if s.end_s >= start_s]
    margin_s = INTERPOLATION_NODES * max(s.dt_s for s in near)
    try:
        pieces = [Segment(s.t0_s, s.dt_s, {name: s[name] for name in channels}) for s in near]
        before = _picked([piece.slice(start_s - margin_s, segment.t0_s + margin_s) for piece in pieces])
        lead = _resampled(before, segment, needed)
    except MeasurementError:
        return None
    extended = {name: np.concatenate([x, segment[name][:needed]]) for name, x in lead.items()}
    samples = len(next(iter(lead.values())))
    return samples, Segment(segment.t0_s - samples * segment.dt_s, segment.dt_s, extended)


def _resampled(before: Segment, segment: Segment, needed: int) -> dict[str, Samples]:
    """Channels of a record at the samples right before a segment, as many as needed or as there are.

    Raises
    ------
    MeasurementError
        When the record does not reach to the segment.
    """
    ratio = round(before.dt_s / segment.dt_s)
    samples = round((segment.t0_s - before.t0_s) / segment.dt_s)
    if samples > ratio * (len(before) - 1) + 1:
        raise MeasurementError(f"the record before {segment.t0_s:.3f} s has a gap")
    begin = max(samples - needed, 0)
    names, channels = list(before.channels), np.stack(list(before.channels.values()))
    return dict(zip(names, _finer(channels, ratio)[:, begin:samples], strict=True))


def _finer(x: Samples, ratio: int) -> Samples:
    """Channels on a grid that is finer by a whole number, from the first to the last sample of the coarse one.

    Shape (channels, n) becomes (channels, ratio * (n - 1) + 1).
    """
    if ratio == 1:
        return x
    last = x.shape[-1] - 1
    around = np.clip(np.arange(last)[:, np.newaxis] + _NODES, 0, last)
    between = (x[:, around] @ _lagrange_weights(ratio)).reshape(len(x), -1)
    return np.concatenate([between, x[:, -1:]], axis=-1)


@lru_cache(maxsize=16)
def _lagrange_weights(ratio: int) -> Samples:
    """Weights of the nodes for each of so many places from one sample to the next, shape (nodes, places)."""
    at = np.arange(ratio) / ratio
    others = [_NODES[node != _NODES, np.newaxis] for node in _NODES]
    return np.array([np.prod((at - o) / (node - o), axis=0) for node, o in zip(_NODES, others, strict=True)])


class _Pick(NamedTuple):
    """Samples of a piece that lie on a common grid, and the number of the first on it."""

    first: int
    samples: Segment


def _picked(pieces: Sequence[Segment]) -> Segment:
    """Samples of successive pieces on the grid of the coarsest.

    Raises
    ------
    MeasurementError
        When their grids do not fit.
    """
    present = [piece for piece in pieces if len(piece)]
    if not present:
        raise MeasurementError("there are no samples")
    coarsest = max(present, key=lambda piece: piece.dt_s)
    picks = [pick for piece in present if len((pick := _pick(piece, coarsest)).samples)]
    if any(b.first != a.first + len(a.samples) for a, b in pairwise(picks)):
        raise MeasurementError(f"samples are missing {_between(present)}")
    channels = {name: np.concatenate([pick.samples[name] for pick in picks]) for name in coarsest.channels}
    return Segment(picks[0].samples.t0_s, coarsest.dt_s, channels)


def _pick(piece: Segment, grid: Segment) -> _Pick:
    stride = grid.dt_s / piece.dt_s
    first = math.ceil((piece.t0_s - grid.t0_s) / grid.dt_s - _ON_GRID / stride)
    offset = (grid.t0_s - piece.t0_s) / piece.dt_s + first * stride
    if abs(stride - round(stride)) > _ON_GRID or abs(offset - round(offset)) > _ON_GRID:
        raise MeasurementError(
            f"there is a change of the sampling step to one that does not fit {_between([piece, grid])}"
        )
    channels = {name: x[round(offset) :: round(stride)] for name, x in piece.channels.items()}
    return _Pick(first, Segment(grid.t0_s + first * grid.dt_s, grid.dt_s, channels))


def _between(pieces: Sequence[Segment]) -> str:
    return f"between {min(p.t0_s for p in pieces):.3f} s and {max(p.end_s for p in pieces):.3f} s"
