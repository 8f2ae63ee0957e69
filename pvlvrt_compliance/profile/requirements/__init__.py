"""What an inverter must do, by kind. How it is tested stands in `procedure`."""

from collections.abc import Iterator
from typing import Any

from pydantic import Field

from pvlvrt_compliance.profile.provenance import Frozen
from pvlvrt_compliance.profile.requirements.base import CustomRequirement, Requirement
from pvlvrt_compliance.profile.requirements.connection import (
    FrequencyRideThrough,
    PhaseJumpRideThrough,
    RepeatedRuns,
    RideThrough,
)
from pvlvrt_compliance.profile.requirements.current import (
    CurrentLimit,
    ReactiveCurrent,
    ReactiveRatio,
    ReactiveSupport,
    SupportDynamics,
    Toggling,
)
from pvlvrt_compliance.profile.requirements.power import (
    ActivePowerRecovery,
    ConstantPower,
    Consumption,
    OverfrequencyPower,
    ReturnToPrefault,
)
from pvlvrt_compliance.profile.requirements.quality import DcInjection, DcRipple, Harmonics

__all__ = [
    "ActivePowerRecovery",
    "ConstantPower",
    "Consumption",
    "CurrentLimit",
    "CustomRequirement",
    "DcInjection",
    "DcRipple",
    "FrequencyRideThrough",
    "Harmonics",
    "OverfrequencyPower",
    "PhaseJumpRideThrough",
    "ReactiveCurrent",
    "ReactiveRatio",
    "ReactiveSupport",
    "RepeatedRuns",
    "Requirement",
    "Requirements",
    "ReturnToPrefault",
    "RideThrough",
    "SupportDynamics",
    "Toggling",
]


class Requirements(Frozen):
    """The demands of a profile by kind, in the order of a report; a kind that is left out is not judged."""

    ride_through: RideThrough | None = None
    repeated_runs: RepeatedRuns | None = None
    frequency_ride_through: FrequencyRideThrough | None = None
    phase_jump_ride_through: PhaseJumpRideThrough | None = None
    current_limit: CurrentLimit | None = None
    reactive_support: ReactiveSupport | None = None
    reactive_current: ReactiveCurrent | None = None
    negative_sequence_current: ReactiveCurrent | None = None
    support_dynamics: SupportDynamics | None = None
    reactive_ratio: ReactiveRatio | None = None
    toggling: Toggling | None = None
    active_power_recovery: ActivePowerRecovery | None = None
    consumption: Consumption | None = None
    constant_power: ConstantPower | None = None
    return_to_prefault: ReturnToPrefault | None = None
    overfrequency_power: OverfrequencyPower | None = None
    dc_ripple: DcRipple | None = None
    harmonics: Harmonics | None = None
    dc_injection: DcInjection | None = None
    custom: dict[str, CustomRequirement] = Field(default_factory=dict)

    def by_kind(self) -> Iterator[tuple[str, Any]]:
        """Each demand that the profile makes, with its kind."""
        for kind in type(self).model_fields:
            if kind != "custom" and (requirement := getattr(self, kind)) is not None:
                yield kind, requirement
        yield from self.custom.items()
