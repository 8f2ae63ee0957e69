"""Tests that are written in short: named steps of the voltage, and corners of regions."""

import re
from typing import Self

from pydantic import Field, model_validator

from pvlvrt_compliance.data.marks import Frozen, Marked
from pvlvrt_compliance.scenario.events import LONGEST_S, SHORTEST_S
from pvlvrt_compliance.scenario.sag import PhaseNames

_STEP = re.compile(r"[A-Z]'*")


class Step(Frozen):
    """A voltage of all phases, held."""

    voltage_pu: float = Field(ge=0, le=2)
    duration_s: float = Field(ge=SHORTEST_S, le=LONGEST_S)


class StepTable(Marked):
    """Steps by letter; a primed letter is a variant of the plain one."""

    clause: str = ""
    steps: dict[str, Step] = Field(min_length=1)

    @model_validator(mode="after")
    def _letters(self) -> Self:
        for name in self.steps:
            if not _STEP.fullmatch(name):
                raise ValueError(f"steps: {name!r} is not a capital letter with or without primes")
        return self

    def in_order(self, order: str) -> tuple[Step, ...]:
        """The steps of an order such as ``ABCD'F``.

        Raises
        ------
        ValueError
            When the order names a step that the table lacks.
        """
        names = _STEP.findall(order)
        unknown = [name for name in names if name not in self.steps]
        if unknown or "".join(names) != order:
            raise ValueError(f"order: {order!r} names {unknown or 'no letters'}; the table has {', '.join(self.steps)}")
        return tuple(self.steps[name] for name in names)


class CornerTests(Marked):
    """One test just inside each corner of the regions in which the inverter must stay connected."""

    clause: str = ""
    inside_pu: float = Field(gt=0, description="voltage, from the level")
    inside_s: float = Field(gt=0, description="shorter than the time")
    powers: tuple[str, ...] = Field(min_length=1)
    phases: tuple[PhaseNames, ...] = Field(default=("abc",), min_length=1, description="of sags; swells have all")
    checks: tuple[str, ...] | None = Field(default=None, min_length=1, description="kinds judged; none: all")
    long_from_s: float = Field(default=600.0, gt=0, description="longer tests run on request only")
