"""Requirements of several limits: each is a part, and the part nearest to failing is reported."""

import math
from collections.abc import Sequence
from typing import NamedTuple

from pvlvrt_compliance.checks.evidence import NotApplicable
from pvlvrt_compliance.checks.results import Check
from pvlvrt_compliance.checks.verdicts import judged, pass_or_fail
from pvlvrt_compliance.profile.provenance import Marked
from pvlvrt_compliance.profile.requirements import Requirement

# In the unit of the limit: far finer than any sensor, far coarser than what rounding adds up to.
_DECIMALS = 9


class Part(NamedTuple):
    """One thing that must not exceed its limit."""

    what: str
    measured: float
    limit: float
    unit: str
    at_s: float
    rests_on: tuple[Marked, ...]

    @property
    def margin(self) -> float:
        """Distance to failing, negative when failed; without the rounding noise that decides where both are zero."""
        return round(self.limit - self.measured, _DECIMALS) + 0.0  # adding zero makes of -0.0 a plain 0.0

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


def judged_by_parts(kind: str, requirement: Requirement, parts: Sequence[Part]) -> Check:
    """Verdict on the part with the least margin relative to its limit; one that fails comes before all that pass.

    Raises
    ------
    NotApplicable
        When there is no part.
    """
    if not parts:
        raise NotApplicable("the profile states no limit for this test")
    worst = min(parts, key=lambda part: (part.passed, part.relative_margin))
    side = "within" if worst.passed else "beyond"
    return judged(
        kind,
        requirement,
        pass_or_fail(worst.passed),
        f"{worst.what}: {_text(worst.measured, worst.unit)}, {_text(abs(worst.margin), worst.unit)} {side} the limit "
        f"of {_text(worst.limit, worst.unit)}",
        measured=worst.measured,
        limit=worst.limit,
        margin=worst.margin,
        unit=worst.unit,
        at_s=worst.at_s,
        rests_on=worst.rests_on,
    )


def _text(value: float, unit: str) -> str:
    return f"{value:.4g} {unit}".rstrip()
