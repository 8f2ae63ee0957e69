"""What can happen to the grid and the array besides the sag of the test. Times count from the start of that sag."""

from collections.abc import Callable, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, FiniteFloat, PrivateAttr, model_validator

from pvlvrt_compliance.scenario.grid import ResistanceRatio, ShortCircuitRatio
from pvlvrt_compliance.scenario.recordings import Named
from pvlvrt_compliance.scenario.sag import Sag

MOST_INSTANTS = 20_000
"""Events and points of voltage profiles in a run, together: chosen, four times the longest list that was tried; each is
a stretch that is judged and told."""

MOST_PROFILES = 16
"""Voltage profiles under way at one time: chosen, for a voltage that is the product of more ramps is nobody's."""

_BAND_HZ = (40.0, 70.0)

LONGEST_S = 3600.0
"""What happens in one run may last so long (s): twice the longest test that a code has."""

SHORTEST_S = 1e-6
"""The same, at least: shorter than any sample."""

Duration = Annotated[FiniteFloat, Field(ge=SHORTEST_S, le=LONGEST_S)]
Time = Annotated[FiniteFloat, Field(ge=-60, le=LONGEST_S)]
Level = Annotated[FiniteFloat, Field(ge=0, le=2)]


def _one_line(name: str) -> str:
    """A name that a message can have: one with lines of its own would pass for further messages."""
    if not name.isprintable():
        raise ValueError("a file's name must not have control characters or line breaks")
    return name


class _Event(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class FurtherSag(_Event):
    """Another sag; of sags that overlap, the one that began last holds (beginning together: the last listed)."""

    kind: Literal["sag"] = "sag"
    t_s: Time
    duration_s: Duration
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
    to_hz: Annotated[FiniteFloat, Field(ge=_BAND_HZ[0], le=_BAND_HZ[1])]


class FrequencyRamp(_Event):
    """Ramp of the grid frequency, from where it is; the next ramp or step ends it."""

    kind: Literal["frequency_ramp"] = "frequency_ramp"
    t_s: Time
    rate_hz_s: Annotated[FiniteFloat, Field(ge=-100, le=100)]
    duration_s: Duration

    @model_validator(mode="after")
    def _within_the_band(self) -> Self:
        moved_hz = abs(self.rate_hz_s) * self.duration_s
        if moved_hz > _BAND_HZ[1] - _BAND_HZ[0]:
            low, high = _BAND_HZ
            raise ValueError(f"duration_s: the ramp moves by {moved_hz:g} Hz; from {low:g} to {high:g} Hz are allowed")
        return self


class GridStrength(_Event):
    """Change of the short-circuit ratio, for instance when a line is lost as the fault clears."""

    kind: Literal["grid_strength"] = "grid_strength"
    t_s: Time
    scr: ShortCircuitRatio | None = Field(description="none: stiff")
    xr: ResistanceRatio = 10.0


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
    duration_s: Duration | None = Field(default=None, description="none: to the end")

    @property
    def natural_sequence(self) -> str:
        """The sequence given, or that of a distortion which is the same in all phases."""
        return self.sequence or ("zero", "positive", "negative")[self.order % 3]


class Irradiance(_Event):
    """Change of the irradiance, in a step or along a ramp; the next change ends it."""

    kind: Literal["irradiance"] = "irradiance"
    t_s: Time
    to_w_m2: Annotated[FiniteFloat, Field(ge=0, le=1500)]
    ramp_s: Annotated[FiniteFloat, Field(ge=0, le=3600)] = 0.0


class Recording(_Event):
    """A recorded voltage that takes the source's place from an instant on, for as long as it lasts.

    A CSV file with a column ``t_s``, or a COMTRADE file (``.cfg``, ``.cff``). One that is named in Python, not by a
    file, is any file, and a path counts from the working directory.
    """

    kind: Literal["recording"] = "recording"
    file: Annotated[str, AfterValidator(_one_line)] = Field(
        min_length=1, description="from the folder of the file that names it, in it or below"
    )
    t_s: Time
    channels: tuple[str, str, str] = ("u_a_v", "u_b_v", "u_c_v")
    scale: Annotated[FiniteFloat, Field(ge=-1e6, le=1e6)] = Field(default=1.0, description="to phase to neutral (V)")

    _named: Named | None = PrivateAttr(default=None)

    @property
    def named(self) -> Named | None:
        """Which file names it; None: none does."""
        return self._named

    @property
    def given_scale(self) -> float | None:
        """The scale where it is given: what is per unit needs one."""
        return self.scale if "scale" in self.model_fields_set else None

    def located(self) -> tuple[Path, Path | None]:
        """Its file, and the folder that this must lie in or below.

        Raises
        ------
        UsageError
            When it is named by a file, and leads out of the folders that it may lie in.
        """
        return (Path(self.file), None) if self._named is None else self._named.find(self.file)

    def as_named(self, message: str) -> str:
        """A message that begins with the place of its file on this machine, with what names it in that place."""
        folders = self._named.folders if self._named is not None else ()
        places = [f"{folder / self.file}: " for folder in folders]
        found = next((place for place in places if message.startswith(place)), None)
        return message if found is None else f"{self.file}: {message.removeprefix(found)}"

    def moved_to(self, file: Path) -> Self:
        """The same from a file of this machine, which nobody names."""
        event = self.model_copy(update={"file": str(file)})
        event._named = None
        return event

    def named_by(self, named: Named) -> Self:
        """The same, named by a file."""
        event = self.model_copy()
        event._named = named
        return event


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


def _bounded(events: tuple[Event, ...]) -> tuple[Event, ...]:
    """Refuse more than can be made of events in the time that anybody waits."""
    profiles = [event for event in events if isinstance(event, VoltageProfile)]
    instants = len(events) + sum(len(profile.points) for profile in profiles)
    if instants > MOST_INSTANTS:
        raise ValueError(f"{instants} events and points of voltage profiles; {MOST_INSTANTS} are allowed")
    under_way = 0
    for t_s, change in sorted(end for profile in profiles for end in _ends(profile)):
        under_way += change
        if under_way > MOST_PROFILES:
            raise ValueError(f"{under_way} voltage profiles are under way at {t_s:g} s; {MOST_PROFILES} are allowed")
    return events


def _ends(profile: VoltageProfile) -> tuple[tuple[float, int], tuple[float, int]]:
    """First and last point of a profile (s), the first counting up; at one time an end comes before a begin."""
    return (profile.points[0][0], 1), (profile.points[-1][0], -1)


Events = Annotated[tuple[Event, ...], AfterValidator(_bounded)]
"""All that happens besides the sag in one run."""


def recordings_named(events: Sequence[Event], folder: Path, place: Callable[[int], str]) -> tuple[Event, ...]:
    """Events of a file in a folder, their recordings named by it; ``place`` gives file, line and key of an event."""
    return tuple(
        event.named_by(Named((folder.absolute(),), place(index))) if isinstance(event, Recording) else event
        for index, event in enumerate(events)
    )
