"""The faults of a record: each from its start to its clearing, whatever levels it has in between."""

from bisect import bisect_left
from itertools import groupby, islice

from pvlvrt_compliance.disturbance.model import Stretch
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable, after_trip
from pvlvrt_compliance.measure.windows import Span, standard_windows


def faults(evidence: Evidence) -> tuple[Stretch, ...]:
    """Runs of sags up to a trip, each as one stretch; without any, what the test gives its times from.

    Raises
    ------
    NotApplicable
        When the inverter has tripped before.
    MeasurementError
        When the record does not say everywhere whether the breaker is closed.
    """
    parts = evidence.stretches_until("trip")
    runs = [list(run) for kind, run in groupby(parts, key=lambda part: part.kind) if kind == "sag"]
    found = tuple(run[0].model_copy(update={"end_s": run[-1].end_s}) for run in runs)
    clear_s = min(evidence.disturbance.clear_s, parts[-1].end_s)
    return found or (parts[0].model_copy(update={"end_s": clear_s}),)


def levels(fault: Stretch, evidence: Evidence) -> tuple[Stretch, ...]:
    """The stretches that a fault is made of."""
    return evidence.disturbance.following_stretches(fault.end_s, fault.begin_s)


def window_in(fault: Stretch, evidence: Evidence) -> Span | None:
    """The during-window of a fault, None when it is too short for one."""
    end_s = evidence.waveforms.end_s
    return standard_windows(fault.begin_s, fault.end_s, end_s, evidence.frequency_hz, evidence.rules).during


def is_cut_by_trip(fault: Stretch, evidence: Evidence) -> bool:
    """Whether the inverter trips before the fault is cleared."""
    opened_s = evidence.known_opening_s
    return opened_s is not None and opened_s <= fault.end_s


def require_clearing(fault: Stretch, evidence: Evidence) -> None:
    """Let off what follows a clearing that no one waited for.

    Raises
    ------
    NotApplicable
        When the inverter trips before the fault is cleared.
    """
    opened_s = evidence.known_opening_s
    if opened_s is not None and is_cut_by_trip(fault, evidence):
        raise NotApplicable(after_trip(opened_s))


def next_fault_s(fault: Stretch, evidence: Evidence) -> float | None:
    """When the voltage departs again after a fault, or the inverter trips (s); None when neither follows."""
    parts = evidence.stretches_until("trip")
    after = islice(parts, bisect_left(parts, fault.end_s, key=lambda part: part.begin_s), None)
    departed = next((part.begin_s for part in after if part.kind != "normal"), None)
    opened_s = evidence.known_opening_s
    return min((t for t in (departed, opened_s) if t is not None), default=None)
