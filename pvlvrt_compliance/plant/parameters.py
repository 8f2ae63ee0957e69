"""Parameters of the power subsystem and its relays, in words with units; `simulation.parameters` joins all."""

from itertools import pairwise
from typing import Annotated, Self

from pydantic import Field, FiniteFloat, model_validator

from pvlvrt_compliance.parameter_group import ParameterGroup

_CurveTime = Annotated[FiniteFloat, Field(ge=0, le=3600)]
_CurveLevel = Annotated[FiniteFloat, Field(ge=0, le=10)]


class PlantParameters(ParameterGroup):
    """The power subsystem (Tables 1 and 2)."""

    apparent_power_kva: FiniteFloat = Field(default=500.0, ge=0.1, le=1e6)
    phase_voltage_v: FiniteFloat = Field(default=230.0, ge=1, le=1e5)
    dc_link_capacitance_f: FiniteFloat = Field(default=0.065, ge=1e-6, le=1e3)
    filter_inductance_h: FiniteFloat = Field(default=0.15e-3, ge=1e-7, le=1)
    filter_resistance_ohm: FiniteFloat = Field(default=1e-3, ge=0, le=100)
    dead_time_us: Annotated[FiniteFloat, Field(ge=0, le=10)] = Field(
        default=0.5, description="of the switched inverter; usual for SiC, not in the paper"
    )
    device_drop_v: FiniteFloat = Field(
        ge=0,
        le=100,
        default=0.22,
        description="of the switched inverter: each conducting device at no current; not in the paper",
    )
    device_resistance_ohm: FiniteFloat = Field(
        ge=0, le=10, default=0.5e-3, description="of the switched inverter: each conducting device; not in the paper"
    )
    switching_energy_mj: FiniteFloat = Field(
        ge=0,
        le=1e5,
        default=24.76,
        description="of the switched inverter: a leg's turn-on and turn-off at 800 V and 1000 A. With the two above"
        " 2436 W at nominal, the paper's figure; its shares are not in the paper",
    )
    modules_in_series: int = Field(default=22, ge=1, le=1000)
    strings_in_parallel: int = Field(default=72, ge=1, le=100_000)
    breaker_opening_s: FiniteFloat = Field(
        ge=0,
        le=60,
        default=0.05,
        description="a tripped breaker parts once the current has ended, at the latest after this",
    )


_WHOSE = "none: with the bundled controller; with one of your own where another setting of this relay is given"


class ProtectionParameters(ParameterGroup):
    """Relays of the plant. Never taken from the profile under test."""

    overcurrent_pu: FiniteFloat = Field(default=2.0, ge=0.01, le=1000)
    dc_overvoltage_v: FiniteFloat = Field(default=1100.0, ge=1, le=1e5)
    undervoltage_curve: tuple[tuple[_CurveTime, _CurveLevel], ...] = Field(
        default=((0.0, 0.0), (0.15, 0.0), (1.5, 0.85)),
        min_length=1,
        max_length=1000,
        description="points (s, pu of positive sequence)",
    )
    undervoltage_delay_s: FiniteFloat = Field(default=0.05, ge=0, le=3600)
    frequency_min_hz: FiniteFloat | None = Field(default=None, ge=1, le=1000, description="none: 5 Hz below nominal")
    frequency_max_hz: FiniteFloat | None = Field(default=None, ge=1, le=1000, description="none: 5 Hz above nominal")
    frequency_delay_s: FiniteFloat = Field(default=0.2, ge=0, le=3600)
    undervoltage_relay: bool | None = Field(default=None, description=_WHOSE)
    frequency_relay: bool | None = Field(default=None, description=_WHOSE)

    def of_a_plant_alone(self) -> Self:
        """The same where a controller has its own protection: a relay that is not spoken of watches no grid.

        Over-current and DC over-voltage protect the plant itself, whoever controls it.
        """
        spoken_of = {name.partition("_")[0] for name in self.model_fields_set}
        relays = {"undervoltage_relay": self.undervoltage_relay, "frequency_relay": self.frequency_relay}
        said = {name: name.partition("_")[0] in spoken_of if value is None else value for name, value in relays.items()}
        return self.model_copy(update=said)

    @model_validator(mode="after")
    def _times_increase(self) -> Self:
        times = [t for t, _ in self.undervoltage_curve]
        if any(b <= a for a, b in pairwise(times)):
            raise ValueError("the times of undervoltage_curve must increase")
        return self
