"""What an inverter must do. How it is tested stands in `procedure`."""

from collections.abc import Iterator
from typing import Any

from pydantic import Field

from pvlvrt_compliance.profile.curves import Envelope, SupportCurve
from pvlvrt_compliance.profile.provenance import (
    Flag,
    Fraction,
    Frozen,
    NotNegative,
    Number,
    Positive,
    marks_in,
    weakest,
)


class Requirement(Frozen):
    """Base of all requirements: where the demand is written."""

    clause: str = Field(min_length=1)
    source: str = Field(min_length=1)

    @property
    def confidence(self) -> str:
        """The weakest mark of its numbers."""
        return weakest(item.confidence for _, item in marks_in(self))


class RideThrough(Requirement):
    """Stay connected where the envelope demands it, and bring the active power back.

    Without an envelope the profile never lets the inverter go: it must stay connected throughout.
    """

    envelope: Envelope | None = None
    envelope_tolerance_pu: NotNegative = Field(description="a voltage this far below the envelope is still on it")
    recovery_fraction: Fraction = Field(description="of the active power before the sag")
    recovery_time_s: Positive = Field(description="from clearing")


class CurrentLimit(Requirement):
    """Fundamental phase currents, once settled, and the instantaneous peak, always."""

    limit_pu: Positive
    tolerance_pu: NotNegative
    settling_s: NotNegative = Field(description="after the start and after clearing")
    peak_pu: Positive

    @property
    def allowed_pu(self) -> float:
        """Largest fundamental amplitude that passes (pu)."""
        return self.limit_pu.value + self.tolerance_pu.value


class ReactiveSupport(Requirement):
    """Mean reactive power during a sag against a curve over the voltage."""

    curve: SupportCurve
    clip_to_capability: Flag = Field(description="demand at most (V+ - V-) S")
    no_support_from_pu: Positive = Field(description="V+ at and above which no reactive power is wanted")
    tolerance_pu: NotNegative = Field(description="times V+ S")


class DcRipple(Requirement):
    """Double-frequency ripple of the DC voltage."""

    limit_percent: Positive


class CustomRequirement(Requirement):
    """A requirement whose check comes from another package (entry-point group ``pvlvrt_compliance.checks``)."""

    numbers: dict[str, Number] = Field(default_factory=dict)


class Requirements(Frozen):
    """The demands of a profile by kind; a kind that is left out is not judged."""

    ride_through: RideThrough | None = None
    current_limit: CurrentLimit | None = None
    reactive_support: ReactiveSupport | None = None
    dc_ripple: DcRipple | None = None
    custom: dict[str, CustomRequirement] = Field(default_factory=dict)

    def by_kind(self) -> Iterator[tuple[str, Any]]:
        """Each demand that the profile makes, with its kind."""
        for kind in type(self).model_fields:
            if kind != "custom" and (requirement := getattr(self, kind)) is not None:
                yield kind, requirement
        yield from self.custom.items()
