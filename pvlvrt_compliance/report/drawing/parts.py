"""Where a record is drawn as a curve, and where as a band: by how many points a cycle there are."""

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

from pvlvrt_compliance.waveforms.container import Waveforms

BUCKETS = 1500
"""Buckets of a drawn curve; each gives two points, so that it can keep its minimum and its maximum."""

LEAST_A_CYCLE = 4.0
"""Buckets of a cycle from which on a sine is drawn as a curve: with fewer its points make another one of it."""

_BUCKETS_OF_A_REPORT = 60_000
_FEWEST_BUCKETS = 100
_CLOSE_A_CYCLE = 5.0  # buckets of a cycle that is drawn as a curve between bands
_CYCLES_BEFORE, _LEAST_CYCLES = 1.0, 2.0  # that are drawn as a curve before and after an instant, at least
_SAME_SAMPLE = 1e-3  # of a step
_SHARE_OF_CURVES = 0.5  # of the buckets of a stretch that is drawn as both


class Grid(NamedTuple):
    """Samples of a segment: the k-th at ``t0_s + k * dt_s``."""

    t0_s: float
    dt_s: float
    samples: int

    @property
    def end_s(self) -> float:
        """One step after the last sample (s)."""
        return self.t0_s + self.samples * self.dt_s

    def first_from(self, t_s: float) -> int:
        """Number of the first sample at or after an instant, between 0 and ``samples``."""
        return min(max(math.ceil((t_s - self.t0_s) / self.dt_s - 1e-6), 0), self.samples)


class Part(NamedTuple):
    """Samples of one segment that are drawn alike, from ``first`` up to ``end``."""

    grid: Grid
    first: int
    end: int
    buckets: int
    is_band: bool
    offset: int  # samples of the segments before
    goes_on: bool  # whether a sample follows in the next step, which closes the part

    def buckets_a_cycle(self, cycle_s: float) -> float:
        """Buckets of a cycle; where every sample is drawn, as many as pairs of them."""
        return cycle_s / self.grid.dt_s / (2 * self.half_bucket)

    @property
    def half_bucket(self) -> int:
        """Samples of half a bucket; 1 where every sample is drawn."""
        return max(math.ceil((self.end - self.first) / (2 * self.buckets)), 1)


def buckets_for(figures: int) -> int:
    """Buckets of a curve in a report of so many figures, which a browser must still be able to hold."""
    return max(min(BUCKETS, _BUCKETS_OF_A_REPORT // max(figures, 1)), _FEWEST_BUCKETS)


def grids_of(waveforms: Waveforms) -> tuple[Grid, ...]:
    """The grid of each segment."""
    return tuple(Grid(segment.t0_s, segment.dt_s, len(segment)) for segment in waveforms)


def parts_of(grids: Sequence[Grid], instants_s: Sequence[float], cycle_s: float, buckets: int) -> list[Part]:
    """How a record is drawn: a curve wherever there are `LEAST_A_CYCLE` buckets for a cycle.

    Where there are not, half of them are for curves around each of the instants, the others for bands in between.

    Parameters
    ----------
    grids : sequence of Grid
        The segments of the record.
    instants_s : sequence of float
        When something happens (s).
    cycle_s : float
        A cycle of the fundamental (s).
    buckets : int
        Of the whole record.

    Returns
    -------
    list of Part
        Every sample in one of them, in order.
    """
    found: list[Part] = []
    offset = 0
    for grid, following, share in zip(grids, (*grids[1:], None), _shares(grids, buckets), strict=True):
        goes_on = following is not None and abs(following.t0_s - grid.end_s) < _SAME_SAMPLE * grid.dt_s
        whole = Part(grid, 0, grid.samples, share, is_band=False, offset=offset, goes_on=goes_on)
        offset += grid.samples
        if not grid.samples:
            continue
        if _is_curve(whole, cycle_s):
            found.append(whole)
        else:
            found += _mixed(whole, [t for t in instants_s if _is_in(grid, t)], cycle_s)
    return found


def _is_curve(part: Part, cycle_s: float) -> bool:
    """Whether every sample is drawn, or there are buckets enough for a cycle."""
    return part.half_bucket == 1 or part.buckets_a_cycle(cycle_s) >= LEAST_A_CYCLE


def _is_in(grid: Grid, t_s: float) -> bool:
    return grid.t0_s <= t_s < grid.end_s


def _shares(grids: Sequence[Grid], buckets: int) -> list[int]:
    """Buckets of each segment: the finer it is recorded, the more happens there, so its samples count for more."""
    finest = min(grid.dt_s for grid in grids)
    weights = [grid.samples * math.sqrt(finest / grid.dt_s) for grid in grids]
    return [max(int(buckets * weight / max(sum(weights), 1e-9)), 1) for weight in weights]


def _mixed(whole: Part, instants_s: Sequence[float], cycle_s: float) -> list[Part]:
    """Curves around the instants, bands elsewhere."""
    close = _close_up(whole, instants_s, cycle_s)
    grid = whole.grid
    edges = sorted({0, grid.samples, *(edge for span in close for edge in span)})
    inside = {begin for begin, _ in close}
    banded = sum(end - begin for begin, end in pairwise(edges) if begin not in inside)
    curved_s = grid.dt_s * (grid.samples - banded)
    left = max(whole.buckets - round(curved_s / cycle_s * _CLOSE_A_CYCLE), 1)
    parts = []
    for begin, end in pairwise(edges):
        is_curve = begin in inside
        share = _CLOSE_A_CYCLE * (end - begin) * grid.dt_s / cycle_s if is_curve else left * (end - begin) / banded
        goes_on = whole.goes_on or end < grid.samples
        parts.append(whole._replace(first=begin, end=end, buckets=max(math.ceil(share), 1), goes_on=goes_on))
    return [part if _is_curve(part, cycle_s) else _band(part, cycle_s) for part in parts]


def _band(part: Part, cycle_s: float) -> Part:
    """A part as a band: a bucket holds a cycle at least, so that it reaches from trough to peak."""
    cycles = int((part.end - part.first) * part.grid.dt_s / cycle_s)
    return part._replace(is_band=True, buckets=max(min(part.buckets, cycles), 1))


def _close_up(whole: Part, instants_s: Sequence[float], cycle_s: float) -> list[tuple[int, int]]:
    """Samples around instants that half of the buckets are enough to draw as a curve: first and end of each span."""
    affordable = whole.buckets * _SHARE_OF_CURVES / _CLOSE_A_CYCLE
    chosen = sorted(set(instants_s))
    if len(chosen) * (_CYCLES_BEFORE + _LEAST_CYCLES) > affordable:
        chosen = sorted({chosen[0], chosen[-1]})
    if not chosen or len(chosen) * (_CYCLES_BEFORE + _LEAST_CYCLES) > affordable:
        return []
    after_s = (affordable / len(chosen) - _CYCLES_BEFORE) * cycle_s
    spans: list[tuple[int, int]] = []
    for t_s in chosen:
        begin = whole.grid.first_from(t_s - _CYCLES_BEFORE * cycle_s)
        end = whole.grid.first_from(t_s + after_s)
        if spans and begin <= spans[-1][1]:
            begin = spans.pop()[0]
        if end > begin:
            spans.append((begin, end))
    return spans
