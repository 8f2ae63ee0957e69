"""How strong a grid may be: one range for options, events and the rows of a test table."""

from typing import Annotated

from pydantic import Field, FiniteFloat

ShortCircuitRatio = Annotated[FiniteFloat, Field(gt=0.5, le=1e5)]
"""On 500 kVA. Chosen: at the upper end the grid moves by a hundred-thousandth, and is as good as none."""

ResistanceRatio = Annotated[FiniteFloat, Field(ge=0.01, le=1000)]
"""X/R of the grid. Chosen: cables have 0.1, large machines 100."""
