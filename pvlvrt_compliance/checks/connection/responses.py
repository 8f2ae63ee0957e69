"""What the inverter does in a region: cease or trip."""

from collections.abc import Iterator

import numpy as np

from pvlvrt_compliance.checks.connection.feeding import flowing
from pvlvrt_compliance.checks.connection.regions import Visit
from pvlvrt_compliance.checks.recovery import settled_after_s
from pvlvrt_compliance.checks.verdicts import judged_at_most
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.measure.windows import Span
from pvlvrt_compliance.profile.regions import CEASE, RegionTable
from pvlvrt_compliance.profile.requirements import RideThrough
from pvlvrt_compliance.results import Verdict

_KIND = "ride_through"


def responses(
    requirement: RideThrough, table: RegionTable, at_terminals: list[Visit], no_load: list[Visit], evidence: Evidence
) -> Iterator[Verdict]:
    """A verdict on each stretch of the record in which a region asks for a response.

    Momentary cessation and ceasing: no current from ``respond_s`` after entering until the voltage leaves the region.
    Tripping: the breaker open ``respond_s`` after entering. A stretch that ends before ``respond_s`` is over asks for
    nothing. The region is that of the voltage at the terminals; where it is not that of the voltage without the
    inverter's current, which its own current may have changed, what either of them asks for passes.

    Raises
    ------
    MeasurementError
        When a current or the state of the breaker is missing or not finite.
    """
    for visit in at_terminals:
        for stretch in visit.within:
            measured = _measured(visit, stretch, evidence)
            if measured is None or (measured[0] > measured[1] and _other_allows(visit, stretch, no_load, evidence)):
                continue
            took_s, limit_s, words = measured
            yield judged_at_most(
                _KIND,
                requirement,
                f"{words} in {visit.name}, entered at {stretch.start_s:.3f} s; {limit_s:.3f} s is allowed",
                measured=took_s,
                limit=limit_s,
                unit="s",
                at_s=min(stretch.start_s + max(took_s, limit_s), stretch.end_s),
                rests_on=(table.mark_of(visit.region),),
                clause=table.clause,
                uncertainty=evidence.thresholds.uncertainty_instant_s.value,
            )


def _other_allows(visit: Visit, stretch: Span, no_load: list[Visit], evidence: Evidence) -> bool:
    """Whether the voltage without the inverter's current lies in another region here, whose answer was given."""
    end_s = stretch.end_s
    same = next(other for other in no_load if other.region == visit.region)
    overlap_s = sum(max(min(end_s, part.end_s) - max(stretch.start_s, part.start_s), 0.0) for part in same.within)
    if overlap_s >= (visit.region.respond_s or 0.0):
        return False
    for other in no_load:
        for part in other.within:
            common = Span(max(part.start_s, stretch.start_s), min(part.end_s, end_s))
            if common.end_s > common.start_s and other.region != visit.region:
                answer = _measured(other, common, evidence)
                if answer is not None and answer[0] > answer[1]:
                    return False
    return True


def _measured(visit: Visit, stretch: Span, evidence: Evidence) -> tuple[float, float, str] | None:
    """Time that the response took, time allowed (s), and the response in words; None where nothing is asked for."""
    region, lasted_s = visit.region, stretch.end_s - stretch.start_s
    if region.respond_s is None or lasted_s <= region.respond_s:
        return None
    if region.mode in CEASE:
        took_s = _ceased_after_s(stretch, evidence)
        words = "current still flowing at the end" if took_s >= lasted_s else f"current gone after {took_s:.3f} s"
        return took_s, region.respond_s, words
    opened_s = evidence.disconnected_at_s
    took_s = lasted_s if opened_s is None else min(max(opened_s - stretch.start_s, 0.0), lasted_s)
    words = "breaker still closed at the end" if took_s >= lasted_s else f"breaker opened after {took_s:.3f} s"
    return took_s, region.respond_s, words


def _ceased_after_s(stretch: Span, evidence: Evidence) -> float:
    """Time from entering until no phase carries current for the rest of the stretch (s)."""
    here = slice(*np.searchsorted(evidence.t_s, stretch).tolist())
    t_s = evidence.t_s[here]
    ceased_s = settled_after_s(t_s, flowing(here, evidence), stretch.start_s)
    return stretch.end_s - stretch.start_s if ceased_s is None else ceased_s
