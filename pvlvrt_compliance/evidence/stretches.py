"""A record between the steps of the voltage: what is settled there, and what a step still spoils."""

from bisect import bisect_right

import numpy as np

from pvlvrt_compliance.disturbance.model import Kind, Stretch
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.evidence.series import Mask
from pvlvrt_compliance.measure.durations import median_over_time
from pvlvrt_compliance.waveforms.container import Samples

_BALANCED_PU = 0.005  # V- that two digits show as none
_ORDINALS = ("first", "second", "third", "fourth", "fifth", "sixth")


def name_of(stretch: Stretch, evidence: Evidence) -> str:
    """What a message calls a stretch: which of its kind it is, its voltage and its times."""
    alike_s = evidence.once("beginnings of a kind", lambda: _begins_by_kind(evidence)).get(stretch.kind, [])
    number = max(bisect_right(alike_s, stretch.begin_s), 1)
    ordinal = _ORDINALS[number - 1] if number <= len(_ORDINALS) else f"{number}th"
    kind = "time of normal voltage" if stretch.kind == "normal" else stretch.kind
    positive, negative = stretch.voltage.positive_pu, stretch.voltage.negative_pu
    level = f"{positive:.2f} pu" if negative < _BALANCED_PU else f"V+ {positive:.2f} pu, V- {negative:.2f} pu"
    return f"{ordinal} {kind}, {level}, {stretch.begin_s:.2f} s to {stretch.end_s:.2f} s"


def _begins_by_kind(evidence: Evidence) -> dict[Kind, list[float]]:
    """When the stretches of each kind begin (s), in order of time."""
    found: dict[Kind, list[float]] = {}
    for part in evidence.disturbance.following_stretches(evidence.record_end_s):
        found.setdefault(part.kind, []).append(part.begin_s)
    return found


def name_at(evidence: Evidence, at_s: float | None) -> str:
    """Name of the stretch up to a trip that an instant lies in (s); empty before the first, and of a sole one."""
    begun = evidence.stretches_until("trip")
    here = [part for part in begun if at_s is not None and part.begin_s <= at_s]
    return name_of(here[-1], evidence) if len(evidence.disturbed_until("trip")) > 1 and here else ""


def surely_over_s(evidence: Evidence, end_s: float) -> float:
    """Up to when a stretch is surely not yet what follows (s): a step that was found in a record is a cycle late."""
    is_found = evidence.disturbance.origin == "found" and evidence.disturbance.has_step_at(end_s)
    return end_s - 1 / evidence.frequency_hz if is_found else end_s


def between_steps_s(evidence: Evidence, at_s: float) -> tuple[float, float]:
    """The steps of the voltage next to an instant, or the ends of the record (s)."""
    before_s, after_s = evidence.disturbance.voltage_stretch(at_s)
    begin_s = evidence.waveforms.t0_s if before_s is None else before_s
    return begin_s, evidence.waveforms.end_s if after_s is None else after_s


def settled_pu(evidence: Evidence, voltage_pu: Samples, at_s: float) -> float | None:
    """Median of a voltage between the steps next to an instant, its first cycle left out (pu); None if none is left."""
    begin_s, end_s = between_steps_s(evidence, at_s)
    settled = evidence.samples(begin_s + 1 / evidence.frequency_hz, end_s)
    if settled.start == settled.stop:
        return None
    return median_over_time(voltage_pu[settled], evidence.step_s[settled])


def settling_s(evidence: Evidence) -> float:
    """Time after a step in which a one-cycle quantity is not settled (s)."""
    return evidence.thresholds.settled_cycles.value / evidence.frequency_hz


def after_each_step(evidence: Evidence, time_s: float, instants_s: tuple[float, ...]) -> Mask:
    """Mask of the samples that lie up to some time (s) after one of the instants, shape (n,)."""
    spoiled = np.zeros(len(evidence.t_s), dtype=np.bool_)
    for t in instants_s:
        spoiled[evidence.samples(t, t + time_s)] = True
    return spoiled
