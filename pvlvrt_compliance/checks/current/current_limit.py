"""Phase currents stay within the rating of the inverter."""

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.checks.parts import Part, judged_by_parts
from pvlvrt_compliance.data.marks import Marked
from pvlvrt_compliance.disturbance.model import Moved
from pvlvrt_compliance.evidence.evidence import Evidence, require_finite
from pvlvrt_compliance.evidence.stretches import name_at, surely_over_s
from pvlvrt_compliance.measure.extremes import largest
from pvlvrt_compliance.measure.windows import Span
from pvlvrt_compliance.profile.requirements import CurrentLimit
from pvlvrt_compliance.results import Band, Verdict
from pvlvrt_compliance.results.band import CURRENT
from pvlvrt_compliance.waveforms.container import Samples

KIND = "current_limit"

_UPSETTING: tuple[Moved, ...] = ("voltage", "angle", "frequency", "strength", "recording")
"""What a current needs time to settle after."""


class CurrentLimitCheck(Check):
    """Judges the largest phase current up to a trip: its peak, its fundamental once settled and on the way there."""

    kind = KIND
    title = "Current limit"
    requirement = CurrentLimit
    judges_up_to_trip = True

    def judge(self, requirement: CurrentLimit, evidence: Evidence) -> Verdict:
        """Judge the one-cycle fundamentals and the instantaneous peak; reports the part with the least margin.

        Raises
        ------
        MeasurementError
            When a current is missing or not finite, or the record does not say everywhere whether the breaker is
            closed.
        """
        parts = [_part(stage, evidence) for stage in _stages(requirement, evidence)]
        verdict = judged_by_parts(KIND, requirement, parts, one_unit=True)
        return verdict.model_copy(update={"stretch": name_at(evidence, verdict.at_s)})

    def limits(self, requirement: CurrentLimit, evidence: Evidence) -> tuple[Band, ...]:
        """Every limit over the time that it was held against the current."""
        return tuple(
            Band(
                check=KIND,
                quantity=CURRENT,
                name=f"limit, {stage.name}",
                t_s=stage.span,
                lower=(-stage.limit_pu, -stage.limit_pu),
                upper=(stage.limit_pu, stage.limit_pu),
            )
            for stage in _stages(requirement, evidence)
        )


class _Stage(NamedTuple):
    """A limit of the current over a time."""

    name: str
    what: str  # that is limited
    span: Span
    limit_pu: float
    rests_on: tuple[Marked, ...]


def _stages(requirement: CurrentLimit, evidence: Evidence) -> Iterator[_Stage]:
    """The peak all along, the fundamental after each step; those in which there is a sample."""
    end_s = _end_s(evidence)
    peak = requirement.peak_pu
    yield _Stage("peak", "instantaneous current", Span(evidence.waveforms.t0_s, end_s), peak.value, (peak,))
    for begin_s, until_s in pairwise((*_begins_s(evidence, end_s), end_s)):
        for stage in _fundamentals(requirement, begin_s, surely_over_s(evidence, until_s), 1 / evidence.frequency_hz):
            seen = evidence.samples(*stage.span)
            if seen.start < seen.stop:
                yield stage


def _end_s(evidence: Evidence) -> float:
    """The trip, or the end of the record (s)."""
    opened_s = evidence.known_opening_s
    return evidence.waveforms.end_s if opened_s is None else opened_s


def _begins_s(evidence: Evidence, end_s: float) -> list[float]:
    """The start of the test and each step that a current needs time to settle after (s)."""
    grid = evidence.disturbance
    return sorted(t for t in {grid.start_s, *grid.steps_of(*_UPSETTING)} if evidence.waveforms.t0_s <= t < end_s)


def _fundamentals(requirement: CurrentLimit, begin_s: float, until_s: float, cycle_s: float) -> Iterator[_Stage]:
    """The fundamental between two steps: on its way, where that has a limit, and settled."""
    settled_s = begin_s + requirement.settling_s.value
    stage, from_cycles = requirement.stage_pu, requirement.stage_from_cycles
    if stage is not None and from_cycles is not None:
        span = Span(begin_s + from_cycles.value * cycle_s, min(settled_s, until_s))
        yield _Stage("fundamental, settling", "unsettled fundamental current", span, stage.value, (stage, from_cycles))
    rests_on = (requirement.limit_pu, requirement.tolerance_pu, requirement.settling_s)
    yield _Stage("fundamental", "fundamental current", Span(settled_s, until_s), requirement.allowed_pu, rests_on)


def _part(stage: _Stage, evidence: Evidence) -> Part:
    """The largest value of a stage, with its phase and its instant."""
    inside = evidence.samples(*stage.span)
    t_s = evidence.t_s[inside]
    values = require_finite(_values(stage, evidence, inside), f"the {stage.what}", t_s)
    most, at = largest(values.T, 1.0)
    sample, phase = divmod(at, len(values))
    words = f"largest {stage.what}, in phase {'abc'[phase]} at {t_s[sample]:.3f} s"
    uncertainty = evidence.thresholds.uncertainty_current_pu.value
    return Part(words, most, stage.limit_pu, "pu", float(t_s[sample]), stage.rests_on, uncertainty)


def _values(stage: _Stage, evidence: Evidence, inside: slice) -> Samples:
    return np.abs(evidence.current_pu[:, inside]) if stage.name == "peak" else evidence.current_phase_pu[:, inside]
