"""One verdict on one requirement in one test."""

import re
from collections.abc import Iterable
from enum import StrEnum
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, computed_field

from pvlvrt_compliance.texts import Id, Name, Text

Bound = Literal["at_least", "at_most", "band"]
"""What a limit is, so that anyone recomputes the margin.

``at_least``: measured - (limit - tolerance); ``at_most``: limit + tolerance - measured; ``band``: limit + tolerance -
|measured|.
"""


class Status(StrEnum):
    """Verdicts. The order of definition is worst first."""

    ERROR = "error"
    NOT_EVALUATED = "not_evaluated"
    FAIL = "fail"
    PASS = "pass"
    NOT_APPLICABLE = "not_applicable"


JUDGED = frozenset({Status.PASS, Status.FAIL})
"""Verdicts on something that could be judged and had to be."""

UNSETTLED = frozenset({Status.ERROR, Status.NOT_EVALUATED, Status.FAIL})
"""Verdicts that somebody has to look into."""

_AFTER_TRIP = re.compile(r"not judged after the trip at (\d+\.\d+) s\b")

_RANK = {status: rank for rank, status in enumerate(Status)}


def worst(statuses: Iterable[Status]) -> Status:
    """Return the worst verdict; of none at all, `not_applicable`."""
    return min(statuses, key=_RANK.__getitem__, default=Status.NOT_APPLICABLE)


_MARGINAL = "whether |margin| is below the uncertainty, which leaves open on which side of its limit a value is"


def _with_marginal(schema: dict[str, Any]) -> None:
    """What is computed stands in every file that this version writes; one of an earlier version may be without."""
    schema["properties"]["marginal"] = {"type": "boolean", "readOnly": True, "description": _MARGINAL}


class Verdict(BaseModel):
    """One verdict on one requirement in one test."""

    model_config = ConfigDict(frozen=True, extra="ignore", json_schema_extra=_with_marginal)

    check: Id = Field(description="name of the check, for instance reactive_support")
    status: Status
    measured: FiniteFloat | None = None
    limit: FiniteFloat | None = None
    margin: FiniteFloat | None = Field(default=None, description="distance to failing, same unit, negative when failed")
    unit: Name = ""
    bound: Bound | None = Field(default=None, description="what the limit is")
    tolerance: FiniteFloat = Field(default=0.0, description="that the limit is widened by, same unit")
    uncertainty: FiniteFloat | None = Field(
        default=None, description="what method and measurement leave open, same unit; none: not known"
    )
    stretch: Name = Field(default="", description="what of a record with several disturbances it speaks of")
    at_s: FiniteFloat | None = Field(default=None, description="the worst instant, from the start of the record")
    clause: Name = ""
    confidence: Name = Field(default="", description="the weakest mark of the numbers that the verdict rests on")
    # A message may name a file, whose name need not be text.
    message: Text = ""
    known: bool = Field(default=False, description="a failure that the baseline knows, and that is no worse than there")
    known_reason: Text = Field(default="", description="why it is lived with, as the baseline says")
    worse: Text = Field(
        default="", description="what is worse than in the baseline, in words; such a verdict fails the run"
    )

    @property
    def is_known(self) -> bool:
        """Whether it is a failure that the baseline knows, and no worse than there."""
        return self.known and self.status is Status.FAIL and not self.worse

    @property
    def is_worse(self) -> bool:
        """Whether it is worse than in the baseline, though no error: it fails the run even where it has passed."""
        return bool(self.worse) and self.status not in (Status.ERROR, Status.NOT_EVALUATED)

    def counted(self, *, allow_unjudged: bool = False) -> Status:
        """What it counts as for a gate.

        An error stays one, and so does what could not be judged, unless ``allow_unjudged``: it counts as
        `not_applicable` then. What is worse than in a baseline fails; a failure that it knows passes.
        """
        is_let_off = allow_unjudged and self.status is Status.NOT_EVALUATED
        if self.status in (Status.ERROR, Status.NOT_EVALUATED) and not is_let_off:
            return self.status
        if self.worse:
            return Status.FAIL
        if is_let_off:
            return Status.NOT_APPLICABLE
        return Status.PASS if self.is_known else self.status

    @property
    def is_marginal(self) -> bool:
        """Whether method and measurement leave open on which side of its limit the verdict lies."""
        if self.margin is None or self.uncertainty is None:
            return False
        return self.status in JUDGED and abs(self.margin) < self.uncertainty

    @property
    def after_trip_s(self) -> float | None:
        """When the inverter tripped (s, from the start of the record), where that is why nothing was judged."""
        found = _AFTER_TRIP.match(self.message)
        return None if found is None else float(found[1])

    @property
    def relative_margin(self) -> float | None:
        """Margin as a share of the limit, so that those of different checks can be compared; negative when failed.

        Of |limit| + tolerance, which is not 0 where the limit is (`active_power_support` demands 0 kW, within 10 kW).
        None where there is no margin, or nothing to divide it by.
        """
        scale = abs(self.limit or 0.0) + self.tolerance
        return None if self.margin is None or scale <= 0 else self.margin / scale

    @computed_field(description=_MARGINAL)
    def marginal(self) -> bool:
        """`is_marginal`, for programs that read the file."""
        return self.is_marginal
