"""Additional reactive current in proportion to the change of a sequence's voltage: delta i = K f(delta u).

Signs are those of `measure.power`: reactive current is positive where it pulls the voltage of its sequence back, up in
the positive sequence, down in the negative one. delta u therefore counts what V+ has fallen by and what V- has risen
by, so that the one formula holds for both, and for a swell too, where all of it is negative.
"""

from typing import ClassVar, NamedTuple

import numpy as np

from pvlvrt_compliance.checks.check import StretchCheck
from pvlvrt_compliance.checks.current.idle import (
    blocked_where_due,
    destroyed_voltage,
    is_blocked,
    let_off_if_blocked,
)
from pvlvrt_compliance.checks.limits import level, of_each
from pvlvrt_compliance.checks.verdicts import judged, pass_or_fail
from pvlvrt_compliance.data.marks import Marked
from pvlvrt_compliance.disturbance.model import Stretch
from pvlvrt_compliance.evidence.evidence import ANY_LIGHT, Evidence, NotApplicable, require_finite, required
from pvlvrt_compliance.measure.durations import mean_over_time
from pvlvrt_compliance.measure.extremes import largest, smallest
from pvlvrt_compliance.measure.quantities import WindowMeasurements
from pvlvrt_compliance.measure.windows import Span
from pvlvrt_compliance.profile.requirements import ReactiveCurrent
from pvlvrt_compliance.profile.requirements.current import beyond_dead_band
from pvlvrt_compliance.results import Band, Status, Verdict
from pvlvrt_compliance.results.band import REACTIVE_CURRENT, REACTIVE_CURRENT_NEGATIVE
from pvlvrt_compliance.waveforms.container import Samples


class Sequence(NamedTuple):
    """One of the two sequences that support is demanded of."""

    kind: str
    name: str
    nominal_pu: float


POSITIVE = Sequence("reactive_current", "positive", 1.0)
NEGATIVE = Sequence("negative_sequence_current", "negative", 0.0)


class _Asked(NamedTuple):
    """What the requirement asks of one sequence (pu)."""

    delta_u_pu: float  # what the voltage moved by, as a sag moves it
    clipped_pu: float  # additional reactive current
    clipped: bool
    as_in_swell: bool  # more support is less reactive current; not where the voltage is what it was but for rounding


class _Due(NamedTuple):
    """Where the additional reactive current must lie (pu)."""

    low: float
    high: float
    words: str


class _SequenceCheck(StretchCheck):
    """Judges one sequence in each stretch up to the release."""

    sequence: ClassVar[Sequence]
    requirement = ReactiveCurrent

    def judge_stretch(self, requirement: ReactiveCurrent, evidence: Evidence, stretch: Stretch) -> Verdict:
        """Judge the mean additional reactive current of a settled stretch, less its mean before the first sag.

        Raises
        ------
        NotApplicable
            When the stretch is too short for a window, when the voltage ramps, when the bridge is blocked and may be,
            or when the grid has no voltage of the sequence to tell reactive current by.
        MeasurementError
            When a voltage or a current cannot be measured.
        """
        return _judge(self.sequence, requirement, evidence, evidence.window_of(stretch, despite=ANY_LIGHT))

    def limits(self, requirement: ReactiveCurrent, evidence: Evidence) -> tuple[Band, ...]:
        """The band that the mean must lie in, with what flowed before, over each window."""
        windows = evidence.windows_of(self.stretches(requirement, evidence), despite=ANY_LIGHT)
        return of_each(windows, lambda window: [_drawn(self.sequence, requirement, evidence, window)])


class ReactiveCurrentCheck(_SequenceCheck):
    """Judges the reactive current that the inverter adds to raise V+ in a sag, against K times what V+ fell by."""

    kind = POSITIVE.kind
    title = "Reactive current of the positive sequence"
    sequence = POSITIVE


class NegativeSequenceCurrentCheck(_SequenceCheck):
    """Judges the reactive current that the inverter adds to lower V- in a sag, against K times what V- rose by."""

    kind = NEGATIVE.kind
    title = "Reactive current of the negative sequence"
    sequence = NEGATIVE


def _drawn(sequence: Sequence, requirement: ReactiveCurrent, evidence: Evidence, window: WindowMeasurements) -> Band:
    band = _band(_asked(sequence, requirement, evidence, window), requirement, _is_event(evidence, window))
    before = reactive_before(sequence, evidence)
    quantity = REACTIVE_CURRENT if sequence is POSITIVE else REACTIVE_CURRENT_NEGATIVE
    name, span = f"due, {sequence.name} sequence", (window.start_s, window.end_s)
    return level(sequence.kind, quantity, name, span, lower=before + band.low, upper=before + band.high)


def _is_event(evidence: Evidence, window: WindowMeasurements) -> bool:
    return bool(evidence.is_event(np.asarray(required(window.voltage_positive_pu, "V+"))))


def _judge(sequence: Sequence, requirement: ReactiveCurrent, evidence: Evidence, window: WindowMeasurements) -> Verdict:
    let_off_if_blocked(evidence, window, requirement.blocking_allowed_below_pu.value)
    if sequence is POSITIVE:
        if (destroyed := destroyed_voltage(sequence.kind, requirement, evidence, window)) is not None:
            return destroyed
    else:
        _need_negative(evidence, window)
    asked = _asked(sequence, requirement, evidence, window)
    event = _is_event(evidence, window)
    verdict = _judge_band(sequence, requirement, evidence, window, asked, event)
    if verdict.status is Status.PASS and event and asked.clipped_pu != 0 and is_blocked(evidence, window):
        rests_on = (requirement.k, requirement.blocking_allowed_below_pu)
        return blocked_where_due(sequence.kind, requirement, evidence, window, rests_on)
    return verdict


def _judge_band(
    sequence: Sequence,
    requirement: ReactiveCurrent,
    evidence: Evidence,
    window: WindowMeasurements,
    asked: _Asked,
    event: bool,
) -> Verdict:
    band = _band(asked, requirement, event)
    t_s, additional = additional_current(sequence, evidence, Span(window.start_s, window.end_s))
    measured = mean_additional(sequence, evidence, window)
    to_high, to_low = band.high - measured, measured - band.low
    at_high = to_high < to_low
    return judged(
        sequence.kind,
        requirement,
        pass_or_fail(min(to_high, to_low) >= 0),
        f"additional reactive current of the {sequence.name} sequence {measured:+.3f} pu, mean over "
        f"{window.start_s:.3f} s to {window.end_s:.3f} s; {band.words}; band {band.low:+.3f} to {band.high:+.3f} pu",
        measured=measured,
        limit=band.high if at_high else band.low,
        margin=min(to_high, to_low),
        unit="pu",
        at_s=t_s[(largest if at_high else smallest)(additional, 1.0).at],
        rests_on=_rests_on(requirement, asked, is_more=at_high != asked.as_in_swell),
        bound="at_most" if at_high else "at_least",
        uncertainty=evidence.thresholds.uncertainty_current_pu.value,
    )


def _need_negative(evidence: Evidence, window: WindowMeasurements) -> None:
    """V- that the grid has and the terminals have not is what the support is for."""
    voltage = _voltage(NEGATIVE, window)
    if voltage < evidence.thresholds.least_sequence_pu.value:
        raise NotApplicable(
            f"the negative sequence of the voltage is {voltage:.3f} pu: too little to tell reactive current by"
        )


def due_current_pu(requirement: ReactiveCurrent, evidence: Evidence, window: WindowMeasurements) -> float:
    """Additional reactive current of the positive sequence that is due in a window (pu), clipped as it is judged.

    Raises
    ------
    MeasurementError
        When a voltage or a current cannot be measured.
    """
    return _asked(POSITIVE, requirement, evidence, window).clipped_pu


def _voltage(sequence: Sequence, window: WindowMeasurements) -> float:
    if sequence is POSITIVE:
        return required(window.voltage_positive_pu, "V+")
    return required(window.voltage_negative_pu, "V-")


def _reactive_series(sequence: Sequence, evidence: Evidence) -> Samples:
    if sequence is POSITIVE:
        return evidence.current_positive_pu.reactive
    return evidence.reactive_current_negative_pu


def reactive_before(sequence: Sequence, evidence: Evidence) -> float:
    """Mean reactive current of a sequence in the window before the sag (pu).

    Raises
    ------
    MeasurementError
        When it cannot be measured.
    """
    before = evidence.before()
    if _voltage(sequence, before) < evidence.thresholds.least_sequence_pu.value:
        return 0.0  # without voltage there is no reactive current
    return _mean_reactive(sequence, evidence, before)


def mean_additional(sequence: Sequence, evidence: Evidence, window: WindowMeasurements) -> float:
    """Mean reactive current of a sequence in a window less its mean before the sag (pu).

    Raises
    ------
    MeasurementError
        When one of them cannot be measured.
    """
    return _mean_reactive(sequence, evidence, window) - reactive_before(sequence, evidence)


def _mean_reactive(sequence: Sequence, evidence: Evidence, window: WindowMeasurements) -> float:
    return evidence.once((sequence, window.start_s, window.end_s), lambda: _mean_in(sequence, evidence, window))


def _mean_in(sequence: Sequence, evidence: Evidence, window: WindowMeasurements) -> float:
    inside = evidence.samples(window.start_s, window.end_s)
    series = _reactive_series(sequence, evidence)[inside]
    current = require_finite(series, "the reactive current", evidence.t_s[inside])
    return mean_over_time(current, evidence.step_s[inside])


def additional_current(sequence: Sequence, evidence: Evidence, span: Span) -> tuple[Samples, Samples]:
    """Instants of a span (s), both ends included, and the reactive current there less its mean before the sag (pu).

    Raises
    ------
    MeasurementError
        When one of them cannot be measured.
    """
    inside = evidence.samples(*span)
    t_s = evidence.t_s[inside]
    current = require_finite(_reactive_series(sequence, evidence)[inside], "the reactive current", t_s)
    return t_s, current - reactive_before(sequence, evidence)


def _band(asked: _Asked, requirement: ReactiveCurrent, event: bool) -> _Due:
    """Around the demand, from tolerance to tolerance; ``tolerance_plus_pu`` is on the side of more support.

    Above the threshold of detection there is no fault and nothing is demanded (NTS 631, 5.11.2.2.4: its windows count
    from V+ < 0.85). Nor is support forbidden there: an inverter that follows K without a dead band is no worse than one
    that waits for the threshold. So the band then reaches from zero to the demand, and beyond both by a tolerance.
    """
    below, above = requirement.tolerance_minus_pu.value, requirement.tolerance_plus_pu.value
    if asked.as_in_swell:
        below, above = above, below
    demand = asked.clipped_pu
    words = f"{demand:+.3f} pu for a change of the voltage by {asked.delta_u_pu:+.3f} pu"
    if event:
        return _Due(demand - below, demand + above, f"demanded are {words}")
    words = f"without a voltage event nothing is demanded, allowed are {words}"
    return _Due(min(demand, 0.0) - below, max(demand, 0.0) + above, words)


def _asked(sequence: Sequence, requirement: ReactiveCurrent, evidence: Evidence, window: WindowMeasurements) -> _Asked:
    """Demand on a sequence, clipped together with that on the other one where the profile makes one.

    The reactive currents of both sequences, with what flowed before the sag, may add up to ``limit_pu``: their
    amplitudes add up in the worst phase. Beyond it both shrink in the same proportion.
    """
    delta_u, before, demand = _unclipped(sequence, requirement, evidence, window)
    total = abs(before + demand)
    as_in_swell = delta_u < -evidence.thresholds.voltage_tolerance_pu.value
    other = NEGATIVE if sequence is POSITIVE else POSITIVE
    of_other = evidence.requirements.of_kind(other.kind) if evidence.requirements is not None else None
    if of_other is not None:
        _, other_before, other_demand = _unclipped(other, of_other, evidence, window)
        total += abs(other_before + other_demand)
    if total <= requirement.limit_pu.value:
        return _Asked(delta_u, demand, clipped=False, as_in_swell=as_in_swell)
    clipped = requirement.limit_pu.value / total * (before + demand) - before
    return _Asked(delta_u, clipped, clipped=True, as_in_swell=as_in_swell)


def _unclipped(
    sequence: Sequence, requirement: ReactiveCurrent, evidence: Evidence, window: WindowMeasurements
) -> tuple[float, float, float]:
    """Change of the voltage, reactive current before the sag, and K f(delta u) (pu)."""
    from_nominal = requirement.reference.value == "nominal"
    reference = sequence.nominal_pu if from_nominal else _voltage(sequence, evidence.before())
    change = reference - _voltage(sequence, window)
    delta_u = change if sequence is POSITIVE else -change
    k = evidence.k_factor or requirement.k.value
    demand = k * beyond_dead_band(delta_u, requirement.dead_band_pu.value, requirement.dead_band_mode.value)
    return delta_u, reactive_before(sequence, evidence), demand


def _rests_on(requirement: ReactiveCurrent, asked: _Asked, is_more: bool) -> tuple[Marked, ...]:
    """The numbers that decided; ``is_more``: at the edge of more support than demanded."""
    tolerance = requirement.tolerance_plus_pu if is_more else requirement.tolerance_minus_pu
    shape = (requirement.k, requirement.dead_band_pu, requirement.dead_band_mode, requirement.reference)
    return (*shape, tolerance, *((requirement.limit_pu,) if asked.clipped else ()))
