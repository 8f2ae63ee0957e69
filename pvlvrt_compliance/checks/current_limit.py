"""Phase currents stay within the rating of the inverter."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.checks.evidence import Evidence, require_finite
from pvlvrt_compliance.checks.results import Check
from pvlvrt_compliance.checks.verdicts import judged, pass_or_fail
from pvlvrt_compliance.profile.provenance import Marked
from pvlvrt_compliance.profile.requirements import CurrentLimit
from pvlvrt_compliance.waveforms.container import Samples

KIND = "current_limit"


class _Part(NamedTuple):
    """The worst of one thing that is limited."""

    what: str
    measured_pu: float
    limit_pu: float
    phase: str
    at_s: float
    passed: bool
    rests_on: tuple[Marked, ...]

    @property
    def margin_pu(self) -> float:
        return self.limit_pu - self.measured_pu


def check_current_limit(requirement: CurrentLimit, evidence: Evidence) -> Check:
    """Judge the settled one-cycle fundamentals and the instantaneous peak; reports the part with the least margin.

    Raises
    ------
    MeasurementError
        When a current is missing or not finite.
    """
    parts = [_peak(requirement, evidence), *_fundamentals(requirement, evidence)]
    worst = min(parts, key=lambda part: (part.passed, part.margin_pu))
    side = "below" if worst.passed else "above"
    return judged(
        KIND,
        requirement,
        pass_or_fail(worst.passed),
        f"largest {worst.what} {worst.measured_pu:.3f} pu, in phase {worst.phase} at {worst.at_s:.3f} s, is "
        f"{abs(worst.margin_pu):.3f} pu {side} the limit of {worst.limit_pu:.3f} pu",
        measured=worst.measured_pu,
        limit=worst.limit_pu,
        margin=worst.margin_pu,
        unit="pu",
        at_s=worst.at_s,
        rests_on=worst.rests_on,
    )


def _peak(requirement: CurrentLimit, evidence: Evidence) -> _Part:
    magnitude = require_finite(np.abs(evidence.current_pu), "the current", evidence.t_s)
    measured_pu, phase, at_s = _largest(magnitude, evidence.t_s)
    limit = requirement.peak_pu
    return _Part("instantaneous current", measured_pu, limit.value, phase, at_s, measured_pu < limit.value, (limit,))


def _fundamentals(requirement: CurrentLimit, evidence: Evidence) -> Iterator[_Part]:
    """The fundamental where it is settled: during the sag, when that is long enough, and after it."""
    scenario, settling_s = evidence.scenario, requirement.settling_s.value
    limit_pu = requirement.allowed_pu
    rests_on = (requirement.limit_pu, requirement.tolerance_pu, requirement.settling_s)
    for begin_s, end_s in (
        (scenario.start_s + settling_s, scenario.clear_s),
        (scenario.clear_s + settling_s, evidence.waveforms.end_s),
    ):
        settled = evidence.between(begin_s, end_s)
        if settled.any():
            t_s = evidence.t_s[settled]
            amplitude = require_finite(evidence.current_phase_pu[:, settled], "the fundamental current", t_s)
            measured_pu, phase, at_s = _largest(amplitude, t_s)
            passed = measured_pu <= limit_pu
            yield _Part("fundamental current", measured_pu, limit_pu, phase, at_s, passed, rests_on)


def _largest(values: Samples, t_s: Samples) -> tuple[float, str, float]:
    """Largest value of shape (3, n), its phase and its instant."""
    phase, sample = np.unravel_index(values.argmax(), values.shape)
    return float(values[phase, sample]), "abc"[phase], float(t_s[sample])
