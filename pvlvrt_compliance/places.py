"""Places of an array by name: a NamedTuple whose every field holds its own place is a constant of compiled code."""

from typing import NamedTuple, TypeVar

Names = TypeVar("Names", bound=tuple[int, ...])


def numbered(names: type[Names], first: int = 0) -> Names:
    """Count the fields of a NamedTuple, from ``first`` on: no place is written as a number anywhere else."""
    places: Names = names(*range(first, first + len(names._fields)))  # type: ignore[attr-defined]
    return places


class PhasePlaces(NamedTuple):
    """Where three phases stand."""

    a: int
    b: int
    c: int
