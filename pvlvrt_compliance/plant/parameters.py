"""Parameters of the power subsystem and its relays, in words with units; `simulation.parameters` joins all."""

from itertools import pairwise
from typing import Annotated, Self

from pydantic import Field, FiniteFloat, model_validator

from pvlvrt_compliance.parameter_group import NotNegative, ParameterGroup, Positive


class PlantParameters(ParameterGroup):
    """The power subsystem (Tables 1 and 2)."""

    apparent_power_kva: Positive = 500.0
    phase_voltage_v: Positive = 230.0
    dc_link_capacitance_f: Positive = 0.065
    filter_inductance_h: Positive = 0.15e-3
    filter_resistance_ohm: NotNegative = 1e-3
    dead_time_us: Annotated[FiniteFloat, Field(ge=0, le=10)] = Field(
        default=0.5, description="of the switched inverter; usual for SiC, not in the paper"
    )
    device_drop_v: NotNegative = Field(
        default=0.22, description="of the switched inverter: each conducting device at no current; not in the paper"
    )
    device_resistance_ohm: NotNegative = Field(
        default=0.5e-3, description="of the switched inverter: each conducting device; not in the paper"
    )
    switching_energy_mj: NotNegative = Field(
        default=24.76,
        description="of the switched inverter: a leg's turn-on and turn-off at 800 V and 1000 A. With the two above"
        " 2436 W at nominal, the paper's figure; its shares are not in the paper",
    )
    modules_in_series: int = Field(default=22, ge=1, le=1000)
    strings_in_parallel: int = Field(default=72, ge=1, le=100000)
    breaker_opening_s: NotNegative = Field(
        default=0.05, description="a tripped breaker parts once the current has ended, at the latest after this"
    )


class ProtectionParameters(ParameterGroup):
    """Relays of the plant. Never taken from the profile under test."""

    overcurrent_pu: Positive = 2.0
    dc_overvoltage_v: Positive = 1100.0
    undervoltage_curve: tuple[tuple[NotNegative, NotNegative], ...] = Field(
        default=((0.0, 0.0), (0.15, 0.0), (1.5, 0.85)), min_length=1, description="points (s, pu of positive sequence)"
    )
    undervoltage_delay_s: NotNegative = 0.05
    frequency_min_hz: Positive | None = Field(default=None, description="none: 5 Hz below nominal")
    frequency_max_hz: Positive | None = Field(default=None, description="none: 5 Hz above nominal")
    frequency_delay_s: NotNegative = 0.2

    @model_validator(mode="after")
    def _times_increase(self) -> Self:
        times = [t for t, _ in self.undervoltage_curve]
        if any(b <= a for a, b in pairwise(times)):
            raise ValueError("the times of undervoltage_curve must increase")
        return self
