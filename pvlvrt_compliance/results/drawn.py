"""What a figure draws of a requirement besides limits over time, kept beside the verdict that it belongs to."""

from typing import Self

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, model_validator

from pvlvrt_compliance.results.band import Band, Line
from pvlvrt_compliance.texts import Name


class _Frozen(BaseModel):
    model_config = ConfigDict(frozen=True, extra="ignore")


class SpectrumBar(_Frozen):
    """One component of a spectrum, or a total of several, in the phase that has the most of it."""

    order: int | None = Field(default=None, description="multiple of the fundamental; none: a total, see its name")
    name: Name = Field(default="", description="of a total: TRD, THD")
    phase: Name = ""
    measured: FiniteFloat
    limit: FiniteFloat = Field(description="at most")


class Spectrum(_Frozen):
    """The components that were judged in one window of a record, each with its limit."""

    check: Name = Field(description="kind of the requirement")
    start_s: FiniteFloat
    end_s: FiniteFloat
    unit: Name = "%"
    bars: tuple[SpectrumBar, ...] = Field(min_length=1)


class Characteristic(_Frozen):
    """What one quantity must be at the values of another: above ``lower``, below ``upper``, straight lines between."""

    check: Name = Field(description="kind of the requirement")
    over: Name = Field(description="quantity that the limit depends on, named as the quantity of a band")
    quantity: Name = Field(description="quantity that is limited")
    name: Name = Field(description="in the legend")
    x: Line = Field(min_length=2, description="values of the former")
    lower: Line
    upper: Line

    @model_validator(mode="after")
    def _of_one_length(self) -> Self:
        if not len(self.x) == len(self.lower) == len(self.upper):
            raise ValueError("lower and upper need as many points as x")
        return self


class Instant(_Frozen):
    """When something that a time is demanded of has come, seen on the curve of a quantity."""

    check: Name = Field(description="kind of the requirement")
    quantity: Name = Field(description="named as that of a band")
    name: Name = Field(description="in the legend")
    at_s: FiniteFloat = Field(description="from the start of the record")
    took_s: FiniteFloat
    limit_s: FiniteFloat = Field(description="at most")


Drawn = Band | Spectrum | Characteristic | Instant
"""All that a figure draws of a requirement."""
