"""Extremes, means and response times of each stretch between steps, as a test bench tells them by its cursors."""

import math
from collections.abc import Callable, Collection, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.disturbance.model import Stretch
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.evidence.frequency import frequency_hz
from pvlvrt_compliance.evidence.stretches import settling_s, surely_over_s
from pvlvrt_compliance.measure.durations import mean_over_time
from pvlvrt_compliance.measure.extremes import ROUNDING
from pvlvrt_compliance.measure.quantities import Cursor, CursorStretch
from pvlvrt_compliance.measure.response import Tolerance, step_response
from pvlvrt_compliance.measure.windows import Span, last_window
from pvlvrt_compliance.waveforms.container import Samples

_SAME_INSTANT_S = 1e-9
_PERCENT = 100

_Values = dict[str, float | None]


class _Quantity(NamedTuple):
    """A series that cursors are set on, and what its least change that is timed is (its unit)."""

    name: str
    series: Samples  # shape (n,)
    least: float


def cursors_of(evidence: Evidence, limited: Collection[str]) -> tuple[CursorStretch, ...]:
    """Cursors of the window before the disturbance, and of what follows each step of anything up to a trip.

    Least, largest and mean value are those from `settled_cycles` after the step to the end of the stretch: before,
    the window of a one-cycle value still reaches back beyond the step. The times are those of
    `measure.response.step_response` on the whole stretch, of the change from the mean of the last cycle before the step
    to the mean of the last settled cycles (`measure.windows.last_window`), the band being `response_band` of it.
    None are given where something ramps, where no settled cycle fits, and of a change under `response_least_pu` (of
    the frequency, under `frequency_deviation_hz`), which measurement would leave open.

    Parameters
    ----------
    evidence : Evidence
        The record; a quantity whose channels it lacks, or that is not finite in a stretch, has no cursor there.
    limited : collection of str
        Names of `results.Band`: the reactive currents have cursors where limits of them are drawn.

    Returns
    -------
    tuple of CursorStretch
        None at all where there is no frequency to count cycles of.
    """
    try:
        cycle_s, end_s = 1 / evidence.frequency_hz, evidence.known_opening_s
    except MeasurementError:
        return ()
    quantities = list(_quantities(evidence, limited))
    stretches = evidence.disturbance.following_stretches(evidence.record_end_s if end_s is None else end_s)
    found = [_of_stretch(evidence, stretch, quantities, cycle_s) for stretch in stretches]
    before = _before(evidence, quantities)
    return (*([before] if before else []), *found)


def _quantities(evidence: Evidence, limited: Collection[str]) -> Iterator[_Quantity]:
    """Those that the record has."""
    least = evidence.thresholds.response_least_pu.value
    power = least * evidence.nominal.apparent_power_kva
    wanted: list[tuple[str, Callable[[], Samples], float]] = [
        ("voltage_positive_pu", lambda: evidence.voltage_positive_pu, least),
        ("voltage_negative_pu", lambda: evidence.voltage_negative_pu, least),
        ("active_power_kw", lambda: evidence.active_power_kw, power),
        ("reactive_power_kvar", lambda: evidence.reactive_power_kvar, power),
        ("current_pu", lambda: evidence.largest_current_pu, least),
    ]
    if "reactive_current_pu" in limited:
        wanted.append(("reactive_current_pu", lambda: evidence.reactive_current_pu, least))
    if "reactive_current_negative_pu" in limited:
        wanted.append(("reactive_current_negative_pu", lambda: evidence.reactive_current_negative_pu, least))
    wanted.append(("dc_voltage_v", lambda: evidence.dc_voltage_v, least * _dc_before_v(evidence)))
    if evidence.disturbance.frequency_moves:
        near_hz = evidence.thresholds.frequency_deviation_hz.value
        wanted.append(("frequency_hz", lambda: frequency_hz(evidence), near_hz))
    for name, series, least_change in wanted:
        try:
            yield _Quantity(name, series(), least_change)
        except MeasurementError:  # a recording may lack the channels
            continue


def _dc_before_v(evidence: Evidence) -> float:
    """1 pu of the DC voltage: its mean before the disturbance (V); where that is not known, no change is timed."""
    before = evidence.measurements.before
    return np.inf if before is None or before.dc_voltage_mean_v is None else before.dc_voltage_mean_v


def _before(evidence: Evidence, quantities: list[_Quantity]) -> CursorStretch | None:
    window = evidence.measurements.before
    if window is None:
        return None
    cursors = _cursors(_extremes(evidence, quantities, Span(window.start_s, window.end_s)))
    return CursorStretch(begin_s=window.start_s, end_s=window.end_s, is_before=True, cursors=cursors)


def _cursors(found: dict[str, _Values]) -> tuple[Cursor, ...]:
    return tuple(Cursor(quantity=name, **values) for name, values in found.items())


def _of_stretch(evidence: Evidence, stretch: Stretch, quantities: list[_Quantity], cycle_s: float) -> CursorStretch:
    end_s = surely_over_s(evidence, stretch.end_s)
    before_s = surely_over_s(evidence, stretch.begin_s)
    final = None if stretch.ramps else last_window(stretch.begin_s, end_s, evidence.frequency_hz, evidence.rules)
    found = _extremes(evidence, quantities, Span(stretch.begin_s + settling_s(evidence), end_s))
    if final is not None:
        levels = [_means(evidence, quantities, span) for span in (Span(before_s - cycle_s, before_s), final)]
        for quantity, *ends in zip(quantities, *levels, strict=True):
            if quantity.name in found:
                found[quantity.name] |= _timed(evidence, quantity, Span(stretch.begin_s, end_s), ends)
    return CursorStretch(
        begin_s=stretch.begin_s,
        end_s=stretch.end_s,
        in_words=stretch.in_words,
        band_percent=_PERCENT * evidence.thresholds.response_band.value,
        cursors=_cursors(found),
    )


def _inside(evidence: Evidence, span: Span) -> slice:
    """Samples from one instant up to another, at which something else begins."""
    return evidence.samples_before(span.start_s, span.end_s - _SAME_INSTANT_S)


def _extremes(evidence: Evidence, quantities: list[_Quantity], span: Span) -> dict[str, _Values]:
    """Values of cursors by quantity, of those that are finite in a span that holds a sample."""
    inside = _inside(evidence, span)
    if inside.start == inside.stop or not quantities:
        return {}
    means = _means(evidence, quantities, span)
    ends = [(float(of.series[inside].min()), float(of.series[inside].max())) for of in quantities]
    return {
        of.name: {"minimum": minimum, "maximum": maximum, "mean": mean}
        for of, (minimum, maximum), mean in zip(quantities, ends, means, strict=True)
        if math.isfinite(minimum) and math.isfinite(maximum) and math.isfinite(mean)  # their sum may be beyond numbers
    }


def _means(evidence: Evidence, quantities: list[_Quantity], span: Span) -> list[float]:
    """Means over time, not finite where a quantity is not everywhere, or the span holds no sample."""
    inside = _inside(evidence, span)
    if inside.start == inside.stop:
        return [math.nan] * len(quantities)
    with np.errstate(invalid="ignore"):
        return [mean_over_time(of.series[inside], evidence.step_s[inside]) for of in quantities]


def _timed(evidence: Evidence, quantity: _Quantity, span: Span, levels: Sequence[float]) -> _Values:
    """Levels before and after a step, and the times between them where they can be told."""
    initial, final = levels
    if not (math.isfinite(initial) and math.isfinite(final)):
        return {}
    found: _Values = {"initial": initial, "final": final}
    inside = _inside(evidence, span)
    x = quantity.series[inside]
    # A change of just the least is timed, whichever way its means are rounded.
    if abs(final - initial) >= quantity.least * (1 - ROUNDING):
        band = evidence.thresholds.response_band.value
        try:
            response = step_response(evidence.t_s[inside], x, span.start_s, initial, final, Tolerance(band, band))
        except MeasurementError:  # it is not finite
            return found
        found |= {
            "reaction_s": response.reaction_s,
            "rise_s": response.rise_s,
            "response_s": response.response_s,
            "settling_s": response.settling_s,
            "overshoot_percent": percent if math.isfinite(percent := _PERCENT * response.overshoot) else None,
        }
    return found
