"""Extremes, means and response times of each stretch between steps, as a test bench tells them by its cursors."""

from collections.abc import Callable, Collection, Iterator
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.disturbance.model import Stretch
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.evidence.frequency import frequency_hz
from pvlvrt_compliance.evidence.stretches import settling_s, surely_over_s
from pvlvrt_compliance.measure.quantities import Cursor, CursorStretch
from pvlvrt_compliance.measure.response import Tolerance, step_response
from pvlvrt_compliance.measure.windows import Span, last_window
from pvlvrt_compliance.waveforms.container import Samples

_SAME_INSTANT_S = 1e-9
_PERCENT = 100


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
        ("current_pu", lambda: np.max(evidence.current_phase_pu, axis=0), least),
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
    found = [_extremes(evidence, quantity, Span(window.start_s, window.end_s)) for quantity in quantities]
    cursors = tuple(cursor for cursor in found if cursor is not None)
    return CursorStretch(begin_s=window.start_s, end_s=window.end_s, is_before=True, cursors=cursors)


def _of_stretch(evidence: Evidence, stretch: Stretch, quantities: list[_Quantity], cycle_s: float) -> CursorStretch:
    end_s = surely_over_s(evidence, stretch.end_s)
    before_s = surely_over_s(evidence, stretch.begin_s)
    final = None if stretch.ramps else last_window(stretch.begin_s, end_s, evidence.frequency_hz, evidence.rules)
    cursors = []
    for quantity in quantities:
        cursor = _extremes(evidence, quantity, Span(stretch.begin_s + settling_s(evidence), end_s))
        if cursor is None:
            continue
        if final is not None:
            levels = Span(before_s - cycle_s, before_s), final
            cursor = _timed(evidence, quantity, cursor, Span(stretch.begin_s, end_s), levels)
        cursors.append(cursor)
    return CursorStretch(
        begin_s=stretch.begin_s,
        end_s=stretch.end_s,
        in_words=stretch.in_words,
        band_percent=_PERCENT * evidence.thresholds.response_band.value,
        cursors=tuple(cursors),
    )


def _inside(evidence: Evidence, span: Span) -> slice:
    """Samples from one instant up to another, at which something else begins."""
    first, end = np.searchsorted(evidence.t_s, np.array(span) - _SAME_INSTANT_S)
    return slice(int(first), int(end))


def _extremes(evidence: Evidence, quantity: _Quantity, span: Span) -> Cursor | None:
    inside = _inside(evidence, span)
    x = quantity.series[inside]
    if not len(x) or not np.isfinite(x).all():
        return None
    mean = float(np.average(x, weights=evidence.step_s[inside]))
    return Cursor(quantity=quantity.name, minimum=float(x.min()), maximum=float(x.max()), mean=mean)


def _timed(evidence: Evidence, quantity: _Quantity, cursor: Cursor, span: Span, levels: tuple[Span, Span]) -> Cursor:
    """A cursor with its levels, and its times where they can be told."""
    initial, final = (_extremes(evidence, quantity, level) for level in levels)
    if initial is None or final is None:
        return cursor
    found: dict[str, float | None] = {"initial": initial.mean, "final": final.mean}
    inside = _inside(evidence, span)
    x = quantity.series[inside]
    if abs(final.mean - initial.mean) >= quantity.least and np.isfinite(x).all():
        band = evidence.thresholds.response_band.value
        response = step_response(evidence.t_s[inside], x, span.start_s, initial.mean, final.mean, Tolerance(band, band))
        found |= {
            "reaction_s": response.reaction_s,
            "rise_s": response.rise_s,
            "response_s": response.response_s,
            "settling_s": response.settling_s,
            "overshoot_percent": _PERCENT * response.overshoot,
        }
    return cursor.model_copy(update=found)
