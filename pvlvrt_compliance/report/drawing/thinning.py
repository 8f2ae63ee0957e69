"""Long series as few points: curves that lose no peak, bands that hold every sample."""

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.evidence.outline import bends_of_each
from pvlvrt_compliance.report.drawing.model import OnGrid, Run, Strip
from pvlvrt_compliance.report.drawing.parts import Part
from pvlvrt_compliance.waveforms.container import Samples

Index = NDArray[np.int64]

_SMOOTH = 5.0  # of the finest: what a curve may leave out that stands for a band
_FIRST_LOOK = 64  # samples that tell of most waves that no curve through few points is one
_AT_ONCE = 50_000  # samples of several series that are looked at together: what a processor has close at hand


class Series(NamedTuple):
    """What is drawn: one value a sample of the record; what is not finite is a gap.

    Points nearer than ``fine`` to a straight line through their neighbours are left out.
    """

    samples: Samples
    fine: float


class Sketch(NamedTuple):
    """A series as curves and bands.

    Every point of a curve is a sample of the series, at its instant. A band holds every sample, and each of its corners
    is a sample of the buckets beside it.
    """

    runs: tuple[Run, ...]
    strips: tuple[Strip, ...]


class _Points(NamedTuple):
    """Points of one series in one part before those that a straight line needs not are left out."""

    of: int  # series
    part: Part
    places: Index  # of the part's samples
    lines: tuple[Samples, ...]  # of a curve one, of a band two


def sketched(series: Samples, parts: Sequence[Part], fine: float) -> Sketch:
    """One series as curves and bands; see `sketches`."""
    (sketch,) = sketches([Series(series, fine)], parts)
    return sketch


def sketches(series: Sequence[Series], parts: Sequence[Part]) -> list[Sketch]:
    """Series of one record as curves and bands, all at once.

    Parameters
    ----------
    series : sequence of Series
        Of the same record.
    parts : sequence of Part
        What is drawn how.
    """
    curves: list[_Points] = []
    bands: list[_Points] = []
    for part in parts:
        many = max(_AT_ONCE // max(part.end - part.first, 1), 1)
        for first in range(0, len(series), many):
            _look_at(range(first, min(first + many, len(series))), series, part, curves, bands)
    runs = _drawn(curves, series, Run)
    strips = _drawn(bands, series, Strip)
    return [Sketch(tuple(a), tuple(b)) for a, b in zip(runs, strips, strict=True)]


def _drawn(found: Sequence[_Points], series: Sequence[Series], make: Callable[..., Any]) -> list[list[Any]]:
    """What is made of the points that are needed, by the series."""
    made: list[list[Any]] = [[] for _ in series]
    if not found:
        return made
    counts = [len(points.places) for points in found]
    fine = np.array([series[points.of].fine for points in found])
    index = np.concatenate([points.places for points in found])
    lines = [np.concatenate(line) for line in zip(*(points.lines for points in found), strict=True)]
    kept = bends_of_each(fine, counts, index.astype(np.float64), *lines)
    for points, end, count in zip(found, np.cumsum(counts).tolist(), counts, strict=True):
        here = kept[end - count : end]
        grid = OnGrid(points.part.grid.t0_s, points.part.grid.dt_s, points.part.first + points.places[here])
        made[points.of].append(make(grid, *(line[here] for line in points.lines)))
    return made


def _look_at(numbers: range, series: Sequence[Series], part: Part, curves: list[_Points], bands: list[_Points]) -> None:
    """Add the points of some series in a part to those of curves or of bands."""
    rows = _rows([_samples(series[k].samples, part) for k in numbers], 2 * part.half_bucket)
    count = part.end - part.first + (1 if part.goes_on else 0)
    edges = bucket_edges(part.end - part.first, part.buckets) if part.is_band else np.empty(0, dtype=np.int64)
    for number, row, places in zip(numbers, rows[:, :count], picked(rows, count, part.half_bucket), strict=True):
        if part.is_band and not _is_smooth(row, places, series[number].fine):
            lower, upper = enveloped(row, edges)
            for known in _between_gaps(lower):
                bands.append(_Points(number, part, edges[known], (lower[known], upper[known])))
        elif len(places := places[_without_gaps_at_the_ends(row[places])]):
            curves.append(_Points(number, part, places, (row[places],)))


def _rows(signals: Sequence[Samples], whole: int) -> Samples:
    """Signals as the rows of one array, of a whole number of buckets: their last samples go on to its end.

    What is infinite is a gap.
    """
    count = len(signals[0])
    rows = np.empty((len(signals), count + -count % whole))
    for row, signal in zip(rows, signals, strict=True):
        row[:count] = signal
        row[count:] = signal[-1]
    if not _is_finite(rows):
        rows[np.isinf(rows)] = np.nan
    return rows


def _is_finite(x: Samples) -> bool:
    """Whether all values are finite; at a loss for very large ones it says no."""
    with np.errstate(over="ignore", invalid="ignore"):
        return bool(np.isfinite(x.sum()))


def _is_smooth(samples: Samples, index: Index, fine: float) -> bool:
    """Whether a curve through a few points is all that a band would hold: there is no wave between them."""
    places, known, levels = _places(len(samples)), index.astype(np.float64), samples[index]
    return all(
        _is_on_curve(samples[::stride], np.interp(places[::stride], known, levels), _SMOOTH * fine)
        for stride in (max(len(samples) // _FIRST_LOOK, 1), 1)
    )


@lru_cache(maxsize=4)
def _places(count: int) -> Samples:
    """Numbers of so many samples, as what is interpolated between them wants them."""
    places = np.arange(count, dtype=np.float64)
    places.flags.writeable = False
    return places


def _is_on_curve(samples: Samples, curve: Samples, near: float) -> bool:
    off = np.abs(curve - samples)
    if (off <= near).all():
        return True
    return bool((np.isnan(samples) == np.isnan(curve)).all() and (off[np.isfinite(off)] <= near).all())


def _samples(series: Samples, part: Part) -> Samples:
    """Samples of a part, with the one that follows and closes it."""
    begin = part.offset + part.first
    return series[begin : part.offset + part.end + (1 if part.goes_on else 0)]


def picked(rows: Samples, count: int, half: int) -> list[Index]:
    """Samples that a curve is drawn through: at most two a bucket, and the first and the last.

    A bucket gives the samples at the middle of its halves, so a smooth curve stays smooth when zoomed into; where its
    minimum or maximum is extreme among the neighbouring buckets, too, that sample takes the place of its half's.

    Parameters
    ----------
    rows : array, shape (m, n)
        Signals of the same samples: a whole number of buckets.
    count : int
        How many of them there are; the last goes on beyond.
    half : int
        Samples of half a bucket; 1 gives all.

    Returns
    -------
    list of array
        Of each signal.
    """
    if half == 1:
        return [np.arange(count)] * len(rows)
    buckets = rows.reshape(len(rows), -1, 2 * half)
    places = np.empty((*buckets.shape[:2], 2), dtype=np.int64)
    places[:] = half // 2, half + half // 2
    _keep_extremes(buckets, places)
    places += 2 * half * np.arange(buckets.shape[1])[:, np.newaxis]
    with_ends = np.full((len(rows), 2 * buckets.shape[1] + 2), count - 1)
    with_ends[:, 0] = 0
    np.minimum(places.reshape(len(rows), -1), count - 1, out=with_ends[:, 1:-1])
    is_new = np.ones(with_ends.shape, dtype=np.bool_)
    is_new[:, 1:] = with_ends[:, 1:] > with_ends[:, :-1]
    return [index[new] for index, new in zip(with_ends, is_new, strict=True)]


def _keep_extremes(rows: Samples, places: Index) -> None:
    """Put local extremes into ``places``, shape (m, buckets, 2), in the order in which they occur."""
    highs = lows = rows
    if not _is_finite(rows):
        gaps = np.isnan(rows)
        highs, lows = (np.where(gaps, x, rows) for x in (-np.inf, np.inf))
    at_max, at_min = highs.argmax(axis=-1), lows.argmin(axis=-1)
    most, least = (np.take_along_axis(rows, at[..., np.newaxis], axis=-1)[..., 0] for at in (at_max, at_min))
    is_peak, is_trough = _is_local_peak(most), _is_local_peak(-least)
    half = rows.shape[-1] // 2
    both = is_peak & is_trough
    to_max = np.where(both, at_max > at_min, at_max >= half).astype(np.int64)
    to_min = np.where(both, at_max <= at_min, at_min >= half).astype(np.int64)
    for found, at, to in ((is_peak, at_max, to_max), (is_trough, at_min, to_min)):
        row, bucket = np.nonzero(found)
        places[row, bucket, to[found]] = at[found]


def _is_local_peak(x: Samples) -> NDArray[np.bool_]:
    known = np.where(np.isnan(x), -np.inf, x)
    peak = np.ones(known.shape, dtype=np.bool_)
    peak[..., 1:] = known[..., 1:] >= known[..., :-1]
    peak[..., :-1] &= known[..., :-1] >= known[..., 1:]
    return peak


def bucket_edges(count: int, buckets: int) -> Index:
    """Samples at which the buckets of so many samples begin, and their end, shape (buckets + 1,)."""
    return np.linspace(0, count, min(buckets, count) + 1).round().astype(np.int64)


def enveloped(samples: Samples, edges: Index) -> tuple[Samples, Samples]:
    """Lower and upper line of a band at the edges of its buckets, shape (buckets + 1,) each.

    At an edge the least and the most of the buckets on both sides: straight lines between them hold every sample.
    """
    lower, upper = (_at_edges(samples, edges, further) for further in (np.fmin, np.fmax))
    return lower, upper


def _at_edges(samples: Samples, edges: Index, further: np.ufunc) -> Samples:
    with np.errstate(invalid="ignore"):
        inside = further.reduceat(samples, edges[:-1])
        levels: Samples = further(np.append(inside, np.nan), np.append(np.nan, inside))
    return levels


def _between_gaps(x: Samples) -> list[Index]:
    """Stretches of points that are finite."""
    known = np.flatnonzero(np.isfinite(x))
    return [stretch for stretch in np.split(known, np.flatnonzero(np.diff(known) > 1) + 1) if len(stretch)]


def _without_gaps_at_the_ends(x: Samples) -> slice:
    known = np.flatnonzero(np.isfinite(x))
    return slice(int(known[0]), int(known[-1]) + 1) if len(known) else slice(0, 0)
