"""Long series as few points: curves that lose no peak, bands that hold every sample."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.evidence.outline import bends
from pvlvrt_compliance.report.drawing.model import OnGrid, Run, Strip
from pvlvrt_compliance.report.drawing.parts import Part
from pvlvrt_compliance.waveforms.container import Samples

Index = NDArray[np.int64]

_SMOOTH = 5.0  # of the finest: what a curve may leave out that stands for a band


def sketched(series: Samples, parts: Sequence[Part], fine: float) -> tuple[tuple[Run, ...], tuple[Strip, ...]]:
    """A series as curves and bands.

    Every point of a curve is a sample of the series, at its instant. A band holds every sample, and each of its corners
    is a sample of the buckets beside it.

    Parameters
    ----------
    series : array, shape (n,)
        One value a sample of the record; what is not finite is a gap.
    parts : sequence of Part
        What is drawn how.
    fine : float
        Points nearer than this to a straight line through their neighbours are left out.
    """
    finite = np.where(np.isfinite(series), series, np.nan)
    banded = [part.is_band and not _is_smooth(_samples(finite, part), part, fine) for part in parts]
    runs = [run for part, band in zip(parts, banded, strict=True) if not band for run in _run(finite, part, fine)]
    strips = [strip for part, band in zip(parts, banded, strict=True) if band for strip in _strip(finite, part, fine)]
    return tuple(runs), tuple(strips)


def _is_smooth(samples: Samples, part: Part, fine: float) -> bool:
    """Whether a curve through a few points is all that a band would hold: there is no wave between them."""
    index = picked(samples, part.half_bucket)
    curve = np.interp(np.arange(len(samples)), index, samples[index])
    off = np.abs(curve - samples)
    return bool((np.isnan(samples) == np.isnan(curve)).all() and (off[np.isfinite(off)] <= _SMOOTH * fine).all())


def _run(series: Samples, part: Part, fine: float) -> Iterator[Run]:
    x = _samples(series, part)
    index = picked(x, part.half_bucket)
    index = index[_without_gaps_at_the_ends(x[index])]
    if len(index):
        index = index[bends(fine, index.astype(np.float64), x[index])]
        yield Run(OnGrid(part.grid.t0_s, part.grid.dt_s, part.first + index), x[index])


def _strip(series: Samples, part: Part, fine: float) -> Iterator[Strip]:
    x = _samples(series, part)
    edges = bucket_edges(part.end - part.first, part.buckets)
    lower, upper = enveloped(x, edges)
    for known in _between_gaps(lower):
        kept = known[bends(fine, edges[known].astype(np.float64), lower[known], upper[known])]
        yield Strip(OnGrid(part.grid.t0_s, part.grid.dt_s, part.first + edges[kept]), lower[kept], upper[kept])


def _samples(series: Samples, part: Part) -> Samples:
    """Samples of a part, with the one that follows and closes it."""
    begin = part.offset + part.first
    return series[begin : part.offset + part.end + (1 if part.goes_on else 0)]


def picked(samples: Samples, half: int) -> Index:
    """Samples that a curve is drawn through: at most two a bucket, and the first and the last.

    A bucket gives the samples at the middle of its halves, so a smooth curve stays smooth when zoomed into; where its
    minimum or maximum is extreme among the neighbouring buckets, too, that sample takes the place of its half's.

    Parameters
    ----------
    samples : array, shape (n,)
        The signal.
    half : int
        Samples of half a bucket; 1 gives all.
    """
    count = len(samples)
    if half == 1:
        return np.arange(count)
    filled = np.append(samples, np.repeat(samples[-1:], -count % (2 * half)))
    rows = filled.reshape(-1, 2 * half)
    places = np.tile([half // 2, half + half // 2], (len(rows), 1))
    _keep_extremes(rows, places)
    index = np.minimum((places + 2 * half * np.arange(len(rows))[:, np.newaxis]).ravel(), count - 1)
    with_ends = np.concatenate([[0], index, [count - 1]])
    found: Index = with_ends[np.append(True, np.diff(with_ends) > 0)]
    return found


def _keep_extremes(rows: Samples, places: Index) -> None:
    """Put local extremes into ``places``, shape (buckets, 2), in the order in which they occur."""
    each = np.arange(len(rows))
    gaps = np.isnan(rows)
    highs, lows = (np.where(gaps, x, rows) if gaps.any() else rows for x in (-np.inf, np.inf))
    at_max, at_min = highs.argmax(axis=1), lows.argmin(axis=1)
    is_peak, is_trough = _is_local_peak(rows[each, at_max]), _is_local_peak(-rows[each, at_min])
    half = rows.shape[1] // 2
    both = is_peak & is_trough
    to_max = np.where(both, at_max > at_min, at_max >= half).astype(int)
    to_min = np.where(both, at_max <= at_min, at_min >= half).astype(int)
    places[each[is_peak], to_max[is_peak]] = at_max[is_peak]
    places[each[is_trough], to_min[is_trough]] = at_min[is_trough]


def _is_local_peak(x: Samples) -> NDArray[np.bool_]:
    known = np.where(np.isnan(x), -np.inf, x)
    rises, falls = known[1:] >= known[:-1], known[:-1] >= known[1:]
    peak: NDArray[np.bool_] = np.append(True, rises) & np.append(falls, True)
    return peak


def bucket_edges(count: int, buckets: int) -> Index:
    """Samples at which the buckets of so many samples begin, and their end, shape (buckets + 1,)."""
    return np.linspace(0, count, min(buckets, count) + 1).round().astype(np.int64)


def enveloped(samples: Samples, edges: Index) -> tuple[Samples, Samples]:
    """Lower and upper line of a band at the edges of its buckets, shape (buckets + 1,) each.

    At an edge the least and the most of the buckets on both sides: straight lines between them hold every sample.
    """
    with np.errstate(invalid="ignore"):
        least = np.fmin.reduceat(samples, edges[:-1])
        most = np.fmax.reduceat(samples, edges[:-1])
    lower = np.fmin(np.append(least, np.nan), np.append(np.nan, least))
    upper = np.fmax(np.append(most, np.nan), np.append(np.nan, most))
    return lower, upper


def _between_gaps(x: Samples) -> list[Index]:
    """Stretches of points that are finite."""
    known = np.flatnonzero(np.isfinite(x))
    return [stretch for stretch in np.split(known, np.flatnonzero(np.diff(known) > 1) + 1) if len(stretch)]


def _without_gaps_at_the_ends(x: Samples) -> slice:
    known = np.flatnonzero(np.isfinite(x))
    return slice(int(known[0]), int(known[-1]) + 1) if len(known) else slice(0, 0)
