"""Support that is due and cannot be seen: a bridge that blocks, a voltage that is gone. Doing nothing is no pass."""

from collections.abc import Iterable

from pvlvrt_compliance.checks.verdicts import judged
from pvlvrt_compliance.data.marks import Marked
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable, require_finite, required
from pvlvrt_compliance.evidence.no_load import no_load_mean_pu
from pvlvrt_compliance.measure.extremes import smallest
from pvlvrt_compliance.measure.quantities import WindowMeasurements
from pvlvrt_compliance.measure.windows import Span
from pvlvrt_compliance.profile.requirements import Requirement
from pvlvrt_compliance.results import Status, Verdict


def destroyed_voltage(
    kind: str, requirement: Requirement, evidence: Evidence, window: WindowMeasurements
) -> Verdict | None:
    """Failure where V+ at the terminals is too little for an angle although the grid has some; None where it is enough.

    Too little on the mean, or at some instant of the window so little that no current can be split there.

    Raises
    ------
    NotApplicable
        When the grid has none either.
    MeasurementError
        When a voltage cannot be measured.
    """
    least, floor = evidence.thresholds.least_sequence_pu, evidence.thresholds.voltage_floor_pu
    mean = required(window.voltage_positive_pu, "V+")
    lowest, at_s = _lowest_voltage(evidence, window)
    if mean >= least.value and lowest >= floor.value:
        return None
    v_positive, needed = (mean, least) if mean < least.value else (lowest, floor)
    without_current, _ = no_load_mean_pu(evidence, Span(window.start_s, window.end_s))
    if without_current < least.value:
        raise NotApplicable(
            f"the positive sequence of the voltage is {v_positive:.3f} pu: too little to tell reactive current by"
        )
    return judged(
        kind,
        requirement,
        Status.FAIL,
        f"V+ at the terminals is {v_positive:.4f} pu at {at_s:.3f} s, too little to tell reactive current by, and "
        f"{without_current:.3f} pu without the inverter's current: the inverter destroyed the voltage",
        measured=v_positive,
        limit=needed.value,
        margin=v_positive - needed.value,
        unit="pu",
        at_s=at_s,
        rests_on=(least, floor),
        bound="at_least",
        uncertainty=evidence.thresholds.voltage_tolerance_pu.value,
    )


def _lowest_voltage(evidence: Evidence, window: WindowMeasurements) -> tuple[float, float]:
    """The least V+ in the window (pu), and when (s)."""
    inside = evidence.samples(window.start_s, window.end_s)
    t_s = evidence.t_s[inside]
    v_positive = require_finite(evidence.voltage_positive_pu[inside], "V+", t_s)
    lowest, at = smallest(v_positive, 1.0)
    return lowest, float(t_s[at])


def is_blocked(evidence: Evidence, window: WindowMeasurements) -> bool:
    """Whether no phase carries current for a cycle somewhere in the window."""
    return _largest_phase(evidence, window)[0] < evidence.blocked_below_pu


def let_off_if_blocked(evidence: Evidence, window: WindowMeasurements, allowed_below_pu: float) -> None:
    """Do nothing unless the bridge is blocked where it may be.

    Raises
    ------
    NotApplicable
        When it is blocked below a V+ that the profile lets it block at.
    MeasurementError
        When a voltage cannot be measured.
    """
    if not is_blocked(evidence, window):
        return
    v_positive = required(window.voltage_positive_pu, "V+")
    if v_positive < allowed_below_pu:
        raise NotApplicable(
            f"the bridge is blocked at V+ = {v_positive:.3f} pu, which is allowed below {allowed_below_pu:g} pu"
        )


def blocked_where_due(
    kind: str, requirement: Requirement, evidence: Evidence, window: WindowMeasurements, rests_on: Iterable[Marked]
) -> Verdict:
    """Failure of a blocked bridge; ``rests_on`` are the numbers by which support is due."""
    largest, at_s = _largest_phase(evidence, window)
    return judged(
        kind,
        requirement,
        Status.FAIL,
        f"no phase carries current for a cycle at {at_s:.3f} s, where support is due: {largest:.4f} pu in the largest, "
        f"{evidence.blocked_below_pu:g} pu are the least",
        measured=largest,
        limit=evidence.blocked_below_pu,
        margin=largest - evidence.blocked_below_pu,
        unit="pu",
        at_s=at_s,
        rests_on=rests_on,
        bound="at_least",
        uncertainty=evidence.thresholds.uncertainty_current_pu.value,
    )


def _largest_phase(evidence: Evidence, window: WindowMeasurements) -> tuple[float, float]:
    """The least that the largest phase carries in the window (pu), and when (s)."""
    inside = evidence.samples(window.start_s, window.end_s)
    t_s = evidence.t_s[inside]
    largest = require_finite(evidence.largest_current_pu[inside], "the current", t_s)
    least, at = smallest(largest, 1.0)
    return least, float(t_s[at])
