"""Support does not switch on and off at a threshold although the voltage of the grid stands still."""

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.checks.disturbances import voltage_steps_s
from pvlvrt_compliance.checks.evidence import Evidence, NotApplicable, require_finite
from pvlvrt_compliance.checks.results import Check
from pvlvrt_compliance.checks.verdicts import judged, pass_or_fail
from pvlvrt_compliance.profile.requirements import Toggling
from pvlvrt_compliance.waveforms.container import Samples

KIND = "toggling"


class _Stretch(NamedTuple):
    """The record between two steps of the voltage, once settled."""

    begin_s: float
    end_s: float
    activations_at_s: Samples


def check_toggling(requirement: Toggling, evidence: Evidence) -> Check:
    """Count how often the reactive current comes on after having been off, between two steps of the voltage asked for.

    The reactive current is that of the positive sequence, one cycle, of either sign. Reports the stretch with the most
    activations, and the first of them that is one too many.

    Raises
    ------
    NotApplicable
        When the voltage asked for has no step, or none that is followed by anything settled.
    MeasurementError
        When a voltage or a current is missing or not finite.
    """
    stretches = list(_stretches(requirement, evidence))
    if not stretches:
        raise NotApplicable("the voltage of the grid has no step that support could follow and settle after")
    worst = max(stretches, key=lambda stretch: len(stretch.activations_at_s))
    count, most = len(worst.activations_at_s), requirement.most_activations.value
    passed = count <= most
    return judged(
        KIND,
        requirement,
        pass_or_fail(passed),
        f"reactive current came on {count} times between {worst.begin_s:.3f} s and {worst.end_s:.3f} s, while the "
        f"voltage of the grid stood still; {most:g} are allowed",
        measured=count,
        limit=most,
        margin=most - count,
        unit="activations",
        at_s=worst.begin_s if passed else worst.activations_at_s[int(most)],
        rests_on=(requirement.on_pu, requirement.off_pu, requirement.most_activations, requirement.settling_s),
    )


def _stretches(requirement: Toggling, evidence: Evidence) -> Iterator[_Stretch]:
    steps_s = voltage_steps_s(evidence.scenario)
    for step_s, end_s in pairwise((*steps_s, evidence.waveforms.end_s)):
        begin_s = step_s + requirement.settling_s.value
        settled = evidence.between(begin_s, end_s) & (evidence.t_s < end_s)
        if settled.any():
            t_s = evidence.t_s[settled]
            current = np.abs(require_finite(evidence.reactive_current_pu[settled], "the reactive current", t_s))
            came_on = activations(current, requirement.on_pu.value, requirement.off_pu.value)
            yield _Stretch(begin_s, end_s, t_s[came_on])


def activations(current: Samples, on: float, off: float) -> NDArray[np.intp]:
    """Indices at which a current rises above ``on`` after it had been below ``off``, shape (k,)."""
    state = np.where(current > on, 1, np.where(current < off, 0, -1))  # -1: as it was
    told = np.flatnonzero(state >= 0)
    return told[1:][np.diff(state[told]) > 0]
