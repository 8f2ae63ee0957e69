"""From a scenario and parameters to waveforms."""

import math

import numpy as np

from pvlvrt_compliance.control.precision import in_single_precision
from pvlvrt_compliance.errors import SimulationError
from pvlvrt_compliance.plant import pv_array
from pvlvrt_compliance.scenario.parameters import Parameters
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.electronics import hardware_of
from pvlvrt_compliance.simulation.loop import CHANNELS, COMPLETED, run
from pvlvrt_compliance.simulation.translate import (
    control_period_s,
    controller_params,
    plant_params,
    plant_tables,
    pv_params,
    steady_state,
)
from pvlvrt_compliance.waveforms import Segment, Waveforms


def simulate(scenario: Scenario, parameters: Parameters, run=run) -> Waveforms:  # type: ignore[no-untyped-def]
    """Run plant and controller through a scenario, from the steady state of normal operation.

    Parameters
    ----------
    scenario : Scenario
        Grid, weather and sag.
    parameters : Parameters
        Everything else.
    run : compiled function, optional
        Loop over time with the signature of `loop.run`; the bundled controller's by default.

    Raises
    ------
    SimulationError
        When a number stops being finite, with the simulated time.
    """
    plant = plant_params(parameters, scenario)
    tables = plant_tables(parameters, scenario)
    controller = controller_params(parameters, scenario)
    T_reg = control_period_s(parameters)
    settling = math.ceil(parameters.simulation.settling_s / T_reg)
    samples = np.empty((math.floor(scenario.end_s / T_reg) + 1, len(CHANNELS)))
    start = steady_state(plant, tables.grid, controller, scenario, -settling * T_reg)
    hardware = hardware_of(parameters, start, settling + len(samples))
    state = start.controller
    if parameters.controller.precision == "single":
        state, controller = in_single_precision(state, controller)
    outcome = run(start.plant, state, start.m, -settling, plant, tables, controller, hardware, samples)
    if outcome.status != COMPLETED:
        raise SimulationError(f"a number stopped being finite at {outcome.samples * T_reg:.4f} s")
    columns = np.ascontiguousarray(samples.T)
    return Waveforms((Segment(0.0, T_reg, dict(zip(CHANNELS, columns, strict=True))),))


def available_power_w(scenario: Scenario, parameters: Parameters) -> float:
    """Most that the array can give in this scenario (W)."""
    return pv_array.maximum_power_point(scenario.irradiance_w_m2, pv_params(parameters, scenario)).p
