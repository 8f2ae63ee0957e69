"""A record between the steps of the voltage: what is settled there, and what a step still spoils."""

import numpy as np

from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.evidence.series import Mask
from pvlvrt_compliance.measure.durations import median_over_time
from pvlvrt_compliance.waveforms.container import Samples


def between_steps_s(evidence: Evidence, at_s: float) -> tuple[float, float]:
    """The steps of the voltage next to an instant, or the ends of the record (s)."""
    before_s, after_s = evidence.disturbance.voltage_stretch(at_s)
    begin_s = evidence.waveforms.t0_s if before_s is None else before_s
    return begin_s, evidence.waveforms.end_s if after_s is None else after_s


def settled_pu(evidence: Evidence, voltage_pu: Samples, at_s: float) -> float | None:
    """Median of a voltage between the steps next to an instant, its first cycle left out (pu); None if none is left."""
    begin_s, end_s = between_steps_s(evidence, at_s)
    settled = evidence.between(begin_s + 1 / evidence.frequency_hz, end_s)
    return median_over_time(voltage_pu[settled], evidence.step_s[settled]) if settled.any() else None


def settling_s(evidence: Evidence) -> float:
    """Time after a step in which a one-cycle quantity is not settled (s)."""
    return evidence.thresholds.settled_cycles.value / evidence.frequency_hz


def after_each_step(evidence: Evidence, time_s: float, instants_s: tuple[float, ...]) -> Mask:
    """Mask of the samples that lie up to some time (s) after one of the instants, shape (n,)."""
    spoiled = np.zeros(len(evidence.t_s), dtype=np.bool_)
    for t in instants_s:
        spoiled |= evidence.between(t, t + time_s)
    return spoiled
