"""Phase currents stay within the rating of the inverter."""

from collections.abc import Iterator

import numpy as np

from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.checks.parts import Part, by_margin, judged_by_parts
from pvlvrt_compliance.data.marks import Marked
from pvlvrt_compliance.evidence.evidence import Evidence, require_finite
from pvlvrt_compliance.profile.requirements import CurrentLimit
from pvlvrt_compliance.results import Band, Verdict
from pvlvrt_compliance.results.band import CURRENT
from pvlvrt_compliance.waveforms.container import Samples

KIND = "current_limit"


class CurrentLimitCheck(Check):
    """Judges the largest phase current of the record against its limits: settled fundamental and peak."""

    kind = KIND
    title = "Current limit"
    requirement = CurrentLimit

    def judge(self, requirement: CurrentLimit, evidence: Evidence) -> Verdict:
        """Judge the settled one-cycle fundamentals and the instantaneous peak; reports the part with the least margin.

        Raises
        ------
        MeasurementError
            When a current is missing or not finite.
        """
        return judged_by_parts(
            KIND, requirement, [_peak(requirement, evidence), *_fundamentals(requirement, evidence)], nearest=by_margin
        )

    def limits(self, requirement: CurrentLimit, evidence: Evidence) -> tuple[Band, ...]:
        """Both limits, over the whole record."""
        span = (evidence.waveforms.t0_s, evidence.waveforms.end_s)
        named = (("limit, fundamental", requirement.allowed_pu), ("limit, peak", requirement.peak_pu.value))
        return tuple(
            Band(check=KIND, quantity=CURRENT, name=name, t_s=span, lower=(-pu, -pu), upper=(pu, pu))
            for name, pu in named
        )


def _peak(requirement: CurrentLimit, evidence: Evidence) -> Part:
    magnitude = require_finite(np.abs(evidence.current_pu), "the current", evidence.t_s)
    return _part("instantaneous current", magnitude, evidence.t_s, requirement.peak_pu.value, (requirement.peak_pu,))


def _fundamentals(requirement: CurrentLimit, evidence: Evidence) -> Iterator[Part]:
    """The fundamental where it is settled: during the sag, when that is long enough, and after it."""
    grid, settling_s = evidence.disturbance, requirement.settling_s.value
    rests_on = (requirement.limit_pu, requirement.tolerance_pu, requirement.settling_s)
    for begin_s, end_s in (
        (grid.start_s + settling_s, grid.clear_s),
        (grid.clear_s + settling_s, evidence.waveforms.end_s),
    ):
        settled = evidence.between(begin_s, end_s)
        if settled.any():
            t_s = evidence.t_s[settled]
            amplitude = require_finite(evidence.current_phase_pu[:, settled], "the fundamental current", t_s)
            yield _part("fundamental current", amplitude, t_s, requirement.allowed_pu, rests_on)


def _part(what: str, values: Samples, t_s: Samples, limit_pu: float, rests_on: tuple[Marked, ...]) -> Part:
    """The largest value of shape (3, n), with its phase and its instant."""
    phase, sample = np.unravel_index(values.argmax(), values.shape)
    words = f"largest {what}, in phase {'abc'[phase]} at {t_s[sample]:.3f} s"
    return Part(words, float(values[phase, sample]), limit_pu, "pu", float(t_s[sample]), rests_on)
