"""Stretches of a record beyond a level, and the time spent in them."""

import numpy as np

from pvlvrt_compliance.evidence.series import Mask
from pvlvrt_compliance.measure.windows import Span
from pvlvrt_compliance.waveforms.container import Samples


def excursions(
    beyond: Mask, t_s: Samples, steps_s: tuple[float, ...] = (), lag_s: float = 0.0, gap_s: float = 0.0
) -> list[Span]:
    """Find the stretches of a mask.

    Parameters
    ----------
    beyond : array of bool, shape (n,)
        Where the measured quantity lies beyond the level.
    t_s : array, shape (n,)
        Instants of the samples (s).
    steps_s : tuple of float
        Instants at which what is measured is known to jump (s). A stretch that begins or ends up to ``lag_s`` after one
        of them began or ended there: the measurement shows it late.
    lag_s : float
        Delay of the measurement (s).
    gap_s : float
        Stretches no further apart than this are one (s).

    Returns
    -------
    list of Span
        In order of time; those that the delay alone had made are left out.
    """
    found: list[Span] = []
    for first, end in runs_of(beyond):
        begin_s = _anchored(float(t_s[first]), steps_s, lag_s)
        # A stretch to the end of the record has no end that a step could have made.
        end_s = float(t_s[-1]) if end == len(t_s) else _anchored(float(t_s[end]), steps_s, lag_s)
        if found and begin_s - found[-1].end_s <= gap_s:
            found[-1] = Span(found[-1].start_s, max(end_s, found[-1].end_s))
        elif end_s > begin_s:
            found.append(Span(begin_s, end_s))
    return found


def runs_of(mask: Mask) -> list[tuple[int, int]]:
    """First sample and end of each stretch of samples that a mask holds without a break."""
    if not mask.any():
        return []
    edges = (np.flatnonzero(mask[1:] != mask[:-1]) + 1).tolist()
    edges = [*([0] if mask[0] else []), *edges, *([len(mask)] if mask[-1] else [])]
    return list(zip(edges[::2], edges[1::2], strict=True))


def time_spent_s(found: list[Span], t_s: Samples, window_s: float | None) -> Samples:
    """Time in the excursions up to each instant (s): of the present one, or of all within the sliding window if more.

    Zero outside of excursions; shape of ``t_s``. An excursion longer than the window counts in full.
    """
    inside, present, total = inside_of(found, t_s), np.zeros(len(t_s)), np.zeros(len(t_s))
    for begin_s, end_s in found:
        since = slice(int(np.searchsorted(t_s, begin_s)), len(t_s))
        present[since] = t_s[since] - begin_s
        if window_s is not None:
            total += _overlap(t_s, begin_s, end_s, window_s)
    return np.where(inside, np.maximum(present, total), 0.0)


def inside_of(found: list[Span], t_s: Samples) -> Mask:
    """Mask of the instants that lie in an excursion, its end left out."""
    inside = np.zeros(len(t_s), dtype=np.bool_)
    for begin_s, end_s in found:
        inside[slice(*np.searchsorted(t_s, (begin_s, end_s)))] = True
    return inside


def _overlap(t_s: Samples, begin_s: float, end_s: float, window_s: float) -> Samples:
    overlap: Samples = np.maximum(np.minimum(t_s, end_s) - np.maximum(t_s - window_s, begin_s), 0.0)
    return overlap


def _anchored(at_s: float, steps_s: tuple[float, ...], lag_s: float) -> float:
    return max((step_s for step_s in steps_s if at_s - lag_s <= step_s <= at_s), default=at_s)
