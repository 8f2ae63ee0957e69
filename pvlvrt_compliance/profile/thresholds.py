"""Floors and thresholds of measurement and judging that codes leave open, as numbers with marks."""

from collections.abc import Callable
from typing import Annotated, Any, Self

from pydantic import AfterValidator, model_validator

from pvlvrt_compliance.data.marks import CHOSEN, Frozen, NotNegative, Number, Positive


def _at_most(most: float) -> Callable[[Number], Number]:
    """A threshold beyond this would leave nothing to judge."""

    def checked(number: Number) -> Number:
        if number.value > most:
            raise ValueError(f"must be at most {most:g}, not {number.value:g}")
        return number

    return checked


Cycles = Annotated[NotNegative, AfterValidator(_at_most(20))]
Floor = Annotated[Positive, AfterValidator(_at_most(0.2))]
HertzOrDegrees = Annotated[NotNegative, AfterValidator(_at_most(5))]
Seconds = Annotated[NotNegative, AfterValidator(_at_most(1))]


def _chosen(value: float, source: str) -> Any:
    return Number(value=value, confidence=CHOSEN, source=source)


class Thresholds(Frozen):
    """What decides whether something is judged, and how exactly; a profile may state its own."""

    normal_low_pu: Positive = _chosen(0.9, "lowest voltage of normal operation in every code at hand, or nearly")
    normal_high_pu: Positive = _chosen(1.1, "highest voltage of normal operation in every code at hand, or nearly")
    normal_negative_pu: NotNegative = _chosen(0.1, "as far from balanced as the lowest normal voltage is from nominal")
    settled_cycles: Cycles = _chosen(1.1, "a one-cycle voltage shows a step within a cycle, and a sample or two")
    voltage_floor_pu: Floor = _chosen(0.003, "below it noise of a sensor turns the angle that current is split by")
    least_sequence_pu: Floor = _chosen(0.01, "twice the error of 0.5 % that test equipment is allowed")
    least_difference_pu: Floor = _chosen(
        0.10, "V+ - V- without the inverter's current, below which eq (8) of the paper leaves hardly any: 0.1 S at most"
    )
    least_source_pu: Floor = _chosen(0.05, "noise of 0.5 % a sample at 24 kHz turns it as 0.07 Hz would")
    frequency_settled_cycles: Cycles = _chosen(
        4.1,
        "what a frequency rests on and settles in: a step into the worst isolated two-phase fault leaves 0.17 Hz after"
        " two cycles, when all windows lie behind it, and 3 mHz after these",
    )
    terminals_settled_cycles: Cycles = _chosen(
        5.0,
        "from a voltage that is normal again until the current behind it has settled: then the angle of the terminals"
        " is the grid's but for a constant (a short-circuit ratio of 2 leaves under 0.1 Hz)",
    )
    frequency_deviation_hz: HertzOrDegrees = _chosen(
        0.2, "first thresholds of a power that follows the frequency are 50.2 Hz and 49.8 Hz (NTS 631)"
    )
    frequency_accuracy_hz: HertzOrDegrees = _chosen(0.010, "accuracy that NTS 631 v2.0 demands of the measurement")
    angle_accuracy_deg: HertzOrDegrees = _chosen(0.1, "how well a jump is known from one-cycle phasors")
    least_fundamental_fraction: Floor = _chosen(1e-3, "of the rated current, below which no distortion is stated")
    window_voltage_floor_pu: Floor = _chosen(0.005, "V+ of a window below which no frequency of it is stated")
    other_frequency_hz: HertzOrDegrees = _chosen(
        0.05, "a window further than this from the frequency before the disturbance is measured at its own"
    )
    record_slack_s: Seconds = _chosen(0.01, "by how much a record may end early: a sampling step, a coarse one too")

    normal_jump_deg: HertzOrDegrees = _chosen(5.0, "a quarter of the smallest jump that a code names")
    normal_jump_s: Seconds = _chosen(0.2, "ten cycles at 50 Hz: what a jump does to a control is over by then")
    voltage_tolerance_pu: Floor = _chosen(0.001, "rounding of a measured voltage: on a limit by less is on it")
    response_band: Annotated[Positive, AfterValidator(_at_most(0.5))] = _chosen(
        0.10, "of the change, on both sides of the final value: the band begins where 90 % of the change is reached"
    )
    response_least_pu: Floor = _chosen(
        0.05, "least change that is timed: a tenth of it is 0.005 pu, what measurement leaves open of current and power"
    )
    no_power_pu: Floor = _chosen(
        0.02, "of rated power: with less than this before, no share of it is judged; what cooling and control take"
    )
    uncertainty_current_pu: Floor = _chosen(0.005, "averaged against switched model: 0.006 pu at most, in weak grids")
    uncertainty_power_pu: Floor = _chosen(0.005, "of rated power: averaged against switched model 1.0 kvar of 500 kVA")
    uncertainty_instant_s: Seconds = _chosen(0.001, "of a breaker, and of where a voltage crosses a limit")

    @model_validator(mode="after")
    def _nominal_is_normal(self) -> Self:
        if not self.normal_low_pu.value < 1 < self.normal_high_pu.value:
            low, high = self.normal_low_pu.value, self.normal_high_pu.value
            raise ValueError(f"normal_low_pu and normal_high_pu must lie on either side of 1: {low:g}, {high:g}")
        return self


STANDARD_THRESHOLDS = Thresholds()
