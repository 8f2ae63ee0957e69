"""The standard measurements of one record, as `results.json` carries them."""

import math
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.fourier import components, mean
from pvlvrt_compliance.measure.frequency import frequency_before, fundamental_frequency
from pvlvrt_compliance.measure.harmonics import distortion_percent, harmonic_amplitudes
from pvlvrt_compliance.measure.quantities import ControllerBeliefs, MeasuredWindows, WindowMeasurements
from pvlvrt_compliance.measure.window_sums import (
    WINDOWS_BY_DEFINITION,
    WindowInstruments,
    WindowSums,
    has_phases,
    window_sums,
)
from pvlvrt_compliance.measure.windows import STANDARD_RULES, Span, WindowRules, standard_windows
from pvlvrt_compliance.space_vectors import fortescue
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Segment, Waveforms
from pvlvrt_compliance.waveforms.joining import window_on_one_grid


class Floors(NamedTuple):
    """From where on a window's quantities are stated; a profile may state others."""

    voltage_pu: float = 5e-3  # positive-sequence voltage below which no frequency is stated
    fundamental_pu: float = 1e-3  # fundamental current below which no distortion is stated
    other_frequency_hz: float = 0.05  # from the frequency before: beyond it a window is measured at its own


STANDARD_FLOORS = Floors()

LONG_WINDOW_S = 3.0
"""Length from which frequency and distortion are not measured over the whole of a window (s)."""

LAST_PART_S = 0.2
"""What they are measured in, as long as the intervals of IEC 61000-4-7: ten cycles at 50 Hz, twelve at 60 Hz."""

Quantities = dict[str, float | tuple[float, ...] | None]


def measure(
    waveforms: Waveforms,
    nominal: Nominal,
    start_s: float,
    clear_s: float,
    rules: WindowRules = STANDARD_RULES,
    floors: Floors = STANDARD_FLOORS,
    by: WindowInstruments = WINDOWS_BY_DEFINITION,
) -> MeasuredWindows:
    """Measure a record in the windows before, during and after its sag.

    The frequency that windows and Fourier components go by is the one measured before the sag; the nominal one where
    there is no voltage to measure it on. A window whose own frequency is another one is measured at that. A window
    across a change of the sampling step is measured on the coarsest grid; one that the record does not hold, or whose
    grids do not fit each other, is left out (`window_on_one_grid` raises with the reason for whoever needs it). Of a
    window longer than `LONG_WINDOW_S`, frequency and distortion are those of its last `LAST_PART_S`. A quantity whose
    channels are missing or not finite is None.

    Parameters
    ----------
    waveforms : Waveforms
        The record.
    nominal : Nominal
        Base of the per-unit values.
    start_s, clear_s : float
        Start and clearing of the sag (s).
    rules : WindowRules
        Where the windows lie.
    floors : Floors
        From where on quantities are stated.
    by : WindowInstruments
        What windows are measured with.
    """
    frequency_hz = _record_frequency(waveforms, nominal, start_s, floors, by)
    # The last sample stands for the step that follows it.
    end_s = waveforms.end_s + waveforms.segments[-1].dt_s
    windows = standard_windows(start_s, clear_s, end_s, frequency_hz, rules, record_start_s=waveforms.t0_s)
    peak_spans = (windows.before, Span(start_s, clear_s), Span(clear_s, end_s))
    held = {name: _held(waveforms, span) for name, span in windows._asdict().items()}
    measured = {
        name: _measure_window(waveforms, nominal, frequency_hz, held[name], span, peak_span, floors, by)
        for name, span, peak_span in zip(windows._fields, windows, peak_spans, strict=True)
        if span is not None and peak_span is not None
    }
    return MeasuredWindows(**measured, controller=_controller(held["during"], frequency_hz))


def measure_span(
    waveforms: Waveforms,
    nominal: Nominal,
    frequency_hz: float,
    span: Span,
    peak_span: Span,
    floors: Floors = STANDARD_FLOORS,
    by: WindowInstruments = WINDOWS_BY_DEFINITION,
) -> WindowMeasurements | None:
    """Measure a record in one window as `measure` does; None where the record does not hold it.

    Parameters
    ----------
    frequency_hz : float
        Frequency before the disturbance (Hz).
    span, peak_span : Span
        The window, and where the largest instantaneous current is looked for.
    floors : Floors
        From where on quantities are stated.
    by : WindowInstruments
        What windows are measured with.
    """
    return _measure_window(waveforms, nominal, frequency_hz, _held(waveforms, span), span, peak_span, floors, by)


def _held(waveforms: Waveforms, span: Span | None) -> Segment | None:
    """Samples of a window, None where the record does not hold it."""
    try:
        return None if span is None else window_on_one_grid(waveforms, *span)
    except MeasurementError:
        return None


def _record_frequency(
    waveforms: Waveforms, nominal: Nominal, start_s: float, floors: Floors, by: WindowInstruments
) -> float:
    floor = floors.voltage_pu * nominal.phase_voltage_peak_v
    try:
        return frequency_before(waveforms, start_s, nominal.frequency_hz, floor, by.frequency)
    except MeasurementError:
        return nominal.frequency_hz


def _measure_window(
    waveforms: Waveforms,
    nominal: Nominal,
    frequency_hz: float,
    segment: Segment | None,
    span: Span,
    peak_span: Span,
    floors: Floors,
    by: WindowInstruments,
) -> WindowMeasurements | None:
    if segment is None:
        return None
    try:
        last = _last_part(waveforms, segment, span, frequency_hz)
        own_hz = _window_frequency(last, nominal, frequency_hz, floors, by)
        if own_hz is not None and abs(own_hz - frequency_hz) > floors.other_frequency_hz:
            # Over many cycles a component at another frequency than the assumed one averages out.
            frequency_hz = own_hz
            own_hz = _window_frequency(last, nominal, frequency_hz, floors, by)
        sums = window_sums(segment, frequency_hz, by)
        quantities = _voltages(sums, nominal) | _powers(sums) | _dc_voltage(sums) | {"frequency_hz": own_hz}
        if has_phases(segment, "i"):
            quantities |= _currents(segment, last, nominal, frequency_hz, floors, by)
    except MeasurementError:
        return None
    quantities["current_peak_pu"] = _current_peak(waveforms, nominal, peak_span)
    finite = {name: value for name, value in quantities.items() if _is_finite(value)}
    return WindowMeasurements.model_validate({"start_s": span.start_s, "end_s": span.end_s} | finite)


def _last_part(waveforms: Waveforms, segment: Segment, span: Span, frequency_hz: float) -> Segment:
    """Where frequency and distortion of a window are measured."""
    if span.end_s - span.start_s <= LONG_WINDOW_S:
        return segment
    return window_on_one_grid(waveforms, span.end_s - round(LAST_PART_S * frequency_hz) / frequency_hz, span.end_s)


def _is_finite(value: float | tuple[float, ...] | None) -> bool:
    return value is not None and all(math.isfinite(v) for v in (value if isinstance(value, tuple) else (value,)))


def _voltages(sums: WindowSums, nominal: Nominal) -> Quantities:
    if sums.voltages is None:
        return {}
    positive, negative, _ = fortescue(*sums.voltages)
    return {
        "voltage_positive_pu": abs(positive) / nominal.phase_voltage_peak_v,
        "voltage_negative_pu": abs(negative) / nominal.phase_voltage_peak_v,
    }


def _window_frequency(
    segment: Segment, nominal: Nominal, frequency_hz: float, floors: Floors, by: WindowInstruments
) -> float | None:
    if not has_phases(segment, "u"):
        return None
    try:
        floor = floors.voltage_pu * nominal.phase_voltage_peak_v
        return fundamental_frequency(segment, frequency_hz, "u", floor, by.frequency)
    except MeasurementError:
        return None


def _currents(
    segment: Segment, last: Segment, nominal: Nominal, frequency_hz: float, floors: Floors, by: WindowInstruments
) -> Quantities:
    amplitudes = harmonic_amplitudes(np.stack(last.three_phase("i")), last.dt_s, frequency_hz, by=by.harmonics)
    fundamentals = amplitudes[:, 1]
    if last.t0_s > segment.t0_s:
        fundamentals = np.abs(components(np.stack(segment.three_phase("i")), segment.dt_s, frequency_hz))
    floor = floors.fundamental_pu * nominal.phase_current_peak_a
    # numpy's maximum keeps a NaN, which Python's max may lose: the worst of what is not known is not known.
    distortions = [d for phase in amplitudes if (d := distortion_percent(phase, floor)) is not None]
    return {
        "current_phase_pu": tuple(float(a) / nominal.phase_current_peak_a for a in fundamentals),
        "current_thd_percent": float(np.max(distortions)) if distortions else None,
    }


def _current_peak(waveforms: Waveforms, nominal: Nominal, span: Span) -> float | None:
    pieces = [segment.slice(*span) for segment in waveforms]
    channels = [x for piece in pieces if len(piece) and has_phases(piece, "i") for x in piece.three_phase("i")]
    peaks = [peak for x in channels for peak in (x.max(), -x.min())]
    return float(np.max(peaks)) / nominal.phase_current_peak_a if peaks else None


def _powers(sums: WindowSums) -> Quantities:
    if sums.powers is None:
        return {}
    return {
        "active_power_kw": sums.powers.active / 1e3,
        "reactive_power_kvar": sums.powers.reactive / 1e3,
        "active_power_2f_kw": sums.powers.active_2f / 1e3,
    }


def _dc_voltage(sums: WindowSums) -> Quantities:
    if sums.dc is None:
        return {}
    level, of_2f = sums.dc
    return {"dc_voltage_mean_v": level, "dc_voltage_2f_percent": 100 * of_2f / level if level > 0 else None}


def _controller(segment: Segment | None, frequency_hz: float) -> ControllerBeliefs | None:
    if segment is None:
        return None

    def believed(channel: str, unit: float) -> float | None:
        if channel not in segment.channels:
            return None
        value = mean(segment[channel], segment.dt_s, frequency_hz) / unit
        return value if math.isfinite(value) else None

    beliefs = ControllerBeliefs(
        v_fault_pu=believed("v_fault_pu", 1), q_ref_kvar=believed("q_ref_var", 1e3), p_ref_kw=believed("p_ref_w", 1e3)
    )
    return None if beliefs == ControllerBeliefs() else beliefs
