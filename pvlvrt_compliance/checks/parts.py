"""Requirements of several limits: each is a part, and the part nearest to failing is reported."""

import math
from collections.abc import Sequence
from typing import NamedTuple

from pvlvrt_compliance.checks.verdicts import judged, pass_or_fail
from pvlvrt_compliance.data.marks import Marked
from pvlvrt_compliance.evidence.evidence import NotApplicable
from pvlvrt_compliance.measure.extremes import first_least
from pvlvrt_compliance.profile.requirements import Requirement
from pvlvrt_compliance.results import Verdict
from pvlvrt_compliance.results.digits import digits_of

# In the unit of the limit: far finer than any sensor, far coarser than what rounding adds up to.
_NOISE = 0.5e-9


class Part(NamedTuple):
    """One thing that must not exceed its limit."""

    what: str
    measured: float
    limit: float
    unit: str
    at_s: float
    rests_on: tuple[Marked, ...]
    uncertainty: float | None = None
    """What method and measurement leave open, same unit."""

    @property
    def margin(self) -> float:
        """Distance to failing, negative when failed; without the rounding noise that decides where both are zero."""
        margin = self.limit - self.measured
        return margin if abs(margin) >= _NOISE else 0.0

    @property
    def passed(self) -> bool:
        """Whether the limit is kept."""
        return self.margin >= 0

    @property
    def relative_margin(self) -> float:
        """Margin as a fraction of the limit, by which parts of different units are compared."""
        if self.limit > 0:
            return self.margin / self.limit
        return math.inf if self.passed else -math.inf


def judged_by_parts(
    kind: str,
    requirement: Requirement,
    parts: Sequence[Part],
    *,
    one_unit: bool = False,
) -> Verdict:
    """Verdict on the part with the least margin; one that fails comes first, of several that are equal the first.

    Margins count relative to their limits, as parts of ``one_unit`` as they are.

    Raises
    ------
    NotApplicable
        When there is no part.
    """
    if not parts:
        raise NotApplicable("the profile states no limit for this test")
    failed = [part for part in parts if not part.passed]
    worst = _nearest(failed or parts, one_unit)
    verdict = judged(
        kind,
        requirement,
        pass_or_fail(worst.passed),
        "",
        measured=worst.measured,
        limit=worst.limit,
        margin=worst.margin,
        unit=worst.unit,
        at_s=worst.at_s,
        rests_on=worst.rests_on,
        bound="at_most",
        uncertainty=worst.uncertainty,
    )
    return verdict.model_copy(update={"message": _message(worst, verdict)})


def _nearest(parts: Sequence[Part], one_unit: bool) -> Part:
    if one_unit:
        return first_least(parts, lambda part: part.margin, max(part.limit for part in parts))
    return first_least(parts, lambda part: part.relative_margin, 1.0)


def _message(part: Part, verdict: Verdict) -> str:
    """What was measured and how far it is from its limit, with the digits of the verdict's own row."""
    places, margin = digits_of(verdict)
    measured, distance, limit = (
        f"{value:.{places}f} {part.unit}".rstrip() for value in (part.measured, abs(margin or 0.0), part.limit)
    )
    return f"{part.what}: {measured}, {distance} {'within' if part.passed else 'beyond'} the limit of {limit}"
