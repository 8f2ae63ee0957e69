"""One run of the plant: the grid, the weather, and the sag with its instants."""

import re
from collections import Counter
from collections.abc import Iterator
from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field

from pvlvrt_compliance.scenario.events import LONGEST_S, SHORTEST_S, Events
from pvlvrt_compliance.scenario.grid import ResistanceRatio, ShortCircuitRatio
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.units import nearest_nominal_frequency

FREQUENCY_MIN_HZ = 45.0
FREQUENCY_MAX_HZ = 66.0
VECTOR_GROUP = re.compile(r"^(D|Y|YN)(d|y|yn)(1[01]|[0-9])$")


def _vector_group(text: Any) -> Any:
    """Refuse what is no vector group in words that say what one is."""
    if not isinstance(text, str) or VECTOR_GROUP.match(text):
        return text
    spelled = [group for group in _spellings(text) if VECTOR_GROUP.match(group)]
    hint = f'; did you mean "{spelled[0]}"?' if spelled else ""
    raise ValueError(
        f"{text!r} is no vector group; it is D, Y or YN of the sag's side, d, y or yn of the inverter's, and the hours,"
        f" 0 to 11, that the second is behind: Dyn11 for instance{hint}"
    )


def _spellings(text: str) -> Iterator[str]:
    """A vector group in other letters: which are capitals, and what is put in between, differs among writers."""
    letters = "".join(letter for letter in text if letter.isalnum()).casefold()
    for high in ("yn", "y", "d"):
        if letters.startswith(high):
            yield high.upper() + letters.removeprefix(high)


class Scenario(BaseModel):
    """Everything outside the inverter during one run. Times count from the start of the record.

    The grid is a source behind R + jwL; without ``scr`` the source sits at the inverter's terminals.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    sag: Sag
    duration_s: float = Field(ge=SHORTEST_S, le=LONGEST_S, description="from the start of the sag to its clearing")
    point_on_wave_deg: float = Field(
        default=0.0, ge=-360, le=360, description="angle of phase a at the start; 0: maximum"
    )
    frequency_hz: float = Field(default=50.0, ge=FREQUENCY_MIN_HZ, le=FREQUENCY_MAX_HZ)
    irradiance_w_m2: float = Field(default=1000.0, ge=0, le=1500)
    cell_temperature_c: float = Field(default=25.0, ge=-40, le=90)
    scr: ShortCircuitRatio | None = Field(default=None, description="short-circuit ratio on 500 kVA; none: stiff")
    xr: ResistanceRatio = Field(default=10.0, description="X/R of the grid impedance")
    vector_group: Annotated[str, BeforeValidator(_vector_group)] | None = Field(
        default=None,
        pattern=VECTOR_GROUP.pattern,
        description="of the transformer beyond which sags happen, Dyn11 for instance; none: at the terminals",
    )
    reactive_power_pu: float = Field(default=0.0, ge=-1, le=1, description="set-point outside of sags, of 500 kVA")
    before_s: float = Field(default=0.3, ge=0.25, le=60, description="record before the sag")
    after_s: float = Field(default=1.1, ge=0.1, le=120, description="record after clearing")
    events: Events = Field(default=(), description="what happens besides; times from the start of the sag")

    def describe(self) -> str:
        """Name in a few words what happens, for tables and titles."""
        kinds = Counter(event.kind.replace("_", " ") for event in self.events)
        further = [f"{count} x {kind}" if count > 1 else kind for kind, count in kinds.items()]
        own = [self.sag.describe()] if self.sag.depth or self.sag.angle_deg or not further else []
        return ", ".join([*own, *further])

    @property
    def start_s(self) -> float:
        """Start of the sag (s)."""
        return self.before_s

    @property
    def clear_s(self) -> float:
        """Clearing of the sag (s)."""
        return self.before_s + self.duration_s

    @property
    def end_s(self) -> float:
        """End of the record (s)."""
        return self.clear_s + self.after_s

    @property
    def nominal_frequency_hz(self) -> float:
        """50 or 60 Hz."""
        return nearest_nominal_frequency(self.frequency_hz)
