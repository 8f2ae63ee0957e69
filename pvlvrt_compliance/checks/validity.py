"""When a test counts at all: it began as it was meant to, and the sag was the one asked for."""

from pvlvrt_compliance.checks.disturbances import voltage_steps_s
from pvlvrt_compliance.checks.evidence import Evidence
from pvlvrt_compliance.profile.procedure import Conditions

_LAST_STEP_S = 0.01
"""A record ends up to a sampling step before the end that was asked for."""


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
    scenario, end_s = evidence.scenario, evidence.waveforms.end_s
    if end_s <= scenario.clear_s:
        return f"the record ends at {end_s:.3f} s, before the sag is cleared at {scenario.clear_s:.3f} s"
    missed = [t for t in voltage_steps_s(scenario) if end_s < t < scenario.end_s - _LAST_STEP_S]
    return f"the record ends at {end_s:.3f} s, before the voltage's step at {missed[0]:.3f} s" if missed else None


def _wrong_start(conditions: Conditions, evidence: Evidence) -> str | None:
    measured_kw = evidence.power_before_kw
    meant_kw = min(evidence.available_power_w, evidence.nominal.apparent_power_va) / 1e3
    allowed = conditions.starting_power_fraction.value
    if meant_kw > 0 and abs(measured_kw - meant_kw) <= allowed * meant_kw:
        return None
    return f"P before the sag was {measured_kw:.1f} kW, not within {100 * allowed:g} % of the {meant_kw:.1f} kW meant"


def _disconnected_before(evidence: Evidence) -> str | None:
    opened_s = evidence.disconnected_at_s if evidence.is_switched else None
    if opened_s is None or opened_s >= evidence.scenario.start_s:
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
