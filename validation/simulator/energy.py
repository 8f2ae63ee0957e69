"""Energy of a record: what the source and the array give, what is stored, and what summing samples can miss of it."""

import math

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.translate import plant_step_s
from pvlvrt_compliance.waveforms import Segment
from validation.simulator.records import NOMINAL, vector

_ROUNDING = 1e-9  # of S_nom times the window: ten digits of the 30 kJ in the link


def grid_impedance(scenario: Scenario) -> tuple[float, float]:
    """Resistance (ohm) and inductance (H) between the PCC and the source."""
    if scenario.scr is None:
        return 0.0, 0.0
    R_g = NOMINAL.impedance_ohm / scenario.scr / math.hypot(1, scenario.xr)
    return R_g, R_g * scenario.xr / (2 * math.pi * scenario.nominal_frequency_hz)


def source_power(samples: Segment, scenario: Scenario, parameters: Parameters) -> NDArray[np.float64]:
    """What the source takes and the resistances lose (W).

    The grid counts from its source on, whose voltage is smooth between events; the voltage at the PCC of a weak grid
    jumps with the modulating signal at every sample, and no sum over samples could tell its mean.
    """
    i, (R_g, _) = vector(samples, "i"), grid_impedance(scenario)
    taken: NDArray[np.float64] = (vector(samples, "u0") * i.conj()).real
    return taken + (parameters.plant.filter_resistance_ohm + R_g) * np.abs(i) ** 2


def array_power(samples: Segment, T_S: float) -> NDArray[np.float64]:
    """What the array gives (W); its recorded current is that of the middle of the plant step before the sample."""
    i_pv = samples["i_pv_a"]
    now = i_pv + 0.5 * T_S / samples.dt_s * np.gradient(i_pv)
    power: NDArray[np.float64] = samples["v_dc_v"] * now
    return power


def stored_energy(samples: Segment, scenario: Scenario, parameters: Parameters) -> NDArray[np.float64]:
    """Energy in the link and in the inductances of filter and grid (J)."""
    plant, (_, L_g) = parameters.plant, grid_impedance(scenario)
    stored: NDArray[np.float64] = 0.5 * plant.dc_link_capacitance_f * samples["v_dc_v"] ** 2
    return stored + 0.5 * (plant.filter_inductance_h + L_g) * np.abs(vector(samples, "i")) ** 2


def jumps(samples: Segment, scenario: Scenario, T_S: float) -> list[tuple[int, float]]:
    """Where the source jumps within the samples: the one before, and the share of the step from there (0 to 1).

    A jump acts from the beginning of the plant step whose middle it precedes.
    """
    found = []
    for t in (scenario.start_s, scenario.clear_s):
        k = math.ceil((t - samples.t0_s) / samples.dt_s - 1e-9) - 1
        acts = T_S * math.ceil(t / T_S - 0.5)
        if 0 <= k < len(samples) - 1:
            found.append((k, (acts - samples.t0_s) / samples.dt_s - k))
    return found


def summed(power: NDArray[np.float64], dt_s: float, where: list[tuple[int, float]]) -> float:
    """Energy (J) of a sampled power (W) by the trapezium rule, with each jump where it is instead of halfway."""
    moved = sum((share - 0.5) * (power[k] - power[k + 1]) for k, share in where)
    return float(np.trapezoid(power, dx=dt_s) + dt_s * moved)


def unbalanced_energy(samples: Segment, scenario: Scenario, parameters: Parameters) -> float:
    """What the array gives less what is stored, lost in resistances, and taken by the source (J)."""
    T_S = plant_step_s(parameters)
    power = array_power(samples, T_S) - source_power(samples, scenario, parameters)
    stored = stored_energy(samples, scenario, parameters)
    return summed(power, samples.dt_s, jumps(samples, scenario, T_S)) - float(stored[-1] - stored[0])


def summing_bound(samples: Segment, scenario: Scenario, parameters: Parameters) -> float:
    """By how much `summed` can miss the energy between these samples, at most (J), over any number of them.

    The trapezium rule misses h^2/12 of the integral of |p''|. With the modulating signal held from sample to sample,
    i'' = -e'/L there, so that of p = e i no more than 2 w E |i'| + w^2 E I + w E^2/L is left, and |i'| sums to the way
    that the current goes. Of R i^2 it is 2 R |i'|^2, and of the array what its samples say; these two are doubled, as
    differences of samples miss the steepest slope. A step with a jump is cut there, and each part taken as level: that
    misses h^2/2 of |p'|, which is no more than w E I + E |i'|.
    """
    i, e, h = vector(samples, "i"), vector(samples, "u0"), samples.dt_s
    R_g, L_g = grid_impedance(scenario)
    R, L = parameters.plant.filter_resistance_ohm + R_g, parameters.plant.filter_inductance_h + L_g
    w, E, I_max = 2 * math.pi * scenario.frequency_hz, float(np.abs(e).max()), float(np.abs(i).max())
    way = np.abs(np.diff(i))
    T_S, length = plant_step_s(parameters), h * (len(samples) - 1)
    source = 2 * w * E * float(way.sum()) + (w**2 * E * I_max + w * E**2 / L) * length
    lost = 4 * R * float((way**2).sum()) / h
    array = 2 * float(np.abs(np.diff(array_power(samples, T_S), 2)).sum()) / h
    at_jumps = sum(w * E * I_max + E * float(way[k]) / h for k, _ in jumps(samples, scenario, T_S))
    rounding = _ROUNDING * NOMINAL.apparent_power_va * length
    return h**2 * ((source + lost + array) / 12 + at_jumps / 2) + rounding
