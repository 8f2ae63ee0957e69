"""How a profile is tested: which sags, at which power, how often, and when a test counts at all."""

from typing import Annotated, Any, Literal

from pydantic import Field, ValidatorFunctionWrapHandler, WrapValidator

from pvlvrt_compliance.profile.provenance import Fraction, Frozen, Marked, NotNegative, Number, Numbers, Positive
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario

BY_ENVELOPE = "envelope"


def _duration(value: Any, handler: ValidatorFunctionWrapHandler) -> Any:
    """One problem for the whole field, where a plain union would report one for each of its members."""
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if value != BY_ENVELOPE and not (is_number and value > 0):
        raise ValueError(f'must be a time above 0 s, or "{BY_ENVELOPE}", not {value!r}')
    return handler(value)


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


class Procedure(Frozen):
    """What all tests of a profile share."""

    before_s: Positive
    after_s: Positive
    default_duration_s: Positive = Field(description="of a sag that the envelope never limits")
    irradiance_w_m2: dict[str, Number] = Field(default_factory=dict, description="by the name of the power level")
    points_on_wave_deg: Numbers | None = Field(default=None, description="one run of each test at each angle")


class TestRow(Marked):
    """A row of the test table: one sag, applied at each power level and at each point on wave.

    The mark covers the sag and a duration that is a number; a duration by the envelope carries the envelope's too.
    """

    __test__ = False  # not a test class, whatever pytest thinks of the name

    id: str = Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$")
    title: str = ""
    clause: str = Field(min_length=1)
    sag: Sag
    duration_s: Duration
    powers: tuple[str, ...] = Field(min_length=1)
    points_on_wave_deg: tuple[float, ...] | None = Field(default=None, min_length=1)


class TestCase(Frozen):
    """One run to make: an id, what happens, and where the procedure comes from."""

    __test__ = False

    id: str
    title: str
    scenario: Scenario
    clause: str = ""
    confidence: str = ""
