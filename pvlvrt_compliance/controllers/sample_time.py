"""The plant step that goes with a controller's sample time."""

import math
from typing import NamedTuple

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.simulation.parameters import (
    LONGEST_PERIOD_S,
    SHORTEST_PERIOD_S,
    Parameters,
    SimulationParameters,
)

_DEFAULT_STEP_US = SimulationParameters.model_fields["plant_step_us"].default
_PERIOD_US = _DEFAULT_STEP_US * SimulationParameters.model_fields["control_ratio"].default  # of a record, at most
_SLACK = 1e-9  # relative: sample times that differ by less are the same
_FIXED_SLACK = 1e-6  # the same, of a step that the user has fixed


class Rates(NamedTuple):
    """Whole numbers between plant step and sample time. A period of the plant is its unit in loop and record."""

    plant_step_us: float  # T_S (us)
    steps: int  # plant steps in a period
    periods: int  # periods in a sample time of the controller
    thinning: int  # periods from one row of a record to the next

    @property
    def sample_time_s(self) -> float:
        """Sample time of the controller, as it comes out (s)."""
        return 1e-6 * self.plant_step_us * self.steps * self.periods

    @property
    def plant_steps_per_sample(self) -> int:
        """Plant steps in a sample time of the controller."""
        return self.steps * self.periods

    @property
    def recorded_every_us(self) -> float:
        """From one row of a record to the next (us)."""
        return self.plant_step_us * self.steps * self.thinning


def rates_of(sample_time_s: float, parameters: Parameters) -> Rates:
    """Rates of a run with a controller of this sample time (s).

    The plant step is the largest whole part of the sample time that is not above the default step; with a switched
    inverter the largest that also divides it into carrier periods of the default length at most. With a plant step or
    a ratio that the user has fixed, it is that.

    Raises
    ------
    UsageError
        When the sample time is out of range, or the fixed step is not a whole part of it, with the nearest that are.
    """
    if not (math.isfinite(sample_time_s) and SHORTEST_PERIOD_S <= sample_time_s <= LONGEST_PERIOD_S):
        raise UsageError(
            f"the controller's sample time is {sample_time_s:g} s; it must be from"
            f" {SHORTEST_PERIOD_S:g} s to {LONGEST_PERIOD_S:g} s"
        )
    sample_us = 1e6 * sample_time_s
    switched = parameters.simulation.fidelity == "switched"
    if (fixed := _fixed_steps(sample_us, parameters.simulation)) is not None:
        steps = fixed
    elif switched:
        carriers = not_below(sample_us / _PERIOD_US)
        steps = carriers * not_below(sample_us / carriers / _DEFAULT_STEP_US)
    else:
        steps = not_below(sample_us / _DEFAULT_STEP_US)
    plant_step_us = sample_us / steps
    if abs(plant_step_us - _DEFAULT_STEP_US) <= _SLACK * _DEFAULT_STEP_US:
        plant_step_us = _DEFAULT_STEP_US
    limit = _PERIOD_US / plant_step_us * (1 + _SLACK)
    per_period = max(n for n in range(1, steps + 1) if steps % n == 0 and (n == 1 or n <= limit))
    return Rates(
        plant_step_us=plant_step_us,
        steps=per_period,
        periods=steps // per_period,
        thinning=max(int(limit / per_period), 1),
    )


def with_rates(parameters: Parameters, rates: Rates) -> Parameters:
    """Parameters in which the plant runs by these rates: what the rest of the simulation calls the control period."""
    simulation = parameters.simulation.model_copy(
        update={"plant_step_us": rates.plant_step_us, "control_ratio": rates.steps}
    )
    return parameters.model_copy(update={"simulation": simulation})


def not_below(ratio: float) -> int:
    """Smallest whole number that is not below a ratio, but for rounding."""
    return math.ceil(ratio * (1 - _SLACK))


def _fixed_steps(sample_us: float, simulation: SimulationParameters) -> int | None:
    """Plant steps in a sample time, where the user has fixed the step or the ratio."""
    given = simulation.model_fields_set
    ratio = simulation.control_ratio if "control_ratio" in given else None
    if "plant_step_us" not in given:
        return ratio
    found = sample_us / simulation.plant_step_us
    steps = max(round(found), 1)
    if abs(found - steps) > _FIXED_SLACK * steps:
        below = max(math.floor(found), 1)
        near = " or ".join(f"{sample_us / n:.6g} us ({n} steps)" for n in (below, below + 1))
        raise UsageError(
            f"--set simulation.plant_step_us: {simulation.plant_step_us:g} us is not a whole part of the controller's"
            f" sample time, {sample_us:g} us; the nearest are {near}"
        )
    if ratio is not None and ratio != steps:
        raise UsageError(
            f"--set simulation.control_ratio: {ratio} steps of {simulation.plant_step_us:g} us are not the controller's"
            f" sample time, {sample_us:g} us; leave one of the two out"
        )
    return steps
