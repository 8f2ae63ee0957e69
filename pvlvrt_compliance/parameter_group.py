"""What groups of parameters share: a frozen model that refuses unknown keys, and kinds of numbers.

Each room that has parameters states them in a ``parameters.py`` of its own, in words with units, which imports no
kernel; `simulation.parameters` joins them.
"""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

Positive = Annotated[FiniteFloat, Field(gt=0)]
NotNegative = Annotated[FiniteFloat, Field(ge=0)]
PhaseValues = tuple[FiniteFloat, FiniteFloat, FiniteFloat]


class ParameterGroup(BaseModel):
    """Parameters that belong together: ``--set group.name=value`` reaches them."""

    model_config = ConfigDict(frozen=True, extra="forbid")
