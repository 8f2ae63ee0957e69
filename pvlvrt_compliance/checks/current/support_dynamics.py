"""The additional reactive current of the positive sequence comes and settles in time."""

from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.checks.current.reactive_current import (
    POSITIVE,
    additional_current,
    is_blocked,
    mean_additional,
)
from pvlvrt_compliance.checks.parts import Part, judged_by_parts
from pvlvrt_compliance.data.marks import Number
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable, require_finite, required
from pvlvrt_compliance.measure.events import EventThresholds, detect_events
from pvlvrt_compliance.measure.response import first_reached, last_entry
from pvlvrt_compliance.measure.windows import Span
from pvlvrt_compliance.profile.procedure import Detection
from pvlvrt_compliance.profile.requirements import SupportDynamics
from pvlvrt_compliance.results import Verdict
from pvlvrt_compliance.waveforms.container import Samples

KIND = "support_dynamics"


class SupportDynamicsCheck(Check):
    """Judges how soon the additional reactive current comes on, responds and settles after the sag begins."""

    kind = KIND
    title = "Response of the reactive current"
    requirement = SupportDynamics

    def judge(self, requirement: SupportDynamics, evidence: Evidence) -> Verdict:
        """Judge activation, response and settling on the one-cycle reactive current; the nearest to failing is told.

        The final value is the mean over the during-window less the mean before the sag. Times count from the start of
        the sag: where the profile has thresholds of detection from the first V+ beyond them (NTS 631: t_i, U+ < 0.85),
        measured over a cycle like the current, so that the delay of the window is on both sides; else from the instant
        asked for.

        Raises
        ------
        NotApplicable
            When the sag is too short to settle in, is no event, leaves no voltage to tell reactive current by, when the
            bridge is blocked, or when the current hardly changes.
        MeasurementError
            When V+ or the current cannot be measured.
        """
        final_pu = _final_change(requirement, evidence)
        start_s = _event_start_s(evidence)
        t_s, additional = additional_current(POSITIVE, evidence, Span(start_s, evidence.disturbance.clear_s))
        return judged_by_parts(KIND, requirement, _parts(requirement, t_s, additional / final_pu, abs(final_pu)))


def _final_change(requirement: SupportDynamics, evidence: Evidence) -> float:
    window = evidence.during()
    if is_blocked(evidence, window):
        raise NotApplicable("the bridge is blocked during the sag: there is no response to time")
    if (v_positive := required(window.voltage_positive_pu, "V+")) < evidence.thresholds.least_sequence_pu.value:
        raise NotApplicable(f"V+ is {v_positive:.3f} pu: too little to tell reactive current by")
    final_pu = mean_additional(POSITIVE, evidence, window)
    if abs(final_pu) < requirement.least_change_pu.value:
        raise NotApplicable(
            f"the reactive current changes by {final_pu:+.3f} pu, less than the {requirement.least_change_pu.value:g} "
            "pu from which a response is timed"
        )
    return final_pu


def _event_start_s(evidence: Evidence) -> float:
    grid = evidence.disturbance
    if evidence.detection is None:
        return grid.start_s
    inside = evidence.between(grid.start_s, grid.clear_s)
    t_s = evidence.t_s[inside]
    v_positive = require_finite(evidence.voltage_positive_pu[inside], "V+", t_s)
    events = detect_events(t_s, v_positive, v_positive, _thresholds(evidence.detection))
    if not events:
        raise NotApplicable("V+ does not pass the threshold of detection: there is no response to time")
    return events[0].start_s


def _thresholds(detection: Detection) -> EventThresholds:
    swell, end_of_swell = detection.enter_above_pu, detection.leave_below_pu
    return EventThresholds(
        enter_below=detection.enter_below_pu.value,
        leave_above=detection.leave_above_pu.value,
        enter_above=swell.value if swell else None,
        leave_below=end_of_swell.value if end_of_swell else None,
    )


def _parts(requirement: SupportDynamics, t_s: Samples, y: Samples, final_pu: float) -> tuple[Part, Part, Part]:
    """The three times; ``y`` is the additional current as a fraction of its final change."""
    start_s, clear_s = float(t_s[0]), float(t_s[-1])
    band = 1 - requirement.band_minus.value, 1 + requirement.band_plus.value
    activated_s = first_reached(t_s, y, requirement.activation_pu.value / final_pu)
    responded_s = first_reached(t_s, y, requirement.response_fraction.value)
    settled_s = last_entry(t_s, y, *band)
    begun_s = clear_s if activated_s is None else activated_s
    if settled_s is not None:
        settled_s = max(settled_s, begun_s)
    return (
        _time(
            f"activation, to {requirement.activation_pu.value:g} pu of additional reactive current",
            Span(start_s, clear_s),
            activated_s,
            (requirement.activation_s, requirement.activation_pu),
        ),
        _time(
            f"response, to {100 * requirement.response_fraction.value:g} % of the final {final_pu:.3f} pu",
            Span(start_s, clear_s),
            responded_s,
            (requirement.response_s, requirement.response_fraction),
        ),
        _time(
            f"settling, from activation, in the band around the final {final_pu:.3f} pu",
            Span(begun_s, clear_s),
            settled_s,
            (requirement.settling_s, requirement.activation_pu, requirement.band_plus, requirement.band_minus),
        ),
    )


def _time(what: str, observed: Span, reached_s: float | None, rests_on: tuple[Number, ...]) -> Part:
    """Time to an instant, the first of ``rests_on`` being its limit; what is never reached took all that was observed.

    Raises
    ------
    NotApplicable
        When it was not reached, and need not be before the sag is over.
    """
    limit_s = rests_on[0].value
    at_s = observed.end_s if reached_s is None else reached_s
    took_s = at_s - observed.start_s
    if reached_s is None and took_s <= limit_s:
        raise NotApplicable(f"the sag is cleared {took_s:.3f} s after the start of the {what}, before its limit")
    return Part(what, took_s, limit_s, "s", at_s, rests_on)
