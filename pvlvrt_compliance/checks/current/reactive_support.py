"""The inverter supports the voltage with the reactive power that the curve demands."""

from collections.abc import Callable

import numpy as np

from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.checks.verdicts import judged, pass_or_fail
from pvlvrt_compliance.evidence.evidence import Evidence, require_finite, required
from pvlvrt_compliance.measure.quantities import WindowMeasurements
from pvlvrt_compliance.profile.requirements import ReactiveSupport
from pvlvrt_compliance.results import Band, Verdict
from pvlvrt_compliance.results.band import REACTIVE_POWER
from pvlvrt_compliance.waveforms.container import Samples

KIND = "reactive_support"


class ReactiveSupportCheck(Check):
    """Judges mean Q during the sag against what the curve demands at its V+; near nominal none is demanded."""

    kind = KIND
    title = "Reactive power during a sag"
    requirement = ReactiveSupport

    def judge(self, requirement: ReactiveSupport, evidence: Evidence) -> Verdict:
        """Judge the mean Q during the sag at the V+ and V- measured at the terminals.

        Raises
        ------
        NotApplicable
            When the sag is too short for a window.
        MeasurementError
            When Q, V+ or V- cannot be measured in it.
        """
        window = evidence.during()
        if required(window.voltage_positive_pu, "V+") >= requirement.no_support_from_pu.value:
            return _judge_no_support(requirement, evidence, window)
        return _judge_support(requirement, evidence, window)

    def limits(self, requirement: ReactiveSupport, evidence: Evidence) -> tuple[Band, ...]:
        """What is demanded over the window, less the tolerance; without support, the tolerance on either side."""
        window = evidence.during()
        v_positive = required(window.voltage_positive_pu, "V+")
        tolerance = _tolerance_kvar(requirement, evidence, v_positive)
        span = (window.start_s, window.end_s)
        if v_positive >= requirement.no_support_from_pu.value:
            edges = {"lower": (-tolerance, -tolerance), "upper": (tolerance, tolerance)}
        else:
            least = _demanded_kvar(requirement, evidence, window) - tolerance
            edges = {"lower": (least, least)}
        return (Band(check=KIND, quantity=REACTIVE_POWER, name="limit of Q", t_s=span, **edges),)


def demanded_pu(requirement: ReactiveSupport, v_positive_pu: float, v_negative_pu: float) -> float:
    """Reactive power demanded at V+ and V- (pu of S): the curve, and at most what eq (8) leaves room for."""
    by_curve = float(requirement.curve.reactive_power_at(v_positive_pu))
    capability = v_positive_pu - v_negative_pu
    return min(by_curve, max(capability, 0.0)) if requirement.clip_to_capability.value else by_curve


def _demanded_kvar(requirement: ReactiveSupport, evidence: Evidence, window: WindowMeasurements) -> float:
    v_positive, v_negative = required(window.voltage_positive_pu, "V+"), required(window.voltage_negative_pu, "V-")
    return demanded_pu(requirement, v_positive, v_negative) * evidence.nominal.apparent_power_kva


def _tolerance_kvar(requirement: ReactiveSupport, evidence: Evidence, v_positive_pu: float) -> float:
    return requirement.tolerance_pu.value * v_positive_pu * evidence.nominal.apparent_power_kva


def _judge_support(requirement: ReactiveSupport, evidence: Evidence, window: WindowMeasurements) -> Verdict:
    v_positive = required(window.voltage_positive_pu, "V+")
    limit = _demanded_kvar(requirement, evidence, window)
    tolerance = _tolerance_kvar(requirement, evidence, v_positive)
    measured = required(window.reactive_power_kvar, "the reactive power")
    margin = _rounded(measured - (limit - tolerance))
    side = "above" if measured >= limit else "below"
    return judged(
        KIND,
        requirement,
        pass_or_fail(margin >= 0),
        f"{_mean_over(window)} is {abs(measured - limit):.1f} kvar {side} the {limit:.1f} kvar demanded at "
        f"V+ = {v_positive:.3f} pu; the tolerance is {tolerance:.1f} kvar",
        measured=measured,
        limit=limit,
        margin=margin,
        unit="kvar",
        at_s=_worst_instant_s(evidence, window, np.argmin),
        rests_on=(requirement.curve, requirement.clip_to_capability, requirement.tolerance_pu),
    )


def _judge_no_support(requirement: ReactiveSupport, evidence: Evidence, window: WindowMeasurements) -> Verdict:
    v_positive = required(window.voltage_positive_pu, "V+")
    limit = _tolerance_kvar(requirement, evidence, v_positive)
    measured = required(window.reactive_power_kvar, "the reactive power")
    margin = _rounded(limit - abs(measured))
    side = "within" if margin >= 0 else "outside"
    return judged(
        KIND,
        requirement,
        pass_or_fail(margin >= 0),
        f"{_mean_over(window)} is {side} the tolerance of {limit:.1f} kvar; no support is demanded at "
        f"V+ = {v_positive:.3f} pu",
        measured=measured,
        limit=limit,
        margin=margin,
        unit="kvar",
        at_s=_worst_instant_s(evidence, window, lambda q: np.argmax(np.abs(q))),
        rests_on=(requirement.no_support_from_pu, requirement.tolerance_pu),
    )


def _rounded(margin_kvar: float) -> float:
    """Margin without the rounding noise that decides where both the demand and the tolerance are zero (no voltage)."""
    return round(margin_kvar, 6) + 0.0  # adding zero makes of -0.0 a plain 0.0


def _mean_over(window: WindowMeasurements) -> str:
    return (
        f"mean reactive power {window.reactive_power_kvar:.1f} kvar over {window.start_s:.3f} s to {window.end_s:.3f} s"
    )


def _worst_instant_s(evidence: Evidence, window: WindowMeasurements, worst: Callable[[Samples], np.intp]) -> float:
    """Instant in the window at which the one-cycle mean of Q is farthest on the wrong side (s)."""
    inside = evidence.between(window.start_s, window.end_s)
    t_s = evidence.t_s[inside]
    return float(t_s[worst(require_finite(evidence.reactive_power_kvar[inside], "Q", t_s))])
