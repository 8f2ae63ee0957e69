"""Tables of numbers under one mark, or a mark a row: frequency bands, recovery by depth, harmonic limits."""

from itertools import pairwise
from typing import Self

from pydantic import Field, model_validator

from pvlvrt_compliance.data.marks import MarkedRow, MarkedTable


class FrequencyBand(MarkedRow):
    """Frequencies from the first to the second, and how long they must be ridden through."""

    frequency_hz: tuple[float, float]
    ride_s: float | None = Field(default=None, gt=0, description="none: for ever")


class FrequencyBands(MarkedTable):
    """Bands side by side in order of frequency."""

    clause: str = ""
    rows: tuple[FrequencyBand, ...] = Field(min_length=1)

    @model_validator(mode="after")
    def _side_by_side(self) -> Self:
        for row in self.rows:
            if not 0 < row.frequency_hz[0] < row.frequency_hz[1]:
                raise ValueError(f"rows: a band must rise, not {row.frequency_hz[0]:g} to {row.frequency_hz[1]:g} Hz")
        for lower, upper in pairwise(self.rows):
            if lower.frequency_hz[1] != upper.frequency_hz[0]:
                end_hz, begin_hz = lower.frequency_hz[1], upper.frequency_hz[0]
                raise ValueError(f"rows: a band ends at {end_hz:g} Hz, the next begins at {begin_hz:g} Hz")
        return self


class RecoveryRow(MarkedRow):
    """Times for sags whose residual V+ lies between two levels, the first included."""

    residual_pu: tuple[float, float]
    first_s: float = Field(gt=0, description="to the first fraction")
    final_extra_s: float = Field(ge=0, description="after it, to stay within the tolerance of the final value")


class RecoveryTable(MarkedTable):
    """Recovery times by depth."""

    clause: str = ""
    rows: tuple[RecoveryRow, ...] = Field(min_length=1)

    @model_validator(mode="after")
    def _do_not_overlap(self) -> Self:
        bands = sorted(row.residual_pu for row in self.rows)
        for low, high in bands:
            if not 0 <= low < high:
                raise ValueError(f"rows: residual_pu must rise from 0 or above, not {low:g} to {high:g}")
        for lower, upper in pairwise(bands):
            if upper[0] < lower[1]:
                raise ValueError(f"rows: two bands of residual_pu overlap at {upper[0]:g} pu")
        return self

    def row_for(self, residual_pu: float) -> RecoveryRow | None:
        """The row of a residual voltage, None where the table has none."""
        return next((row for row in self.rows if row.residual_pu[0] <= residual_pu < row.residual_pu[1]), None)


class HarmonicLimit(MarkedRow):
    """Limit of the harmonics from one order to another, both included: odd ones, even ones or all."""

    orders: tuple[int, int]
    which: str = Field(default="all", pattern="^(odd|even|all)$")
    limit_percent: float = Field(gt=0)

    def covers(self, order: int) -> bool:
        """Whether the limit is that of an order."""
        low, high = self.orders
        return low <= order <= high and (self.which == "all" or (order % 2 == 1) == (self.which == "odd"))


class HarmonicLimits(MarkedTable):
    """Limits by order; the first row that covers an order counts."""

    clause: str = ""
    rows: tuple[HarmonicLimit, ...] = Field(min_length=1)

    def row_for(self, order: int) -> HarmonicLimit | None:
        """The row of an order, None where the table has none."""
        return next((row for row in self.rows if row.covers(order)), None)

    def limit_of(self, order: int) -> float | None:
        """Limit of an order (percent), None where the table has none."""
        row = self.row_for(order)
        return None if row is None else row.limit_percent
