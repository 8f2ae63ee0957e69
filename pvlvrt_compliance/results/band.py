"""A limit as a figure draws it, kept beside the verdict that it belongs to."""

from typing import Self

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, model_validator

from pvlvrt_compliance.texts import Name

VOLTAGE_POSITIVE, VOLTAGE_NEGATIVE, CURRENT = "voltage_positive_pu", "voltage_negative_pu", "current_pu"
ACTIVE_POWER, REACTIVE_POWER, DC_VOLTAGE = "active_power_kw", "reactive_power_kvar", "dc_voltage_v"
REACTIVE_CURRENT, REACTIVE_CURRENT_NEGATIVE = "reactive_current_pu", "reactive_current_negative_pu"
REACTIVE_SHARE, FREQUENCY = "reactive_share", "frequency_hz"

_VOLTAGE = ("voltage_", "_pu")

Line = tuple[FiniteFloat, ...]


def voltage_band(quantity: str) -> str:
    """Name that a limit of a voltage has here, by the profile's name of that voltage (`lowest_line_to_line`)."""
    return VOLTAGE_POSITIVE if quantity == "positive_sequence" else quantity.join(_VOLTAGE)


def voltage_in(band: str) -> str:
    """The profile's name of the voltage that a limit is of: the opposite of `voltage_band`."""
    name = band.removeprefix(_VOLTAGE[0]).removesuffix(_VOLTAGE[1])
    return "positive_sequence" if band == VOLTAGE_POSITIVE else name


class Band(BaseModel):
    """What a quantity must not leave over a time: above ``lower``, below ``upper``, straight lines between the points.

    ``quantity`` names what is limited, as a figure's panel does: `voltage_positive_pu`, `voltage_negative_pu`,
    `voltage_lowest_line_to_line_pu` and its like (`voltage_band`), `current_pu` (phase currents),
    `reactive_current_pu` and `reactive_current_negative_pu` (one cycle, of a sequence), `reactive_share` (of the
    positive sequence's current), `active_power_kw`, `reactive_power_kvar`, `dc_voltage_v` or `frequency_hz`.
    """

    model_config = ConfigDict(frozen=True, extra="ignore")

    check: Name = Field(description="kind of the requirement")
    quantity: Name
    name: Name = Field(description="in the legend")
    t_s: Line = Field(min_length=1, description="from the start of the record")
    lower: Line | None = None
    upper: Line | None = None
    widened: bool = Field(default=False, description="the same limit as another of its name, with the tolerance")
    about_its_line: bool = Field(
        default=False, description="limits a swing about a straight line, which lies midway between lower and upper"
    )
    half_cycle: bool = Field(default=False, description="of means over half a cycle, not over one")
    region: Name | None = Field(
        default=None, description="mode of operation while the quantity is in it; none: it must not be left"
    )

    @model_validator(mode="after")
    def _of_one_length(self) -> Self:
        if self.lower is None and self.upper is None:
            raise ValueError("a band needs lower, upper or both")
        if any(line is not None and len(line) != len(self.t_s) for line in (self.lower, self.upper)):
            raise ValueError("lower and upper need as many points as t_s")
        return self
