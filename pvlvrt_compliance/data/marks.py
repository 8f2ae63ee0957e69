"""Where a number comes from and how far it was verified.

A mark belongs to a number, not to a file: one requirement may rest on an equation that was read in the official text
and on a tolerance that this project chose.
"""

import json
from collections.abc import Iterable, Iterator
from typing import Annotated, Any, Generic, Literal, Self, TypeVar, get_args

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator

Confidence = Literal["confirmed", "code", "secondary", "derived", "inferred", "memory", "memory-low", "chosen"]

CONFIDENCES: tuple[Confidence, ...] = get_args(Confidence)
"""All marks, strongest first."""

CHOSEN = "chosen"
"""Mark of a number that this project has set itself."""

VERIFIED = frozenset({"confirmed", "code"})
"""Marks of numbers that were read in the official text, or in code or test data that implements it."""


def weakest(marks: Iterable[str]) -> str:
    """Return the weakest of some marks; of none at all, an empty string."""
    return max(marks, key=CONFIDENCES.index, default="")


class Frozen(BaseModel):
    """Base of everything in a profile: immutable, closed to unknown keys and to numbers that are not finite."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Marked(Frozen):
    """Something with a provenance of its own."""

    confidence: Confidence
    source: str = Field(min_length=1, description="document and place, or the reason for a chosen number")

    @property
    def marks(self) -> tuple[Confidence, ...]:
        """Its mark, and those that its rows carry in its place."""
        return (self.confidence,)


class Mark(Marked):
    """A mark alone."""


class MarkedRow(Frozen):
    """A row of a table, with a mark of its own where that of the table is not its."""

    confidence: Confidence | None = Field(default=None, description="none: the table's")
    source: str | None = Field(default=None, min_length=1, description="goes with confidence")

    @model_validator(mode="after")
    def _whole_mark(self) -> Self:
        if (self.confidence is None) != (self.source is None):
            given, missing = ("confidence", "source") if self.source is None else ("source", "confidence")
            raise ValueError(f"{missing}: missing; a row with {given} of its own has both")
        return self


def own_mark(row: Any) -> Mark | None:
    """The mark that a row of a table carries itself, None where the table's holds."""
    if isinstance(row, (Marked, MarkedRow)) and row.confidence is not None and row.source is not None:
        return Mark(confidence=row.confidence, source=row.source)
    return None


class MarkedTable(Marked):
    """Rows under one mark; a row may carry another one."""

    @property
    def marked_rows(self) -> Iterable[Any]:
        """What may carry a mark of its own."""
        rows: Iterable[Any] = getattr(self, "rows", ())
        return rows

    @property
    def marks(self) -> tuple[Confidence, ...]:
        """The table's mark, and those that its rows carry in its place."""
        own = map(own_mark, self.marked_rows)
        return (self.confidence, *(mark.confidence for mark in own if mark is not None))

    def mark_of(self, row: Any) -> Mark:
        """The mark of one row: its own, else the table's."""
        return own_mark(row) or Mark(confidence=self.confidence, source=self.source)


class Number(Marked):
    """One number with its mark; the unit is the ending of its key."""

    value: float


class Numbers(Marked):
    """A list of numbers under one mark."""

    values: tuple[float, ...] = Field(min_length=1)


class Flag(Marked):
    """A yes or no with its mark."""

    value: bool


Word = TypeVar("Word")


class Choice(Marked, Generic[Word]):
    """One of some words, with its mark."""

    value: Word

    def __reduce__(self) -> tuple[Any, ...]:
        """For another process, which has no class by the name of these words."""
        return _choice_unfilled, tuple(self.__pydantic_generic_metadata__["args"]), self.__getstate__()


def _choice_unfilled(word: Any) -> Choice[Any]:
    model = Choice[word]
    return model.__new__(model)


def _positive(number: Number) -> Number:
    if number.value <= 0:
        raise ValueError(f"must be above 0, not {number.value:g}")
    return number


def _not_negative(number: Number) -> Number:
    if number.value < 0:
        raise ValueError(f"must be 0 or above, not {number.value:g}")
    return number


def _fraction(number: Number) -> Number:
    if not 0 < number.value <= 1:
        raise ValueError(f"must be above 0 and at most 1, not {number.value:g}")
    return number


Positive = Annotated[Number, AfterValidator(_positive)]
NotNegative = Annotated[Number, AfterValidator(_not_negative)]
Fraction = Annotated[Number, AfterValidator(_fraction)]


def marks_in(item: Any, name: str = "") -> list[tuple[str, Marked]]:
    """All marked items inside a model, each with its dotted name, in the order of definition.

    A row that carries a mark of its own is one of them: ``bands.rows[1]``.
    """
    own = item if isinstance(item, Marked) else own_mark(item)
    found = [(name, own)] if own is not None else []
    return [*found, *(inner for key, part in _parts(item, name) for inner in marks_in(part, key))]


def _parts(item: Any, name: str) -> Iterator[tuple[str, Any]]:
    """What an item holds, each part with its dotted name as a file spells it; of lists, the rows of tables alone."""
    parts: Iterable[tuple[Any, Any]] = item.items() if isinstance(item, dict) else ()
    if isinstance(item, BaseModel):
        parts = [(field.alias or key, getattr(item, key)) for key, field in type(item).model_fields.items()]
    for key, part in parts:
        inner = f"{name}.{key}" if name else str(key)
        if isinstance(part, tuple) and isinstance(item, MarkedTable):
            yield from ((f"{inner}[{k}]", row) for k, row in enumerate(part))
        yield inner, part


def canonical_json(item: BaseModel) -> str:
    """Same content, same text: keys sorted, no white space, names as in the file, what is left out left out."""
    return json.dumps(
        item.model_dump(mode="json", by_alias=True, exclude_none=True), sort_keys=True, separators=(",", ":")
    )
