"""Voltage events: when they start and end, and of what kind they are."""

from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.waveforms.container import Samples

Kind = Literal["sag", "swell", "interruption"]


class EventThresholds(NamedTuple):
    """Where events begin and end (pu). What has no threshold to enter is not looked for."""

    enter_below: float | None = None  # a sag starts with the low voltage under this ...
    leave_above: float | None = None  # ... and ends with it over this; the same where None
    enter_above: float | None = None  # a swell starts with the high voltage over this ...
    leave_below: float | None = None  # ... and ends with it under this; the same where None
    interruption_below: float | None = None  # a sag during which the high voltage too is under this


class VoltageEvent(NamedTuple):
    """One event; it has no end when the record ends first."""

    start_s: float
    end_s: float | None
    kind: Kind


def detect_events(
    t_s: Samples, u_low: Samples, u_high: Samples, thresholds: EventThresholds
) -> tuple[VoltageEvent, ...]:
    """Sags, interruptions and swells of a record, in order of their start.

    With hysteresis, as IEC 61000-4-30, clauses 5.4 and 5.5, detects them on U_rms(1/2): from the first sample strictly
    beyond the threshold to enter, to the first strictly beyond the threshold to leave. Samples that are not numbers
    neither start nor end anything. The instants are those of the series: a one-cycle voltage sees a start a part of a
    cycle late and an end up to one cycle late.

    Parameters
    ----------
    t_s : array, shape (n,)
        Instants (s), rising.
    u_low, u_high : array, shape (n,)
        The lowest and the highest of the voltages that a code judges (pu); twice the same for a single one, such as V+.
    thresholds : EventThresholds
        Of the profile.

    Raises
    ------
    MeasurementError
        When a threshold to leave lies on the wrong side of the one to enter.
    """
    events = _sags(t_s, u_low, u_high, thresholds) + _swells(t_s, u_high, thresholds)
    return tuple(sorted(events, key=lambda event: event.start_s))


def _sags(t_s: Samples, u_low: Samples, u_high: Samples, thresholds: EventThresholds) -> list[VoltageEvent]:
    enter, leave = thresholds.enter_below, thresholds.leave_above
    if enter is None:
        return []
    leave = enter if leave is None else leave
    if leave < enter:
        raise MeasurementError(f"a sag below {enter:g} pu cannot end above {leave:g} pu: that is lower")
    limit = thresholds.interruption_below
    found = []
    for first, end in _stretches(u_low < enter, u_low > leave):
        dead = limit is not None and bool((u_high[first:end] < limit).any())
        found.append(_event(t_s, first, end, "interruption" if dead else "sag"))
    return found


def _swells(t_s: Samples, u_high: Samples, thresholds: EventThresholds) -> list[VoltageEvent]:
    enter, leave = thresholds.enter_above, thresholds.leave_below
    if enter is None:
        return []
    leave = enter if leave is None else leave
    if leave > enter:
        raise MeasurementError(f"a swell above {enter:g} pu cannot end below {leave:g} pu: that is higher")
    return [_event(t_s, first, end, "swell") for first, end in _stretches(u_high > enter, u_high < leave)]


def _event(t_s: Samples, first: int, end: int, kind: Kind) -> VoltageEvent:
    return VoltageEvent(float(t_s[first]), float(t_s[end]) if end < len(t_s) else None, kind)


def _stretches(enter: NDArray[np.bool_], leave: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Indices from where one mask holds to where the other first does: pairs of first and end."""
    if not enter.any():
        return []
    marked = np.flatnonzero(enter | leave)  # what neither enters nor leaves changes nothing
    inside = enter[marked]
    changes = marked[1:][inside[1:] != inside[:-1]].tolist()
    edges = [*([int(marked[0])] if inside[0] else []), *changes, *([len(enter)] if inside[-1] else [])]
    return list(zip(edges[::2], edges[1::2], strict=True))
