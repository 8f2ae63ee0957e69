"""Where a number comes from and how far it was verified.

A mark belongs to a number, not to a file: one requirement may rest on an equation that was read in the official text
and on a tolerance that this project chose.
"""

import json
from collections.abc import Iterable
from typing import Annotated, Any, Generic, Literal, TypeVar, get_args

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

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
    """All marked items inside a model, each with its dotted name, in the order of definition."""
    if isinstance(item, Marked):
        return [(name, item)]
    if isinstance(item, BaseModel):
        parts: Iterable[tuple[Any, Any]] = item
    elif isinstance(item, dict):
        parts = item.items()
    else:
        return []
    return [found for key, part in parts for found in marks_in(part, f"{name}.{key}" if name else str(key))]


def canonical_json(item: BaseModel) -> str:
    """Same content, same text: keys sorted, no white space, names as in the file, what is left out left out."""
    return json.dumps(
        item.model_dump(mode="json", by_alias=True, exclude_none=True), sort_keys=True, separators=(",", ":")
    )
