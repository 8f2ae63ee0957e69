"""When a test counts at all: it began as it was meant to, and the grid did what was asked of it."""

import math

import numpy as np

from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.evidence.no_load import has_source
from pvlvrt_compliance.measure.durations import median_over_time
from pvlvrt_compliance.profile.procedure import Conditions
from pvlvrt_compliance.waveforms.joining import window_on_one_grid
from pvlvrt_compliance.waveforms.trip_causes import DC_OVERVOLTAGE, in_words

_ORDER_CYCLES, _LEAST_ORDER_CYCLES = 5, 2  # before the disturbance, that the order of the phases is looked for in


def reason_not_to_count(conditions: Conditions, evidence: Evidence) -> str | None:
    """Why none of the test's requirements can be evaluated, None when they can.

    Raises
    ------
    MeasurementError
        When the record does not show it; that is a reason too.
    """
    return (
        _record_too_short(evidence)
        or _wrong_order(evidence)
        or _disconnected_before(evidence)
        or _wrong_start(conditions, evidence)
        or _wrong_sag(conditions, evidence)
    )


def _record_too_short(evidence: Evidence) -> str | None:
    grid, end_s = evidence.disturbance, evidence.waveforms.end_s
    if end_s <= grid.clear_s:
        return f"the record ends at {end_s:.3f} s, before the sag is cleared at {grid.clear_s:.3f} s"
    asked_end_s = end_s if grid.record_end_s is None else grid.record_end_s
    missed = [t for t in grid.voltage_steps_s if end_s < t < asked_end_s - evidence.thresholds.record_slack_s.value]
    return f"the record ends at {end_s:.3f} s, before the voltage's step at {missed[0]:.3f} s" if missed else None


def _wrong_order(evidence: Evidence) -> str | None:
    """Phases in the order c, b, a: a controller that follows V+ finds none."""
    start_s, nominal_hz = evidence.disturbance.start_s, evidence.nominal.frequency_hz
    kind, place = ("u0", "without the inverter's current") if has_source(evidence) else ("u", "")
    begin_s = max(start_s - _ORDER_CYCLES / nominal_hz, evidence.waveforms.t0_s)
    if start_s - begin_s < _LEAST_ORDER_CYCLES / nominal_hz:
        return None  # whoever measures the start says so
    seen = window_on_one_grid(evidence.waveforms, begin_s, start_s)
    phasors = np.abs(evidence.instruments.sequence_phasors(seen, kind, nominal_hz))
    phasors /= evidence.nominal.phase_voltage_peak_v
    phasors = phasors[:, np.isfinite(phasors).all(axis=0)]
    if not phasors.size:
        return None
    even = np.broadcast_to(1.0, phasors.shape[1])
    positive, negative = (median_over_time(x, even) for x in phasors[:2])
    if not negative > positive:
        return None
    return f"negative phase order: V- {negative:.3f} pu and V+ {positive:.3f} pu before the sag {place}".rstrip()


def _disconnected_before(evidence: Evidence) -> str | None:
    """The trip that left nothing to judge, with the relay; where the record names none, the breaker."""
    tripped_s = evidence.tripped_before_s
    if tripped_s is not None:
        record_s = evidence.waveforms.t0_s
        at = f" at {tripped_s:.3f} s" if math.isfinite(tripped_s) else ""
        what = "the record" if tripped_s < record_s else "the sag began"
        return f"tripped{at} by the {evidence.trip_cause}, before {what}{_open_circuit(evidence, tripped_s)}"
    opened_s = evidence.known_opening_s
    if opened_s is None or opened_s >= evidence.disturbance.start_s:
        return None
    if opened_s <= evidence.waveforms.t0_s:
        return "the breaker was open before the record began"
    return f"the breaker opened at {opened_s:.3f} s, before the sag began"


def _open_circuit(evidence: Evidence, tripped_s: float) -> str:
    """What a DC over-voltage trip before the record goes back to: a blocked bridge leaves the link to the array."""
    temperature_c = evidence.cell_temperature_c
    long_ago = math.isfinite(tripped_s) and tripped_s < evidence.waveforms.t0_s
    if evidence.trip_cause != in_words(DC_OVERVOLTAGE) or temperature_c is None or not long_ago:
        return ""
    voltage_v = float(evidence.dc_voltage_v[0])
    return f"; the array's open-circuit voltage at {temperature_c:g} C is {voltage_v:.0f} V"


def _wrong_start(conditions: Conditions, evidence: Evidence) -> str | None:
    """P before is not what was meant. Without power from the array, about nothing is meant."""
    measured_kw, rated_kw = evidence.power_before_kw, evidence.nominal.apparent_power_kva
    meant_kw = min(evidence.available_power_w / 1e3, rated_kw)
    allowed, none_kw = conditions.starting_power_fraction.value, evidence.thresholds.no_power_pu.value * rated_kw
    if meant_kw <= none_kw:
        within, allowed_kw = f"{none_kw:g} kW", none_kw
    else:
        within, allowed_kw = f"{100 * allowed:g} %", allowed * meant_kw
    if abs(measured_kw - meant_kw) <= allowed_kw:
        return None
    before = evidence.current_pu[:, evidence.t_s < evidence.disturbance.start_s]
    was_off = evidence.is_switched and bool((np.abs(before) < evidence.blocked_below_pu).all())
    stopped = "; the controller gave no current, the breaker stayed closed" if was_off else ""
    return f"P before the sag was {measured_kw:.1f} kW, not within {within} of the {meant_kw:.1f} kW meant{stopped}"


def _wrong_sag(conditions: Conditions, evidence: Evidence) -> str | None:
    measured = evidence.no_load_pu
    if measured is None:
        return None
    tolerance = conditions.no_load_tolerance_pu.value
    for name, found, wanted in zip(("V+", "V-"), measured, evidence.asked_pu, strict=True):
        if not abs(found - wanted) <= tolerance:
            return (
                f"{name} without the inverter's current was {found:.3f} pu, more than {tolerance:g} pu from the "
                f"{wanted:.3f} pu asked for"
            )
    return None
