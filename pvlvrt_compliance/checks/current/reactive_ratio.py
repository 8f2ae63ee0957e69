"""During a sag the current is reactive in the share that the voltage asks for."""

from collections.abc import Iterator
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from pvlvrt_compliance.checks.check import StretchCheck
from pvlvrt_compliance.checks.limits import along, of_each
from pvlvrt_compliance.checks.verdicts import judged, pass_or_fail
from pvlvrt_compliance.disturbance.model import Stretch
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable, require_finite
from pvlvrt_compliance.evidence.no_load import no_load_series_pu
from pvlvrt_compliance.evidence.series import Mask
from pvlvrt_compliance.evidence.stretches import surely_over_s
from pvlvrt_compliance.measure.durations import mean_over_time
from pvlvrt_compliance.measure.extremes import smallest
from pvlvrt_compliance.profile.requirements import ReactiveRatio
from pvlvrt_compliance.results import Band, Status, Verdict
from pvlvrt_compliance.results.band import REACTIVE_SHARE
from pvlvrt_compliance.waveforms.container import Samples

KIND = "reactive_ratio"


class ReactiveRatioCheck(StretchCheck):
    """Judges the share of reactive current in the positive-sequence current in each sag, at each instant."""

    kind = KIND
    title = "Share of the reactive current"
    requirement = ReactiveRatio

    def judge_stretch(self, requirement: ReactiveRatio, evidence: Evidence, stretch: Stretch) -> Verdict:
        """Judge I_reactive / I_total of the positive sequence's fundamental at every instant; reports the worst.

        I_total is the whole positive-sequence current, so that the share is the sine of its angle behind V+: the share
        does not depend on how an inverter shares its current between phases. Reactive current that lowers V+ has a
        negative share. Counts from ``within_s`` after each step, at the V+ of the same cycle, and only while that is a
        voltage event by the profile's thresholds: without one nothing is demanded, and nothing forbidden. Where a share
        is demanded, too little current to have one fails.

        Raises
        ------
        NotApplicable
            When the stretch is shorter than that or no event, or the grid leaves no room for a current.
        MeasurementError
            When V+ or the current cannot be measured.
        """
        seen = _seen(requirement, evidence, stretch)
        for failure in (_voltage_destroyed, _too_little_current):
            if (verdict := failure(requirement, evidence, seen)) is not None:
                return verdict
        if not seen.has_share.any():
            raise NotApplicable("the current is too little for a share, and the grid leaves no room for more")
        return _judge_share(requirement, evidence, seen.where(seen.has_share))

    def limits(self, requirement: ReactiveRatio, evidence: Evidence) -> tuple[Band, ...]:
        """The share that is demanded at each instant, and the same less the tolerance."""

        def bands(stretch: Stretch) -> Iterator[Band]:
            seen = _seen(requirement, evidence, stretch)
            draw = partial(along, KIND, REACTIVE_SHARE, "share demanded", seen.t_s)
            yield draw(lower=seen.demanded)
            yield draw(lower=seen.demanded - requirement.tolerance.value, widened=True)

        return of_each(self.stretches(requirement, evidence), bands)


class _Seen(NamedTuple):
    """Instants at which a share counts, and what was measured there; shape (n,) each."""

    t_s: Samples
    v_positive_pu: Samples
    demanded: Samples  # share
    reactive_pu: Samples  # not a number where there is no voltage
    total_pu: Samples
    share: Samples
    least_pu: Samples  # total current that is due
    no_load_pu: Samples  # V+
    has_room: Mask  # whether V+ and V- of the grid differ by enough for a current to be due

    @property
    def has_share(self) -> Mask:
        return np.asarray(self.total_pu >= self.least_pu)  # false where there is no voltage

    def where(self, mask: Mask) -> "_Seen":
        fields: list[Any] = [x[mask] for x in self]
        return _Seen(*fields)


def _seen(requirement: ReactiveRatio, evidence: Evidence, stretch: Stretch) -> _Seen:
    within_s = requirement.within_s.value
    inside = evidence.samples(stretch.begin_s + within_s, surely_over_s(evidence, stretch.end_s))
    t_s = evidence.t_s[inside]
    if not len(t_s):
        length_s = stretch.end_s - stretch.begin_s
        raise NotApplicable(f"the {length_s:.3f} s are over before the {within_s:g} s from which the share is demanded")
    v_positive = require_finite(evidence.voltage_positive_pu[inside], "V+", t_s)
    event = evidence.is_event(v_positive)
    if not event.any():
        raise NotApplicable("V+ does not pass the threshold of detection: no share is demanded")
    require_finite(evidence.current_phase_pu[:, inside], "the current", t_s)
    active, reactive = (part[inside] for part in evidence.current_positive_pu)
    demanded = requirement.curve.share_at(v_positive)
    positive, negative = (
        require_finite(no_load_series_pu(evidence, index)[inside], "the no-load voltage", t_s) for index in (0, 1)
    )
    return _Seen(
        t_s=t_s,
        v_positive_pu=v_positive,
        demanded=demanded,
        reactive_pu=reactive,
        total_pu=np.hypot(active, reactive),
        share=evidence.reactive_share[inside],
        least_pu=_least_pu(requirement, evidence, demanded),
        no_load_pu=positive,
        has_room=positive - negative >= evidence.thresholds.least_difference_pu.value,
    ).where(event)


def _least_pu(requirement: ReactiveRatio, evidence: Evidence, demanded: Samples) -> Samples:
    """Total current that is due: no more than flowed before, unless the share of nominal current is more."""
    before = evidence.before()
    inside = evidence.samples(before.start_s, before.end_s)
    total = np.hypot(*(part[inside] for part in evidence.current_positive_pu))
    require_finite(total, "the current", evidence.t_s[inside])
    usual = mean_over_time(total, evidence.step_s[inside])
    return np.minimum(requirement.least_current_pu.value, np.maximum(demanded, usual))


def _voltage_destroyed(requirement: ReactiveRatio, evidence: Evidence, seen: _Seen) -> Verdict | None:
    least = evidence.thresholds.least_sequence_pu
    gone = np.isnan(seen.reactive_pu) & (seen.no_load_pu >= least.value) & (seen.demanded > 0)
    if not gone.any():
        return None
    at = seen.where(gone)
    v_positive, lowest = smallest(at.v_positive_pu, 1.0)
    return judged(
        KIND,
        requirement,
        Status.FAIL,
        f"V+ at the terminals was {v_positive:.4f} pu at {at.t_s[lowest]:.3f} s, too little to tell reactive current "
        f"by, and {at.no_load_pu[lowest]:.3f} pu without the inverter's current: the inverter destroyed the voltage",
        measured=v_positive,
        limit=evidence.thresholds.voltage_floor_pu.value,
        margin=v_positive - evidence.thresholds.voltage_floor_pu.value,
        unit="pu",
        at_s=at.t_s[lowest],
        rests_on=(requirement.curve, least, evidence.thresholds.voltage_floor_pu),
        bound="at_least",
        uncertainty=evidence.thresholds.voltage_tolerance_pu.value,
    )


def _too_little_current(requirement: ReactiveRatio, evidence: Evidence, seen: _Seen) -> Verdict | None:
    missing = (seen.total_pu < seen.least_pu) & (seen.demanded > 0) & seen.has_room
    if not missing.any():
        return None
    at = seen.where(missing)
    above, worst = smallest(at.total_pu - at.least_pu, 1.0)
    least = float(at.least_pu[worst])
    total = least + above
    return judged(
        KIND,
        requirement,
        Status.FAIL,
        f"positive-sequence current is {total:.3f} pu at {at.t_s[worst]:.3f} s, less than the {least:.3f} pu that are "
        f"due; a reactive share of {at.demanded[worst]:.3f} is demanded at V+ = {at.v_positive_pu[worst]:.3f} pu",
        measured=total,
        limit=least,
        margin=total - least,
        unit="pu",
        at_s=at.t_s[worst],
        rests_on=(requirement.curve, requirement.within_s, requirement.least_current_pu),
        bound="at_least",
        uncertainty=evidence.thresholds.uncertainty_current_pu.value,
    )


def _judge_share(requirement: ReactiveRatio, evidence: Evidence, seen: _Seen) -> Verdict:
    above, worst = smallest(seen.share - seen.demanded, 1.0)
    demanded, tolerance = float(seen.demanded[worst]), requirement.tolerance.value
    limit = demanded - tolerance
    share = demanded + above
    margin = share - limit
    return judged(
        KIND,
        requirement,
        pass_or_fail(margin >= 0),
        f"smallest share of the reactive current against the demand is {share:.3f}, at {seen.t_s[worst]:.3f} s; "
        f"{demanded:.3f} is demanded at V+ = {seen.v_positive_pu[worst]:.3f} pu, with a tolerance of {tolerance:g}",
        measured=share,
        limit=limit,
        margin=margin,
        unit="",
        at_s=seen.t_s[worst],
        rests_on=(requirement.curve, requirement.within_s, requirement.tolerance),
        bound="at_least",
        uncertainty=evidence.thresholds.uncertainty_current_pu.value / float(seen.total_pu[worst]),
    )
