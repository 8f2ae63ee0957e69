"""What all requirements share."""

from pydantic import Field

from pvlvrt_compliance.profile.provenance import Frozen, Number, marks_in, weakest


class Requirement(Frozen):
    """Base of all requirements: where the demand is written."""

    clause: str = Field(min_length=1)
    source: str = Field(min_length=1)

    @property
    def confidence(self) -> str:
        """The weakest mark of its numbers."""
        return weakest(item.confidence for _, item in marks_in(self))


class CustomRequirement(Requirement):
    """A requirement whose check comes from another package (entry-point group ``pvlvrt_compliance.checks``)."""

    numbers: dict[str, Number] = Field(default_factory=dict)
