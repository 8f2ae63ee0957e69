"""Stay connected: through voltage, frequency and phase-angle disturbances, and when to let go."""

from typing import Self

from pydantic import Field, model_validator

from pvlvrt_compliance.data.marks import Fraction, NotNegative, Positive
from pvlvrt_compliance.profile.curves import Envelope, Side
from pvlvrt_compliance.profile.regions import RegionTable
from pvlvrt_compliance.profile.requirements.base import Requirement
from pvlvrt_compliance.profile.tables import FrequencyBands


class RideThrough(Requirement):
    """Stay connected where envelopes and regions demand it, let go where a region says so.

    Without envelope and regions the profile never lets the inverter go: it must stay connected throughout. With
    ``recovery_fraction`` the active power must also come back (by depth: active_power_recovery).
    """

    kinds = ("ride_through",)

    envelope: Envelope | None = None
    envelope_two_phase: Envelope | None = Field(default=None, description="in its place for isolated two-phase faults")
    envelope_over_voltage: Envelope | None = Field(default=None, description="stay connected at and below it")
    regions: RegionTable | None = None
    envelope_tolerance_pu: NotNegative = Field(description="a voltage this far beyond the envelope is still on it")
    recovery_fraction: Fraction | None = Field(default=None, description="of the active power before the sag")
    recovery_time_s: Positive | None = Field(default=None, description="from clearing")

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if (self.recovery_fraction is None) != (self.recovery_time_s is None):
            raise ValueError("recovery_fraction and recovery_time_s go together")
        for name, side in (
            ("envelope", Side.LOW),
            ("envelope_two_phase", Side.LOW),
            ("envelope_over_voltage", Side.HIGH),
        ):
            envelope: Envelope | None = getattr(self, name)
            if envelope is not None and not side.allows(envelope.voltage_quantity):
                raise ValueError(f"{name}.voltage_quantity: {envelope.voltage_quantity!r} is the wrong extreme for it")
        return self


class RepeatedRuns(Requirement):
    """How many runs of a test must be ridden through one after the other."""

    kinds = ("repeated_runs",)

    consecutive: Positive = Field(description="runs of a row that are ridden through one after the other")
    consecutive_after_trip: Positive | None = Field(
        default=None, description="further runs that must all be ridden through when one tripped; none: it has failed"
    )


class FrequencyRideThrough(Requirement):
    """Stay connected through frequencies and rates of change of frequency.

    A band without ``ride_s`` is continuous; outside of all bands the profile lets the inverter go.
    """

    kinds = ("frequency_ride_through",)

    bands: FrequencyBands
    rocof_hz_s: Positive | None = Field(default=None, description="largest rate to be ridden through")
    rocof_window_s: Positive | None = Field(default=None, description="sliding window that the rate is taken over")

    @model_validator(mode="after")
    def _rate_with_window(self) -> Self:
        if (self.rocof_hz_s is None) != (self.rocof_window_s is None):
            raise ValueError("rocof_hz_s and rocof_window_s go together")
        return self


class PhaseJumpRideThrough(Requirement):
    """Stay connected through a jump of the voltage's angle, and be back at the power before."""

    kinds = ("phase_jump_ride_through",)

    all_phases_deg: Positive = Field(description="largest jump of the positive-sequence angle")
    single_phase_deg: Positive | None = Field(default=None, description="largest jump of one phase")
    recovery_fraction: Fraction = Field(description="of the active power before the jump")
    recovery_time_s: Positive = Field(description="from the last jump")
