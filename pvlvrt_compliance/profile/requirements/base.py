"""What all requirements share."""

from functools import cached_property
from typing import ClassVar

from pydantic import Field

from pvlvrt_compliance.data.marks import Frozen, Number, marks_in, weakest


class Requirement(Frozen):
    """Base of all requirements: where the demand is written.

    ``kinds`` are the names that the requirement has under ``requirements`` in a profile; of one that comes with a check
    of another package, the check names it.
    """

    kinds: ClassVar[tuple[str, ...]] = ()

    clause: str = Field(min_length=1)
    source: str = Field(min_length=1)

    @cached_property
    def confidence(self) -> str:
        """The weakest mark of its numbers."""
        return weakest(item.confidence for _, item in marks_in(self))


class CustomRequirement(Requirement):
    """A requirement whose check comes from another package (entry-point group ``pvlvrt_compliance.checks``)."""

    numbers: dict[str, Number] = Field(default_factory=dict)
