"""Support does not switch on and off at a threshold although the voltage of the grid stands still."""

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.checks.check import StretchCheck
from pvlvrt_compliance.checks.verdicts import judged, pass_or_fail
from pvlvrt_compliance.disturbance.model import Stretch
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable, require_finite
from pvlvrt_compliance.profile.requirements import Toggling
from pvlvrt_compliance.results import Verdict
from pvlvrt_compliance.waveforms.container import Samples

KIND = "toggling"


class TogglingCheck(StretchCheck):
    """Judges how often the reactive current comes on anew while the voltage stands, after each of its steps."""

    kind = KIND
    title = "Support that switches on and off"
    requirement = Toggling
    until = "trip"

    def stretches(self, requirement: Toggling, evidence: Evidence) -> tuple[Stretch, ...]:  # noqa: ARG002
        """All that follow a step of the voltage; what else moves is no reason for support to come."""
        end_s = evidence.stretches_until(self.until)[-1].end_s
        return evidence.disturbance.voltage_stretches(end_s)

    def judge_stretch(self, requirement: Toggling, evidence: Evidence, stretch: Stretch) -> Verdict:
        """Count how often the reactive current comes on after having been off, while the voltage asked for stands.

        The reactive current is that of the positive sequence, one cycle, of either sign. Reports the first activation
        that is one too many.

        Raises
        ------
        NotApplicable
            When nothing settled follows the step.
        MeasurementError
            When a voltage or a current is missing or not finite.
        """
        begin_s, end_s = stretch.begin_s + requirement.settling_s.value, stretch.end_s
        settled = evidence.samples_before(begin_s, end_s)
        if settled.start == settled.stop:
            raise NotApplicable("the voltage of the grid has no step that support could follow and settle after")
        t_s = evidence.t_s[settled]
        current = np.abs(require_finite(evidence.reactive_current_pu[settled], "the reactive current", t_s))
        activations_at_s = t_s[activations(current, requirement.on_pu.value, requirement.off_pu.value)]
        count, most = len(activations_at_s), requirement.most_activations.value
        passed = count <= most
        return judged(
            KIND,
            requirement,
            pass_or_fail(passed),
            f"reactive current came on {count} times between {begin_s:.3f} s and {end_s:.3f} s, while the "
            f"voltage of the grid stood still; {most:g} are allowed",
            measured=count,
            limit=most,
            margin=most - count,
            unit="activations",
            at_s=begin_s if passed else activations_at_s[int(most)],
            rests_on=(requirement.on_pu, requirement.off_pu, requirement.most_activations, requirement.settling_s),
            bound="at_most",
        )


def activations(current: Samples, on: float, off: float) -> NDArray[np.intp]:
    """Indices at which a current rises above ``on`` after it had been below ``off``, shape (k,)."""
    state = np.where(current > on, 1, np.where(current < off, 0, -1))  # -1: as it was
    told = np.flatnonzero(state >= 0)
    return told[1:][np.diff(state[told]) > 0]
