"""How a profile is tested: which sags, at which power, how often, and when a test counts at all."""

import math
from typing import Annotated, Any, Literal, Self

from pydantic import Field, ValidatorFunctionWrapHandler, WrapValidator, model_validator

from pvlvrt_compliance.data.marks import CONFIDENCES, Fraction, Frozen, Marked, NotNegative, Number, Numbers, Positive
from pvlvrt_compliance.profile.ids import ID_PATTERN
from pvlvrt_compliance.profile.sequences import CornerTests, StepTable
from pvlvrt_compliance.scenario.events import Events
from pvlvrt_compliance.scenario.grid import ResistanceRatio, ShortCircuitRatio
from pvlvrt_compliance.scenario.sag import PhaseNames, Sag
from pvlvrt_compliance.scenario.scenario import Scenario

BY_ENVELOPE = "envelope"


def _duration(value: Any, handler: ValidatorFunctionWrapHandler) -> Any:
    """One problem for the whole field, where a plain union would report one for each of its members."""
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if value != BY_ENVELOPE and not (is_number and 0 < value < math.inf):
        raise ValueError(f'must be a time above 0 s, or "{BY_ENVELOPE}", not {value!r}')
    return handler(value)


Expect = Literal["ride_through", "may_trip", "must_trip"]
"""What a row of a test table demands: ride through all of it, or let go when the limits allow it, or let go in time."""

Duration = Annotated[float | Literal["envelope"], WrapValidator(_duration)]


class Conditions(Frozen):
    """When a test counts; outside of these its requirements are not evaluated."""

    starting_power_fraction: Fraction = Field(description="distance from min(available, rated), as a fraction of it")
    no_load_tolerance_pu: NotNegative = Field(description="of V+ and V- without the inverter's current")
    blocked_below_pu: Positive = Field(description="a bridge whose phase currents all stay below this is blocked")


class Windows(Frozen):
    """Where a record is measured, before, during and after a sag; always in whole cycles."""

    before_start_s: Positive = Field(description="before the start")
    before_end_s: NotNegative = Field(description="before the start")
    during_start_s: NotNegative = Field(description="after the start")
    during_end_s: NotNegative = Field(description="before clearing")
    after_length_s: Positive = Field(description="the last stretch of the record")
    after_clearing_s: NotNegative = Field(description="shortest record past clearing that has such a stretch")


class Detection(Frozen):
    """Thresholds on V+ between which a voltage event lasts; without those of a swell, swells are not looked for."""

    enter_below_pu: Positive
    leave_above_pu: Positive
    enter_above_pu: Positive | None = None
    leave_below_pu: Positive | None = None

    @model_validator(mode="after")
    def _hysteresis(self) -> Self:
        if self.leave_above_pu.value < self.enter_below_pu.value:
            raise ValueError("leave_above_pu: must not be below enter_below_pu")
        if (self.enter_above_pu is None) != (self.leave_below_pu is None):
            raise ValueError("enter_above_pu and leave_below_pu go together")
        if self.enter_above_pu and self.leave_below_pu and self.leave_below_pu.value > self.enter_above_pu.value:
            raise ValueError("leave_below_pu: must not be above enter_above_pu")
        return self

    def is_event(self, v_positive_pu: Any) -> Any:
        """Whether a sag or a swell begins at a V+ (pu): of a number, or of each in an array."""
        low = v_positive_pu < self.enter_below_pu.value
        return low if self.enter_above_pu is None else low | (v_positive_pu > self.enter_above_pu.value)


class Procedure(Frozen):
    """What all tests of a profile share."""

    frequency_hz: Positive | None = Field(default=None, description="nominal frequency of the grid; none: 50 Hz")
    before_s: Positive
    after_s: Positive
    default_duration_s: Positive = Field(description="of a sag that the envelope never limits")
    irradiance_w_m2: dict[str, Number] = Field(default_factory=dict, description="by the name of the power level")
    points_on_wave_deg: Numbers | None = Field(default=None, description="one run of each test at each angle")
    steps: dict[str, StepTable] = Field(
        default_factory=dict, description="named voltage steps, by the name of the table"
    )
    corners: CornerTests | None = Field(default=None, description="tests made from the regions")


class Grid(Frozen):
    """The grid of one test."""

    scr: ShortCircuitRatio = Field(description="short-circuit ratio")
    xr: ResistanceRatio = 10.0


class StepSequence(Frozen):
    """Named steps one after the other."""

    table: str = Field(description="one of procedure.steps")
    order: str = Field(min_length=1, max_length=1000, description="letters of the steps, each with its primes: ABCD'F")
    phases: PhaseNames = Field(default="abc", description="that the steps are of; those of some phases go up to 1 pu")


class TestRow(Marked):
    """A row of the test table: one sag or sequence, applied at each power level and at each point on wave.

    The mark covers the sag and a duration that is a number; a duration by the envelope carries the envelope's too.
    """

    __test__ = False  # not a test class, whatever pytest thinks of the name

    id: str = Field(pattern=ID_PATTERN)
    title: str = ""
    clause: str = Field(min_length=1)
    sag: Sag = Field(default=Sag(depth=0), description="without it, only the events happen")
    duration_s: Duration | None = Field(default=None, description="of the sag; of steps, what they last")
    steps: StepSequence | None = None
    events: Events = Field(default=(), description="what happens besides; times from the start of the sag")
    grid: Grid | None = Field(default=None, description="none: stiff")
    vector_group: str | None = None
    powers: tuple[str, ...] = Field(min_length=1)
    points_on_wave_deg: tuple[float, ...] | None = Field(default=None, min_length=1)
    frequency_hz: float | None = Field(default=None, gt=0, description="in place of the procedure's")
    reactive_power_pu: float = Field(default=0.0, ge=-1, le=1, description="set-point before and after the sag")
    k_factor: float | None = Field(default=None, gt=0, description="in place of the requirement's K")
    before_s: float | None = Field(default=None, gt=0, description="in place of the procedure's")
    after_s: float | None = Field(default=None, gt=0, description="in place of the procedure's")
    checks: tuple[str, ...] | None = Field(default=None, min_length=1, description="kinds judged; none: all")
    long: bool = Field(default=False, description="runs on request only (--include-long)")
    expect: Expect = Field(
        default="ride_through",
        description="ride_through: all of it; may_trip: as long as its voltage demands; must_trip: also open by_s",
    )
    by_s: float | None = Field(default=None, gt=0, description="from the start, for must_trip")

    @model_validator(mode="after")
    def _lasts(self) -> Self:
        if (self.duration_s is None) == (self.steps is None):
            raise ValueError(f"duration_s: {'missing' if self.steps is None else 'steps last as long as they say'}")
        if self.steps is not None and self.sag.depth > 0:
            raise ValueError("steps: a test has a sag or steps, not both")
        if (self.by_s is None) == (self.expect == "must_trip"):
            raise ValueError(f"by_s: {'missing' if self.by_s is None else 'goes with expect = must_trip only'}")
        return self


class RowDemand(Marked):
    """Where the demand of a row of the test table comes from, as a verdict on it says."""

    clause: str


class TestCase(Frozen):
    """One run to make: an id, what happens, and where the procedure comes from."""

    __test__ = False

    id: str
    title: str
    scenario: Scenario
    clause: str = ""
    confidence: str = ""
    row: str = Field(default="", description="id of the row that it is a run of")
    k_factor: float | None = None
    checks: tuple[str, ...] | None = None
    only: tuple[str, ...] | None = Field(
        default=None, description="kinds that are judged of those, where somebody asks for some of them only"
    )
    long: bool = False
    expect: Expect | None = Field(default=None, description="of a row; none: a sag of the user's own")
    by_s: float | None = None

    @property
    def demand(self) -> RowDemand | None:
        """Clause and mark of what its row demands, None of a sag of the user's own."""
        mark = next((mark for mark in CONFIDENCES if mark == self.confidence), None)
        if self.expect is None or mark is None:
            return None
        return RowDemand(clause=self.clause, confidence=mark, source=f"the row of the test table of {self.id}")

    def judges(self, kind: str) -> bool:
        """Whether the test is judged by a kind of requirement."""
        return self.has(kind) and (self.only is None or kind in self.only)

    def has(self, kind: str) -> bool:
        """Whether a kind of requirement judges the test when all are asked for."""
        return self.checks is None or kind in self.checks
