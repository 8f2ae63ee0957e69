"""What a controller is told of the plant that it is to control: its rating, its data, and the power that there is."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.plant.plant import PlantTables
from pvlvrt_compliance.plant.pv_array import STC_IRRADIANCE, maximum_power_point
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.translate import nominal_of, pv_params

_POINTS = 129
"""Of the power by the irradiance, where that changes: straight lines between them are within 0.01 % of nominal."""


@dataclass(frozen=True)
class Told:
    """Fixed signals by name, and the most that the array can give (W) by the irradiance."""

    fixed: Mapping[str, float]
    available: NDArray[np.float64]  # in equal steps
    irradiance: NDArray[np.float64]  # from the first to the last, shape (2,); in units of 1000 W/m2


def told_of(scenario: Scenario, parameters: Parameters, tables: PlantTables) -> Told:
    """What a controller is told of the plant in one scenario."""
    nominal, plant = nominal_of(parameters, scenario), parameters.plant
    standard = pv_params(parameters, scenario.model_copy(update={"cell_temperature_c": 25.0}))
    fixed = {
        "q_set_var": scenario.reactive_power_pu * nominal.apparent_power_va,
        "frequency_nominal_hz": nominal.frequency_hz,
        "apparent_power_nominal_va": nominal.apparent_power_va,
        "voltage_nominal_v": nominal.phase_voltage_v,
        "v_dc_nominal_v": maximum_power_point(STC_IRRADIANCE, standard).v,
        "filter_inductance_h": plant.filter_inductance_h,
        "filter_resistance_ohm": plant.filter_resistance_ohm,
        "dc_link_capacitance_f": plant.dc_link_capacitance_f,
    }
    low, high = float(tables.irradiance.G.min()), float(tables.irradiance.G.max())
    here = pv_params(parameters, scenario)
    levels = np.linspace(low, high, _POINTS if high > low else 1)
    powers = [maximum_power_point(STC_IRRADIANCE * float(G), here).p if G > 0 else 0.0 for G in levels]
    return Told(fixed, np.array(powers), np.array([low, high]))
