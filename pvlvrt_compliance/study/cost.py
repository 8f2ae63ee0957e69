"""What a run would cost, said before it starts: the samples of each record, and the steps that make it."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.scenario.events import Harmonic
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.scenario.timeline import busy_stretches
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.thinning import settling_step, stretches_of, too_much

if TYPE_CHECKING:
    from pvlvrt_compliance.study.selection import Assignment

MOST_STEPS = 10_000_000_000
"""Plant steps of one test: chosen, a quarter of an hour of computing; half an hour of grid has 0.35e9."""

_STEPS_OF_A_HARMONIC = 1 / 8
"""What a harmonic of the source adds to each step: measured, 12 ns to 90 ns."""


def refuse_costly(tests: "Sequence[Assignment]", parameters: Parameters) -> None:
    """Refuse tests whose record would take more memory, or more steps, than one may.

    Of a controller of the user's own the records are those of the usual sampling at most. What a recording adds, and a
    second record where the inverter trips, is seen when they are made.

    Raises
    ------
    UsageError
        With the first such test, what it would take and what is allowed.
    """
    for item in tests:
        scenario = item.test.scenario
        steps = _steps(scenario, parameters)
        said = too_much(rows_of(scenario, parameters))
        if steps > MOST_STEPS:
            said = f"{steps:.3g} plant steps, a harmonic of the source an eighth more; {MOST_STEPS:.3g} are allowed"
        if said is not None:
            by = "simulation.plant_step_us, simulation.control_ratio, how long it lasts and how often something happens"
            raise UsageError(f"{item.key}: {said}; this follows from {by}")


def rows_of(scenario: Scenario, parameters: Parameters) -> int:
    """Rows of the record of a scenario."""
    simulation = parameters.simulation
    T_reg = 1e-6 * simulation.plant_step_us * simulation.control_ratio
    periods = math.floor(scenario.end_s / T_reg) + 1
    settling = math.floor(simulation.settling_s / T_reg) if simulation.record_settling else 0
    recorded = sum(stretch.rows for stretch in stretches_of(busy_stretches(scenario), periods, T_reg))
    return recorded + settling // settling_step(settling, T_reg)


def _steps(scenario: Scenario, parameters: Parameters) -> float:
    """Plant steps from the beginning to the end, more of them with harmonics, which are added up in every one."""
    simulation = parameters.simulation
    whole_s = simulation.synchronising_s + simulation.settling_s + scenario.end_s
    harmonics = sum(isinstance(event, Harmonic) for event in scenario.events)
    return (1 + _STEPS_OF_A_HARMONIC * harmonics) * 1e6 * whole_s / simulation.plant_step_us
