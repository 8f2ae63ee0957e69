"""What groups of parameters share: a frozen model that refuses unknown keys, and how the range of a number is found.

Each room that has parameters states them in a ``parameters.py`` of its own, in words with units, which imports no
kernel; `simulation.parameters` joins them. Every number has a range there, its ends included. The ranges are chosen:
wide enough for any inverter of the kind, from a kilowatt to a power station, and for what is wrong on purpose; beyond
them a number is a slip of the hand, and the arithmetic is of no inverter.
"""

from collections.abc import Iterator
from typing import Annotated, Any, get_args

from annotated_types import Ge, Le
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat
from pydantic.fields import FieldInfo

PhaseValues = tuple[float, float, float]
"""A number a phase."""

Gain = Annotated[FiniteFloat, Field(ge=-10, le=10)]
Offset = Annotated[FiniteFloat, Field(ge=-1e5, le=1e5)]
PhaseGains = tuple[Gain, Gain, Gain]
PhaseOffsets = tuple[Offset, Offset, Offset]


class ParameterGroup(BaseModel):
    """Parameters that belong together: ``--set group.name=value`` reaches them."""

    model_config = ConfigDict(frozen=True, extra="forbid")


def ranges_of(field: FieldInfo) -> tuple[tuple[float, float], ...]:
    """Smallest and largest number that a field takes; of a list, of each of its places."""
    return tuple(dict.fromkeys(_ranges((field.annotation, *field.metadata))))


def _ranges(parts: tuple[Any, ...]) -> Iterator[tuple[float, float]]:
    """Ranges among the parts of an annotation, then those of what these are made of."""
    flat = [item for part in parts for item in (part, *getattr(part, "metadata", ()))]
    low = next((item.ge for item in flat if isinstance(item, Ge)), None)
    high = next((item.le for item in flat if isinstance(item, Le)), None)
    if low is not None and high is not None:
        yield low, high  # type: ignore[misc]  # of numbers, which these fields all are
    for part in parts:
        if inner := get_args(part):
            metadata = getattr(part, "__metadata__", ())
            yield from _ranges((inner[0], *metadata)) if metadata else (r for each in inner for r in _ranges((each,)))
