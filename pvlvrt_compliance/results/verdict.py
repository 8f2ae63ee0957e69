"""One verdict on one requirement in one test."""

from collections.abc import Iterable
from enum import StrEnum
from typing import Annotated

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, FiniteFloat

from pvlvrt_compliance.texts import all_printable


class Status(StrEnum):
    """Verdicts. The order of definition is worst first."""

    ERROR = "error"
    NOT_EVALUATED = "not_evaluated"
    FAIL = "fail"
    PASS = "pass"
    NOT_APPLICABLE = "not_applicable"


_RANK = {status: rank for rank, status in enumerate(Status)}


def worst(statuses: Iterable[Status]) -> Status:
    """Return the worst verdict; of none at all, `not_applicable`."""
    return min(statuses, key=_RANK.__getitem__, default=Status.NOT_APPLICABLE)


class Verdict(BaseModel):
    """One verdict on one requirement in one test."""

    model_config = ConfigDict(frozen=True, extra="ignore")

    check: str = Field(description="name of the check, for instance reactive_support")
    status: Status
    measured: FiniteFloat | None = None
    limit: FiniteFloat | None = None
    margin: FiniteFloat | None = Field(default=None, description="distance to failing, same unit, negative when failed")
    unit: str = ""
    at_s: FiniteFloat | None = Field(default=None, description="the worst instant, from the start of the record")
    clause: str = ""
    confidence: str = Field(default="", description="the weakest mark of the numbers that the verdict rests on")
    # A message may name a file, whose name need not be text.
    message: Annotated[str, BeforeValidator(all_printable)] = ""
