"""The inverter supports the voltage with the reactive power that the curve demands, at each level of the voltage."""

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from pvlvrt_compliance.checks.check import StretchCheck
from pvlvrt_compliance.checks.current.idle import destroyed_voltage
from pvlvrt_compliance.checks.limits import level
from pvlvrt_compliance.checks.verdicts import judged, pass_or_fail
from pvlvrt_compliance.disturbance.model import Stretch
from pvlvrt_compliance.evidence.evidence import ANY_LIGHT, Evidence, NotApplicable, require_finite, required
from pvlvrt_compliance.measure.extremes import Extreme, largest, smallest
from pvlvrt_compliance.measure.quantities import WindowMeasurements
from pvlvrt_compliance.profile.requirements import ReactiveSupport
from pvlvrt_compliance.results import Band, Verdict
from pvlvrt_compliance.results.band import REACTIVE_POWER
from pvlvrt_compliance.waveforms.container import Samples

KIND = "reactive_support"


class ReactiveSupportCheck(StretchCheck):
    """Judges mean Q in each sag against what the curve demands at its V+; near nominal none is demanded."""

    kind = KIND
    title = "Reactive power during a sag"
    requirement = ReactiveSupport

    def judge_stretch(self, requirement: ReactiveSupport, evidence: Evidence, stretch: Stretch) -> Verdict:
        """Judge the mean Q of a settled stretch at the V+ and V- measured at the terminals.

        Raises
        ------
        NotApplicable
            When the stretch is too short for a window, the voltage ramps, or the grid has none; between two sags also
            when the inverter fed reactive power before them.
        MeasurementError
            When Q, V+ or V- cannot be measured in it.
        """
        window = evidence.window_of(stretch, despite=ANY_LIGHT)
        if (destroyed := destroyed_voltage(KIND, requirement, evidence, window)) is not None:
            return destroyed
        if required(window.voltage_positive_pu, "V+") >= requirement.no_support_from_pu.value:
            if stretch.kind == "normal" and stretch.begin_s > evidence.disturbance.start_s:
                _let_off_with_a_set_point(requirement, evidence, window)
            return _judge_no_support(requirement, evidence, window)
        return _judge_support(requirement, evidence, window)

    def limits(self, requirement: ReactiveSupport, evidence: Evidence) -> tuple[Band, ...]:
        """What is demanded in each window, and the same less the tolerance; without support, that on either side."""
        windows = evidence.windows_of(self.stretches(requirement, evidence), despite=ANY_LIGHT)
        return tuple(band for window in windows for band in _bands(requirement, evidence, window))


def _let_off_with_a_set_point(requirement: ReactiveSupport, evidence: Evidence, window: WindowMeasurements) -> None:
    """Between sags an inverter goes on with the Q that it was asked for; without any, none is wanted."""
    before = required(evidence.before().reactive_power_kvar, "the reactive power before the sag")
    if abs(before) > _tolerance_kvar(requirement, evidence, required(window.voltage_positive_pu, "V+")):
        raise NotApplicable(f"between sags the reactive power is that of normal operation: {before:.1f} kvar before")


def _bands(requirement: ReactiveSupport, evidence: Evidence, window: WindowMeasurements) -> Iterator[Band]:
    v_positive = required(window.voltage_positive_pu, "V+")
    tolerance = _tolerance_kvar(requirement, evidence, v_positive)
    draw = partial(level, KIND, REACTIVE_POWER, "limit of Q", (window.start_s, window.end_s))
    if v_positive >= requirement.no_support_from_pu.value:
        yield draw(lower=-tolerance, upper=tolerance)
    else:
        due = _demanded_kvar(requirement, evidence, window)
        yield draw(lower=due)
        yield draw(lower=due - tolerance, widened=True)


def demanded_pu(requirement: ReactiveSupport, v_positive_pu: float, v_negative_pu: float) -> float:
    """Reactive power demanded at V+ and V- (pu of S): the curve, and at most what eq (8) leaves room for."""
    return float(demanded_at_pu(requirement, np.asarray(v_positive_pu), np.asarray(v_negative_pu)))


def demanded_at_pu(requirement: ReactiveSupport, v_positive_pu: Samples, v_negative_pu: Samples) -> Samples:
    """The same of many V+ and V- (pu), of one shape."""
    by_curve: Samples = requirement.curve.reactive_power_at(v_positive_pu)
    capability = np.maximum(v_positive_pu - v_negative_pu, 0.0)
    return np.minimum(by_curve, capability) if requirement.clip_to_capability.value else by_curve


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
        at_s=_worst_instant_s(evidence, window, smallest),
        rests_on=(requirement.curve, requirement.clip_to_capability, requirement.tolerance_pu),
        bound="at_least",
        tolerance=tolerance,
        uncertainty=evidence.power_uncertainty_kva,
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
        at_s=_worst_instant_s(evidence, window, lambda q, scale: largest(np.abs(q), scale)),
        rests_on=(requirement.no_support_from_pu, requirement.tolerance_pu),
        bound="band",
        uncertainty=evidence.power_uncertainty_kva,
    )


def _rounded(margin_kvar: float) -> float:
    """Margin without the rounding noise that decides where both the demand and the tolerance are zero (no voltage)."""
    return round(margin_kvar, 6) + 0.0  # adding zero makes of -0.0 a plain 0.0


def _mean_over(window: WindowMeasurements) -> str:
    return (
        f"mean reactive power {window.reactive_power_kvar:.1f} kvar over {window.start_s:.3f} s to {window.end_s:.3f} s"
    )


def _worst_instant_s(
    evidence: Evidence, window: WindowMeasurements, worst: Callable[[Samples, float], Extreme]
) -> float:
    """First instant in the window at which the one-cycle mean of Q is farthest on the wrong side (s)."""
    inside = evidence.samples(window.start_s, window.end_s)
    t_s = evidence.t_s[inside]
    q = require_finite(evidence.reactive_power_kvar[inside], "Q", t_s)
    return float(t_s[worst(q, evidence.nominal.apparent_power_kva).at])
