"""What the inverter does in a region: keep feeding, cease or trip."""

from collections.abc import Iterator

import numpy as np

from pvlvrt_compliance.checks.connection.regions import Visit
from pvlvrt_compliance.checks.recovery import settled_after_s
from pvlvrt_compliance.checks.verdicts import judged_at_most
from pvlvrt_compliance.evidence.evidence import Evidence, require_finite
from pvlvrt_compliance.evidence.excursions import excursions, inside_of
from pvlvrt_compliance.evidence.series import Mask
from pvlvrt_compliance.measure.windows import Span
from pvlvrt_compliance.profile.regions import CEASE, RegionTable
from pvlvrt_compliance.profile.requirements import RideThrough
from pvlvrt_compliance.results import Verdict

_KIND = "ride_through"


def responses(
    requirement: RideThrough, table: RegionTable, found: list[Visit], evidence: Evidence, released_at_s: float | None
) -> Iterator[Verdict]:
    """A verdict on each stretch of the record in which a region asks for a response.

    Momentary cessation and ceasing: no current from ``respond_s`` after entering until the voltage leaves the region.
    Tripping: the breaker open ``respond_s`` after entering. Mandatory operation: current at all times but for one
    cycle, until the inverter may let go; only a failure gives a verdict. A stretch that ends before ``respond_s`` is
    over asks for nothing.

    Raises
    ------
    MeasurementError
        When a current or the state of the breaker is missing or not finite.
    """
    for visit in found:
        for stretch in visit.within:
            measured = _measured(visit, stretch, evidence, released_at_s)
            if measured is not None:
                took_s, limit_s, words = measured
                yield judged_at_most(
                    _KIND,
                    requirement,
                    f"{words} in {visit.name}, entered at {stretch.start_s:.3f} s; {limit_s:.3f} s is allowed",
                    measured=took_s,
                    limit=limit_s,
                    unit="s",
                    at_s=min(stretch.start_s + max(took_s, limit_s), stretch.end_s),
                    rests_on=(table,),
                    clause=table.clause,
                )


def _measured(
    visit: Visit, stretch: Span, evidence: Evidence, released_at_s: float | None
) -> tuple[float, float, str] | None:
    """Time that the response took, time allowed (s), and the response in words; None where nothing is asked for."""
    region, lasted_s = visit.region, stretch.end_s - stretch.start_s
    if region.mode == "mandatory":
        return _longest_without_current(stretch, evidence, released_at_s)
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
    here = inside_of([stretch], evidence.t_s)
    t_s = evidence.t_s[here]
    ceased_s = settled_after_s(t_s, _flowing(here, evidence), stretch.start_s)
    return stretch.end_s - stretch.start_s if ceased_s is None else ceased_s


def _longest_without_current(
    stretch: Span, evidence: Evidence, released_at_s: float | None
) -> tuple[float, float, str] | None:
    end_s = min(t for t in (stretch.end_s, released_at_s, evidence.known_opening_s) if t is not None)
    here = inside_of([Span(stretch.start_s, end_s)], evidence.t_s)
    if not here.any():
        return None
    stretches = excursions(~_flowing(here, evidence), evidence.t_s[here])
    longest_s = max((gap.end_s - gap.start_s for gap in stretches), default=0.0)
    allowed_s = 1 / evidence.frequency_hz
    return (longest_s, allowed_s, f"{longest_s:.3f} s without current") if longest_s > allowed_s else None


def _flowing(here: Mask, evidence: Evidence) -> Mask:
    """Whether any phase carries current at each sample of a mask."""
    current = require_finite(np.abs(evidence.current_pu[:, here]), "the current", evidence.t_s[here])
    flowing: Mask = np.asarray((current >= evidence.blocked_below_pu).any(axis=0))
    return flowing
