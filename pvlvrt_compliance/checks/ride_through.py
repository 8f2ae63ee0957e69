"""The inverter stays connected where the envelope demands it, and its active power comes back."""

import numpy as np

from pvlvrt_compliance.checks.evidence import Evidence, require_finite
from pvlvrt_compliance.checks.results import Check, Status
from pvlvrt_compliance.checks.verdicts import judged, pass_or_fail
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.profile.provenance import marks_in
from pvlvrt_compliance.profile.requirements import RideThrough
from pvlvrt_compliance.waveforms.container import Samples

KIND = "ride_through"


def check_ride_through(requirement: RideThrough, evidence: Evidence) -> Check:
    """Judge connection against the envelope at the measured V+, then the recovery of the active power.

    Raises
    ------
    MeasurementError
        When the record does not say whether the breaker is closed, or V+ or P cannot be measured.
    """
    released_s = released_after_s(requirement, evidence)
    if evidence.disconnected_at_s is not None:
        return _judge_trip(requirement, evidence, evidence.disconnected_at_s, released_s)
    if released_s is not None and released_s < evidence.scenario.duration_s:
        return _judge_long_sag(requirement, evidence, released_s)
    return _judge_recovery(requirement, evidence)


def released_after_s(requirement: RideThrough, evidence: Evidence) -> float | None:
    """How long after the start of the sag V+ first falls below the envelope (s), None when it never does.

    An excursion counts when it goes deeper than the tolerance, so that a sag that is cleared exactly on the envelope
    is within it; it then counts from its beginning.
    """
    if requirement.envelope is None:
        return None
    after_start = evidence.between(evidence.scenario.start_s, evidence.waveforms.end_s)
    t_s = evidence.t_s[after_start] - evidence.scenario.start_s
    v_positive = require_finite(evidence.voltage_positive_pu[after_start], "V+", evidence.t_s[after_start])
    below_by = requirement.envelope.voltage_at(t_s) - v_positive
    deep = np.flatnonzero(below_by > requirement.envelope_tolerance_pu.value)
    if not len(deep):
        return None
    on_or_above = np.flatnonzero(below_by[: deep[0]] <= 0)
    return float(t_s[on_or_above[-1] + 1 if len(on_or_above) else 0])


def _judge_trip(requirement: RideThrough, evidence: Evidence, tripped_at_s: float, released_s: float | None) -> Check:
    connected_s = tripped_at_s - evidence.scenario.start_s
    if released_s is not None and connected_s >= released_s:
        message = f"the envelope demands {released_s:.3f} s, connected for {connected_s:.2f} s"
        return _on_connection(
            requirement,
            Status.NOT_APPLICABLE,
            message,
            connected_s=connected_s,
            demanded_s=released_s,
            at_s=tripped_at_s,
        )
    demanded_s, demand = _demand(requirement, evidence, connected_s, released_s)
    message = f"tripped {connected_s:.3f} s after the start; {demand}"
    return _on_connection(
        requirement, Status.FAIL, message, connected_s=connected_s, demanded_s=demanded_s, at_s=tripped_at_s
    )


def _demand(
    requirement: RideThrough, evidence: Evidence, connected_s: float, released_s: float | None
) -> tuple[float, str]:
    """How long the inverter had to stay connected (s), and that in words."""
    demanded_s = released_s
    if demanded_s is None and connected_s < evidence.scenario.duration_s:
        demanded_s = _demanded_by_residual_s(requirement, evidence)
    if demanded_s is not None and demanded_s > connected_s:
        return demanded_s, f"the envelope demands {demanded_s:.3f} s"
    throughout_s = evidence.waveforms.end_s - evidence.scenario.start_s
    if requirement.envelope is None:
        return throughout_s, "the profile has no envelope, so it demands connection throughout"
    return throughout_s, "the voltage stays above the envelope, which demands connection throughout"


def _demanded_by_residual_s(requirement: RideThrough, evidence: Evidence) -> float | None:
    """What the envelope demands of the voltage left during the sag (s), had the sag gone on."""
    scenario = evidence.scenario
    in_sag = evidence.between(scenario.start_s + 1 / evidence.frequency_hz, scenario.clear_s)
    if requirement.envelope is None or not in_sag.any():
        return None
    return requirement.envelope.time_of(_median(evidence.voltage_positive_pu[in_sag], evidence.step_s[in_sag]))


def _median(values: Samples, step_s: Samples) -> float:
    """Value below which a signal is for half of the time, each sample standing for its step."""
    order = np.argsort(values)
    lasting_s = np.cumsum(step_s[order])
    return float(values[order[np.searchsorted(lasting_s, 0.5 * lasting_s[-1])]])


def _judge_long_sag(requirement: RideThrough, evidence: Evidence, released_s: float) -> Check:
    """A sag that lasts longer than the envelope demands, with the breaker closed throughout."""
    scenario = evidence.scenario
    blocked_at_s = evidence.blocked_at_s
    if blocked_at_s is not None and blocked_at_s - scenario.start_s < released_s:
        fed_s = blocked_at_s - scenario.start_s
        message = f"bridge blocked {fed_s:.3f} s after the start; the envelope demands {released_s:.3f} s"
        return _on_connection(
            requirement, Status.FAIL, message, connected_s=fed_s, demanded_s=released_s, at_s=blocked_at_s
        )
    message = (
        f"connected throughout; of this sag of {scenario.duration_s:.3f} s the envelope demands {released_s:.3f} s, "
        "so it does not demand recovery"
    )
    return _on_connection(
        requirement, Status.PASS, message, connected_s=scenario.duration_s, demanded_s=released_s, at_s=scenario.clear_s
    )


def _on_connection(
    requirement: RideThrough, status: Status, message: str, *, connected_s: float, demanded_s: float, at_s: float
) -> Check:
    envelope = requirement.envelope
    return judged(
        KIND,
        requirement,
        status,
        message,
        measured=connected_s,
        limit=demanded_s,
        margin=connected_s - demanded_s,
        unit="s",
        at_s=at_s,
        rests_on=[envelope] if envelope else [],
        clause=envelope.clause if envelope else "",
    )


def _judge_recovery(requirement: RideThrough, evidence: Evidence) -> Check:
    clear_s = evidence.scenario.clear_s
    if requirement.recovery_fraction is None or requirement.recovery_time_s is None:
        lasted_s = evidence.waveforms.end_s - evidence.scenario.start_s
        return _on_connection(
            requirement,
            Status.PASS,
            "connected throughout",
            connected_s=lasted_s,
            demanded_s=lasted_s,
            at_s=evidence.waveforms.end_s,
        )
    before_kw = evidence.power_before_kw
    allowed_s = requirement.recovery_time_s.value
    target = f"{100 * requirement.recovery_fraction.value:g} % of the {before_kw:.1f} kW before the sag"
    back_s = _recovered_after_s(evidence, requirement.recovery_fraction.value * before_kw)
    observed_s = evidence.waveforms.end_s - clear_s
    if back_s is None and observed_s < allowed_s:
        raise MeasurementError(f"the record ends {observed_s:.3f} s after clearing, before P is back at {target}")
    recovered_s = observed_s if back_s is None else back_s
    return judged(
        KIND,
        requirement,
        pass_or_fail(recovered_s <= allowed_s),
        f"connected throughout; P was {'not ' if back_s is None else ''}back at {target} "
        f"{recovered_s:.3f} s after clearing",
        measured=recovered_s,
        limit=allowed_s,
        margin=allowed_s - recovered_s,
        unit="s",
        at_s=clear_s + recovered_s,
        rests_on=[number for _, number in marks_in(requirement)],
    )


def _recovered_after_s(evidence: Evidence, target_kw: float) -> float | None:
    """Time from clearing until P stays at or above a power (s), None when it ends below it."""
    clear_s = evidence.scenario.clear_s
    after = evidence.between(clear_s, evidence.waveforms.end_s)
    t_s = evidence.t_s[after]
    active_power = require_finite(evidence.active_power_kw[after], "P", t_s)
    too_low = np.flatnonzero(active_power < target_kw)
    if not len(too_low):
        return 0.0
    return float(t_s[too_low[-1] + 1] - clear_s) if too_low[-1] + 1 < len(t_s) else None
