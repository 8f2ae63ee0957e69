"""What can happen to the grid and the array besides the sag of the test. Times count from the start of that sag."""

from itertools import pairwise
from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, model_validator

from pvlvrt_compliance.scenario.sag import Sag

Positive = Annotated[FiniteFloat, Field(gt=0)]
Time = Annotated[FiniteFloat, Field(ge=-60, le=3600)]
Level = Annotated[FiniteFloat, Field(ge=0, le=2)]


class _Event(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class FurtherSag(_Event):
    """Another sag; of sags that overlap, the one that began last holds (beginning together: the last listed)."""

    kind: Literal["sag"] = "sag"
    t_s: Time
    duration_s: Positive
    sag: Sag


class VoltageProfile(_Event):
    """Factor on all phase voltages: straight lines between points, the last level held. Ramps, steps and swells."""

    kind: Literal["voltage_profile"] = "voltage_profile"
    points: tuple[tuple[Time, Level], ...] = Field(min_length=1, description="(s, pu); a step: two at one time")

    @model_validator(mode="after")
    def _in_order(self) -> Self:
        if any(b < a for (a, _), (b, _) in pairwise(self.points)):
            raise ValueError("the times of a voltage profile must not decrease")
        return self


class PhaseJump(_Event):
    """Jump of the angle of all phase voltages; positive is ahead."""

    kind: Literal["phase_jump"] = "phase_jump"
    t_s: Time
    angle_deg: Annotated[FiniteFloat, Field(ge=-180, le=180)]


class FrequencyStep(_Event):
    """Step of the grid frequency."""

    kind: Literal["frequency_step"] = "frequency_step"
    t_s: Time
    to_hz: Annotated[FiniteFloat, Field(ge=40, le=70)]


class FrequencyRamp(_Event):
    """Ramp of the grid frequency, from where it is."""

    kind: Literal["frequency_ramp"] = "frequency_ramp"
    t_s: Time
    rate_hz_s: Annotated[FiniteFloat, Field(ge=-100, le=100)]
    duration_s: Positive


class GridStrength(_Event):
    """Change of the short-circuit ratio, for instance when a line is lost as the fault clears."""

    kind: Literal["grid_strength"] = "grid_strength"
    t_s: Time
    scr: Annotated[FiniteFloat, Field(gt=0.5)] | None = Field(description="none: stiff")
    xr: Positive = 10.0


class Harmonic(_Event):
    """Harmonic of the source, in pu of the nominal fundamental.

    In phase a it is ``amplitude_pu cos(order theta + phase_deg)``, theta being the angle of the fundamental there; the
    other phases follow from its sequence. Without one, 5, 11, 17 ... are negative, 7, 13 ... positive, 3, 9 ... zero.
    """

    kind: Literal["harmonic"] = "harmonic"
    order: int = Field(ge=2, le=50)
    amplitude_pu: Annotated[FiniteFloat, Field(ge=0, le=1)]
    phase_deg: Annotated[FiniteFloat, Field(ge=-360, le=360)] = 0.0
    sequence: Literal["positive", "negative", "zero"] | None = None
    t_s: Time | None = Field(default=None, description="none: from the beginning")
    duration_s: Positive | None = Field(default=None, description="none: to the end")

    @property
    def natural_sequence(self) -> str:
        """The sequence given, or that of a distortion which is the same in all phases."""
        return self.sequence or ("zero", "positive", "negative")[self.order % 3]


class Irradiance(_Event):
    """Change of the irradiance, in a step or along a ramp."""

    kind: Literal["irradiance"] = "irradiance"
    t_s: Time
    to_w_m2: Annotated[FiniteFloat, Field(ge=0, le=1500)]
    ramp_s: Annotated[FiniteFloat, Field(ge=0, le=3600)] = 0.0


class Recording(_Event):
    """A recorded voltage that takes the source's place from an instant on, for as long as it lasts.

    A CSV file with a column ``t_s``, or a COMTRADE file (``.cfg``).
    """

    kind: Literal["recording"] = "recording"
    file: str = Field(min_length=1)
    t_s: Time
    channels: tuple[str, str, str] = ("u_a_v", "u_b_v", "u_c_v")
    scale: Annotated[FiniteFloat, Field(ge=-1e6, le=1e6)] = Field(default=1.0, description="to phase to neutral (V)")


Event = Annotated[
    FurtherSag
    | VoltageProfile
    | PhaseJump
    | FrequencyStep
    | FrequencyRamp
    | GridStrength
    | Harmonic
    | Irradiance
    | Recording,
    Field(discriminator="kind"),
]
