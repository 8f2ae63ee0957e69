"""What an inverter must do, by kind. How it is tested stands in `procedure`."""

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
    ActivePowerSupport,
    ConstantPower,
    Consumption,
    Oscillation,
    OverfrequencyPower,
    ReturnToPrefault,
)
from pvlvrt_compliance.profile.requirements.quality import DcInjection, DcRipple, Harmonics
from pvlvrt_compliance.profile.requirements.table import (
    BUILT_IN,
    Kinds,
    Requirements,
    kinds_of,
    requirements_of,
    unfilled,
)

__all__ = [
    "BUILT_IN",
    "ActivePowerRecovery",
    "ActivePowerSupport",
    "ConstantPower",
    "Consumption",
    "CurrentLimit",
    "CustomRequirement",
    "DcInjection",
    "DcRipple",
    "FrequencyRideThrough",
    "Harmonics",
    "Kinds",
    "Oscillation",
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
    "kinds_of",
    "requirements_of",
    "unfilled",
]
