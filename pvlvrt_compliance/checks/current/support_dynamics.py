"""The additional reactive current of the positive sequence comes and settles in time."""

from collections.abc import Iterator
from functools import partial
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.checks.check import StretchCheck
from pvlvrt_compliance.checks.current.idle import (
    blocked_where_due,
    destroyed_voltage,
    is_blocked,
    let_off_if_blocked,
)
from pvlvrt_compliance.checks.current.reactive_current import (
    POSITIVE,
    due_current_pu,
    mean_additional,
    reactive_before,
)
from pvlvrt_compliance.checks.limits import level, of_each
from pvlvrt_compliance.checks.parts import Part, judged_by_parts
from pvlvrt_compliance.data.marks import Marked, Number
from pvlvrt_compliance.disturbance.model import Stretch
from pvlvrt_compliance.evidence.evidence import ANY_LIGHT, Evidence, NotApplicable, require_finite, required
from pvlvrt_compliance.measure.events import EventThresholds, detect_events
from pvlvrt_compliance.measure.quantities import WindowMeasurements
from pvlvrt_compliance.measure.response import first_reached, last_entry
from pvlvrt_compliance.measure.windows import Span
from pvlvrt_compliance.profile.procedure import Detection
from pvlvrt_compliance.profile.requirements import ReactiveCurrent, SupportDynamics
from pvlvrt_compliance.results import Drawn, Instant, Verdict
from pvlvrt_compliance.results.band import REACTIVE_CURRENT
from pvlvrt_compliance.waveforms.container import Samples

KIND = "support_dynamics"

_LOOK_BACK_S = 0.002  # more than a sampling step, far less than a cycle


class SupportDynamicsCheck(StretchCheck):
    """Judges how soon the additional reactive current comes on, responds and settles after each step into a sag."""

    kind = KIND
    title = "Response of the reactive current"
    requirement = SupportDynamics

    def stretches(self, requirement: SupportDynamics, evidence: Evidence) -> tuple[Stretch, ...]:
        """Those that begin with a step of the voltage."""
        steps_s = frozenset(evidence.disturbance.voltage_steps_s)
        return tuple(part for part in super().stretches(requirement, evidence) if part.begin_s in steps_s)

    def judge_stretch(self, requirement: SupportDynamics, evidence: Evidence, stretch: Stretch) -> Verdict:
        """Judge activation, response and settling on the one-cycle reactive current; the nearest to failing is told.

        What is due is what reactive_current demands at the voltage of the stretch, less what it forgives; in a profile
        without that requirement, the mean over the settled stretch. Times count from the step: where the profile has
        thresholds of detection from the first V+ beyond them (NTS 631: t_i, U+ < 0.85), measured over a cycle like the
        current, so that the delay of the window is on both sides; else from the instant asked for.

        Raises
        ------
        NotApplicable
            When the stretch is too short to settle in, is no event, leaves no voltage to tell reactive current by, when
            the bridge is blocked and may be, or when the current hardly has to change.
        MeasurementError
            When V+ or the current cannot be measured.
        """
        window = evidence.window_of(stretch, despite=ANY_LIGHT)
        if not evidence.is_event(np.asarray(required(window.voltage_positive_pu, "V+"))):
            raise NotApplicable("V+ does not pass the threshold of detection: there is no response to time")
        demand = _reactive_current(evidence)
        let_off_if_blocked(evidence, window, demand.blocking_allowed_below_pu.value if demand else 0.0)
        if (destroyed := destroyed_voltage(KIND, requirement, evidence, window)) is not None:
            return destroyed
        if demand is None and is_blocked(evidence, window):
            return blocked_where_due(KIND, requirement, evidence, window, (requirement.activation_pu,))
        t_s, support, task = _response(requirement, evidence, stretch, window)
        parts = [time.part for time in _times(requirement, evidence, t_s, support, task)]
        return judged_by_parts(KIND, requirement, parts)

    def limits(self, requirement: SupportDynamics, evidence: Evidence) -> tuple[Drawn, ...]:
        """Between what the current has to stay once it has to be settled, and when it came and settled, a stretch."""

        def drawn(stretch: Stretch) -> Iterator[Drawn]:
            window = evidence.window_of(stretch, despite=ANY_LIGHT)
            t_s, support, task = _response(requirement, evidence, stretch, window)
            for name, part, is_over in _times(requirement, evidence, t_s, support, task):
                if is_over:
                    yield _instant(name, part)
            activated_s = _activated_s(requirement, t_s, support, task)
            if activated_s is not None and (from_s := activated_s + requirement.settling_s.value) < stretch.end_s:
                before = reactive_before(POSITIVE, evidence)
                low, high = sorted(before + task.sign * edge for edge in (task.low, task.high))
                yield level(KIND, REACTIVE_CURRENT, "settled", (from_s, float(t_s[-1])), lower=low, upper=high)

        return of_each(self.stretches(requirement, evidence), drawn)


def _instant(name: str, part: Part) -> Instant:
    return Instant(
        check=KIND, quantity=REACTIVE_CURRENT, name=name, at_s=part.at_s, took_s=part.measured, limit_s=part.limit
    )


def _response(
    requirement: SupportDynamics, evidence: Evidence, stretch: Stretch, window: WindowMeasurements
) -> tuple[Samples, Samples, "_Task"]:
    """Instants (s), additional current there, positive where it is more support (pu), and what it has to do."""
    t_s, additional = _additional(evidence, _event_start_s(evidence, stretch), stretch.end_s)
    _, before = _additional(evidence, stretch.begin_s - _LOOK_BACK_S, stretch.begin_s)
    task = _task(requirement, _reactive_current(evidence), evidence, window, float(before[-1]))
    return t_s, task.sign * additional, task


class _Task(NamedTuple):
    """What the additional reactive current has to do in a stretch (pu); positive is more support."""

    sign: int  # of the additional current by which support is more
    before: float  # at the step
    goal: float  # what it has to come to at least, or, from above, at most
    low: float  # it settles between these
    high: float
    rests_on: tuple[Marked, ...]

    @property
    def change(self) -> float:
        return self.goal - self.before


def _reactive_current(evidence: Evidence) -> ReactiveCurrent | None:
    if evidence.requirements is None:
        return None
    found: ReactiveCurrent | None = evidence.requirements.of_kind(POSITIVE.kind)
    return found


def _task(
    requirement: SupportDynamics,
    demand: ReactiveCurrent | None,
    evidence: Evidence,
    window: WindowMeasurements,
    before_pu: float,
) -> _Task:
    final = mean_additional(POSITIVE, evidence, window)
    due = final if demand is None else due_current_pu(demand, evidence, window)
    sign = -1 if due < 0 else 1
    least, most = (abs(due), abs(due)) if demand is None else _forgiven(demand, abs(due))
    before = sign * before_pu
    goal = min(max(before, least), most)
    if abs(goal - before) < requirement.least_change_pu.value:
        raise NotApplicable(
            f"the reactive current has to change by {goal - before:+.3f} pu, less than the "
            f"{requirement.least_change_pu.value:g} pu from which a response is timed"
        )
    low = least * (1 - requirement.band_minus.value)
    high = max(sign * final, least) * (1 + requirement.band_plus.value)
    rests_on = () if demand is None else (demand.k, demand.tolerance_minus_pu)
    return _Task(sign, before, goal, low, high, rests_on)


def _forgiven(demand: ReactiveCurrent, due_pu: float) -> tuple[float, float]:
    """Least and most that pass as what is due (pu): no steady current within the tolerances is out of time."""
    return max(due_pu - demand.tolerance_minus_pu.value, 0.0), due_pu + demand.tolerance_plus_pu.value


def _additional(evidence: Evidence, begin_s: float, end_s: float) -> tuple[Samples, Samples]:
    """Instants (s) and reactive current of the positive sequence less its mean before the first sag (pu).

    Without voltage there is no reactive current.
    """
    inside = evidence.samples(begin_s, end_s)
    t_s = evidence.t_s[inside]
    current = require_finite(evidence.reactive_current_pu[inside], "the reactive current", t_s)
    return t_s, current - reactive_before(POSITIVE, evidence)


def _event_start_s(evidence: Evidence, stretch: Stretch) -> float:
    if evidence.detection is None:
        return stretch.begin_s
    inside = evidence.samples(stretch.begin_s, stretch.end_s)
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


class _Time(NamedTuple):
    """One of the times that are judged."""

    name: str
    part: Part
    is_over: bool  # whether what it is the time of has come


def _times(
    requirement: SupportDynamics, evidence: Evidence, t_s: Samples, support: Samples, task: _Task
) -> list[_Time]:
    """The times; ``support`` is the additional current, positive where it is more support (pu).

    Of a current that is never active there is no settling.
    """
    observed = Span(float(t_s[0]), float(t_s[-1]))
    moved = np.sign(task.change) * (support - task.before)
    activated_s = _activated_s(requirement, t_s, support, task)
    responded_s = first_reached(t_s, moved, requirement.response_fraction.value * abs(task.change))
    size, share = requirement.activation_pu, requirement.response_fraction
    timed = partial(_time, uncertainty=evidence.half_cycle_s)
    found = [
        timed(
            "activation",
            f", to {size.value:g} pu of additional reactive current",
            observed,
            activated_s,
            requirement.activation_s,
            (size,),
        ),
        timed(
            "response",
            f", to {100 * share.value:g} % of the way from {task.before:.3f} pu to the {task.goal:.3f} pu due",
            observed,
            responded_s,
            requirement.response_s,
            (share, *task.rests_on),
        ),
    ]
    if activated_s is None:
        return found
    entered_s = last_entry(t_s, support, task.low, task.high)
    settled = timed(
        "settling",
        f", from activation, between {task.low:.3f} pu and {task.high:.3f} pu",
        Span(activated_s, observed.end_s),
        None if entered_s is None else max(entered_s, activated_s),
        requirement.settling_s,
        (size, requirement.band_plus, requirement.band_minus, *task.rests_on),
    )
    return [*found, settled]


def _activated_s(requirement: SupportDynamics, t_s: Samples, support: Samples, task: _Task) -> float | None:
    return first_reached(t_s, np.sign(task.change) * (support - task.before), requirement.activation_pu.value)


def _time(
    name: str,
    what: str,
    observed: Span,
    reached_s: float | None,
    limit: Number,
    rests_on: tuple[Marked, ...],
    uncertainty: float,
) -> _Time:
    """Time to an instant; what is never reached took all that was observed.

    Raises
    ------
    NotApplicable
        When it was not reached, and need not be before the stretch is over.
    """
    at_s = observed.end_s if reached_s is None else reached_s
    took_s = at_s - observed.start_s
    if reached_s is None and took_s <= limit.value:
        raise NotApplicable(f"the sag is over {took_s:.3f} s after the start of the {name}{what}, before its limit")
    part = Part(f"{name}{what}", took_s, limit.value, "s", at_s, (limit, *rests_on), uncertainty)
    return _Time(name, part, reached_s is not None)
