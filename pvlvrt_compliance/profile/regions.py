"""Regions of voltage with a mode of operation each: what codes state in place of an envelope."""

from itertools import pairwise
from typing import Annotated, Any, Literal, Self

from pydantic import Discriminator, Field, Tag, model_validator

from pvlvrt_compliance.data.marks import Fraction, Frozen, MarkedRow, MarkedTable, NotNegative
from pvlvrt_compliance.data.problems import A_NUMBER, A_TABLE
from pvlvrt_compliance.profile.curves import Side, VoltageQuantity

Mode = Literal[
    "continuous", "mandatory", "permissive", "momentary_cessation", "cease_to_energize", "may_trip", "must_trip"
]

STAY_CONNECTED = frozenset({"continuous", "mandatory", "permissive", "momentary_cessation"})
"""Modes in which the inverter must not disconnect before its time is over."""

CEASE = frozenset({"momentary_cessation", "cease_to_energize"})
"""Modes in which no current may flow after ``respond_s``."""

FOR_EVER = float("inf")


class LinearTime(Frozen):
    """A time that grows with the voltage: ``s + slope_s_per_pu (V - at_pu)``."""

    at_pu: float
    s: float = Field(gt=0)
    slope_s_per_pu: float

    def at(self, u_pu: float) -> float:
        """Time at a voltage (s)."""
        return self.s + self.slope_s_per_pu * (u_pu - self.at_pu)

    def in_words(self) -> str:
        """The time at the voltage that it is given for, and what each further per-unit of voltage adds."""
        return f"{self.s:g} s at {self.at_pu:g} pu, and {self.slope_s_per_pu:+g} s/pu from there"


def _form(value: Any) -> str:
    return A_TABLE if isinstance(value, (dict, LinearTime)) else A_NUMBER


Time = Annotated[Annotated[float, Tag(A_NUMBER)] | Annotated[LinearTime, Tag(A_TABLE)], Discriminator(_form)]


class Region(MarkedRow):
    """Voltages from the first level (included) up to the second, and what the inverter does there."""

    voltage_pu: tuple[float, float]
    mode: Mode
    ride_s: Time | None = Field(default=None, description="stay connected this long; none: for ever")
    respond_s: float | None = Field(default=None, gt=0, description="cease or trip within")

    @model_validator(mode="after")
    def _complete(self) -> Self:
        low, high = self.voltage_pu
        if not 0 <= low < high:
            raise ValueError(f"voltage_pu: must rise from 0 or above, not {low:g} to {high:g}")
        if isinstance(self.ride_s, float) and self.ride_s <= 0:
            raise ValueError(f"ride_s: must be above 0, not {self.ride_s:g}")
        if self.ride_s is None and self.mode in {"mandatory", "permissive", "momentary_cessation"}:
            raise ValueError(f"ride_s: missing; {self.mode} needs the time to stay connected")
        if self.ride_s is not None and self.mode in {"continuous", "may_trip", "must_trip", "cease_to_energize"}:
            raise ValueError(f"ride_s: {self.mode} has no time to stay connected")
        if (self.respond_s is None) == (self.mode in CEASE or self.mode == "must_trip"):
            raise ValueError(f"respond_s: {'missing' if self.respond_s is None else 'not allowed'} with {self.mode}")
        return self

    def ride_through_s(self, u_pu: float) -> float:
        """How long the inverter must stay connected at a voltage of this region (s); 0 where it may let go at once."""
        if self.mode not in STAY_CONNECTED:
            return 0.0
        if isinstance(self.ride_s, LinearTime):
            return self.ride_s.at(u_pu)
        return FOR_EVER if self.ride_s is None else self.ride_s


class RegionTable(MarkedTable):
    """Regions side by side from 0 pu on, in order of voltage; above the last the inverter may let go.

    Regions below the continuous one speak of ``low_quantity``, those above of ``high_quantity``. Mandatory operation
    goes on with ``least_current_fraction`` of the current before: of the rms of the three phases (``apparent``: the
    total apparent current), or of the phase with the most (``largest_phase``); without it, with any current.
    """

    clause: str = ""
    low_quantity: VoltageQuantity
    high_quantity: VoltageQuantity
    cumulative_window_s: float | None = Field(
        default=None, gt=0, description="times add up within this sliding window; none: each excursion counts alone"
    )
    least_current_fraction: Fraction | None = Field(
        default=None, description="of the current before the disturbance, in mandatory regions"
    )
    least_current_of: Literal["apparent", "largest_phase"] | None = Field(
        default=None, description="the current that least_current_fraction is of"
    )
    least_current_settling_s: NotNegative | None = Field(
        default=None, description="after each step, in place of what a one-cycle quantity settles in"
    )
    rows: tuple[Region, ...] = Field(min_length=1)

    @model_validator(mode="after")
    def _least_current(self) -> Self:
        if (self.least_current_fraction is None) != (self.least_current_of is None):
            raise ValueError("least_current_fraction and least_current_of go together")
        if self.least_current_settling_s is not None and self.least_current_fraction is None:
            raise ValueError("least_current_settling_s: goes with least_current_fraction only")
        if self.least_current_fraction is not None and all(row.mode != "mandatory" for row in self.rows):
            raise ValueError("least_current_fraction: needs a mandatory region")
        return self

    @model_validator(mode="after")
    def _side_by_side(self) -> Self:
        if self.rows[0].voltage_pu[0] != 0:
            raise ValueError(f"rows: the first region must begin at 0 pu, not at {self.rows[0].voltage_pu[0]:g}")
        for lower, upper in pairwise(self.rows):
            if lower.voltage_pu[1] != upper.voltage_pu[0]:
                raise ValueError(
                    f"rows: a region ends at {lower.voltage_pu[1]:g} pu, the next begins at {upper.voltage_pu[0]:g} pu"
                )
        if sum(row.mode == "continuous" for row in self.rows) != 1:
            raise ValueError("rows: exactly one region must be continuous")
        for side, quantity in ((Side.LOW, self.low_quantity), (Side.HIGH, self.high_quantity)):
            if not side.allows(quantity):
                raise ValueError(f"{side}_quantity: {quantity!r} is the wrong extreme for it")
        return self

    @property
    def continuous(self) -> Region:
        """The region of normal operation."""
        return next(row for row in self.rows if row.mode == "continuous")

    def side_of(self, row: Region) -> Side:
        """Whether a region lies below or above normal operation (itself: low)."""
        return Side.HIGH if row.voltage_pu[0] >= self.continuous.voltage_pu[1] else Side.LOW
