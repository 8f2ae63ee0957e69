"""When a test counts at all: it began as it was meant to, and the grid did what was asked of it."""

from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.profile.procedure import Conditions


def reason_not_to_count(conditions: Conditions, evidence: Evidence) -> str | None:
    """Why none of the test's requirements can be evaluated, None when they can.

    Raises
    ------
    MeasurementError
        When the record does not show it; that is a reason too.
    """
    return (
        _record_too_short(evidence)
        or _wrong_start(conditions, evidence)
        or _disconnected_before(evidence)
        or _wrong_sag(conditions, evidence)
    )


def _record_too_short(evidence: Evidence) -> str | None:
    grid, end_s = evidence.disturbance, evidence.waveforms.end_s
    if end_s <= grid.clear_s:
        return f"the record ends at {end_s:.3f} s, before the sag is cleared at {grid.clear_s:.3f} s"
    asked_end_s = end_s if grid.record_end_s is None else grid.record_end_s
    missed = [t for t in grid.voltage_steps_s if end_s < t < asked_end_s - evidence.thresholds.record_slack_s.value]
    return f"the record ends at {end_s:.3f} s, before the voltage's step at {missed[0]:.3f} s" if missed else None


def _wrong_start(conditions: Conditions, evidence: Evidence) -> str | None:
    measured_kw = evidence.power_before_kw
    meant_kw = min(evidence.available_power_w, evidence.nominal.apparent_power_va) / 1e3
    allowed = conditions.starting_power_fraction.value
    if meant_kw > 0 and abs(measured_kw - meant_kw) <= allowed * meant_kw:
        return None
    return f"P before the sag was {measured_kw:.1f} kW, not within {100 * allowed:g} % of the {meant_kw:.1f} kW meant"


def _disconnected_before(evidence: Evidence) -> str | None:
    opened_s = evidence.known_opening_s
    if opened_s is None or opened_s >= evidence.disturbance.start_s:
        return None
    return f"the breaker opened at {opened_s:.3f} s, before the sag began"


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
