"""How fast and how well a quantity goes from one value to another after an event."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.waveforms.container import Samples

_AT_A_TIME = 4096  # samples


class Tolerance(NamedTuple):
    """Tolerance around the final value, as fractions of the change, seen in the direction of the change."""

    short: float  # may stay this far short of the final value
    beyond: float  # may go this far beyond it


class StepResponse(NamedTuple):
    """Times (s) by IEC 61400-21-1; None where the quantity never gets there."""

    reaction_s: float | None  # event to 10 % of the change
    rise_s: float | None  # 10 % to 90 %
    response_s: float | None  # event to 90 %
    settling_s: float | None  # event to the last entry into the tolerance band
    overshoot: float  # furthest beyond the final value, as a fraction of the change


def step_response(
    t_s: Samples, x: Samples, event_s: float, initial: float, final: float, band: Tolerance
) -> StepResponse:
    """Reaction, rise, response and settling time and overshoot of a step.

    On y = (x - initial) / (final - initial): the first instants at which y reaches 0.1 and 0.9, and the instant after
    which 1 - short <= y <= 1 + beyond to the end of the series; straight lines between the samples.
    Definitions of IEC 61400-21-1:2019, as NTS 631 uses them. The delay of the series is part of all times but the rise.

    Parameters
    ----------
    t_s, x : array, shape (n,)
        Instants (s), rising, and the quantity at them; cut it where the next event begins.
    event_s : float
        Instant of the event (s).
    initial, final : float
        Value before the event, and value that is asked for or reached, in the unit of x.
    band : Tolerance
        Tolerance band; a tolerance in the unit of x is divided by the change first.

    Raises
    ------
    MeasurementError
        When initial and final are the same, the band is inside out, or the series after the event is empty or not
        finite.
    """
    t, y = _after(t_s, x, event_s)
    change = final - initial
    if not abs(change) > 0:
        raise MeasurementError("there is no change to measure a response of")
    if band.short + band.beyond <= 0:
        raise MeasurementError("the tolerance band has no width")
    y = y - initial
    y /= change
    reaction, response = first_reached(t, y, 0.1), first_reached(t, y, 0.9)
    settled = last_entry(t, y, 1 - band.short, 1 + band.beyond)
    return StepResponse(
        reaction_s=_since(event_s, reaction),
        rise_s=None if reaction is None or response is None else response - reaction,
        response_s=_since(event_s, response),
        settling_s=_since(event_s, settled),
        overshoot=max(float(y.max()) - 1, 0.0),
    )


def _after(t_s: Samples, x: Samples, event_s: float) -> tuple[Samples, Samples]:
    first = int(np.searchsorted(t_s, event_s))
    if first == len(t_s):
        raise MeasurementError(f"the series ends before the event at {event_s:.3f} s")
    if not np.isfinite(x[first:]).all():
        raise MeasurementError("the response has values that are not finite")
    return t_s[first:], x[first:]


def _since(event_s: float, t_s: float | None) -> float | None:
    return None if t_s is None else t_s - event_s


def first_reached(t: Samples, y: Samples, level: float) -> float | None:
    """First instant (s) at which a series is at or above a level, None when it never is; shapes (n,)."""
    for begin in range(0, len(y), _AT_A_TIME):  # as a rule that is soon
        reached = y[begin : begin + _AT_A_TIME] >= level
        first = int(reached.argmax())
        if reached[first]:
            return _crossing(t, y, begin + first, level)
    return None


def last_entry(t: Samples, y: Samples, low: float, high: float) -> float | None:
    """Instant (s) from which a series stays between two levels, None when it ends outside; shapes (n,)."""
    first = settled_from((y < low) | (y > high))
    if not first:
        return None if first is None else float(t[0])
    return _crossing(t, y, first, low if y[first - 1] < low else high)


def settled_from(outside: NDArray[np.bool_]) -> int | None:
    """First sample after the last that lies outside, shape (n,): 0 where none does, None where the last one does."""
    since = int(outside[::-1].argmax()) if len(outside) else 0  # samples after the last one outside
    if not len(outside) or not outside[len(outside) - 1 - since]:
        return 0
    return len(outside) - since if since else None


def _crossing(t: Samples, y: Samples, k: int, level: float) -> float:
    """Instant between samples k - 1 and k at which a straight line reaches a level."""
    if k == 0:
        return float(t[0])
    part = (level - y[k - 1]) / (y[k] - y[k - 1])
    return float(t[k - 1] + part * (t[k] - t[k - 1]))
