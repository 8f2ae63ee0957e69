"""The nominal plant, and its blocks driven over many steps in compiled code."""

from collections.abc import Callable
from typing import Any

import numba
import numpy as np
import pytest

from pvlvrt_compliance.plant.grid import source_at
from pvlvrt_compliance.plant.plant import PlantState, advance
from pvlvrt_compliance.plant.protection import NO_TRIP, relays_at_rest, relays_step, undervoltage_limit
from pvlvrt_compliance.plant.pv_array import current_at
from pvlvrt_compliance.plant.switched_bridge import PeriodMean
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.translate import plant_params, plant_tables


@pytest.fixture(scope="session")
def plant() -> Callable[..., tuple[Any, Any]]:
    """Build ``plant(ratio, fidelity, devices, **scenario) -> (params, tables)``, without a sag.

    The control period is 40.9568 us; ``devices`` holds parameters of the plant by name.
    """

    def make(
        ratio: int = 8, fidelity: str = "averaged", devices: dict[str, float] | None = None, **scenario: Any
    ) -> tuple[Any, Any]:
        simulation = {"plant_step_us": 40.9568 / ratio, "control_ratio": ratio, "fidelity": fidelity}
        parameters = Parameters.model_validate({"simulation": simulation, "plant": devices or {}})
        scenario = Scenario(**({"sag": Sag(depth=0), "duration_s": 0.5} | scenario))
        return plant_params(parameters, scenario), plant_tables(parameters, scenario)

    return make


@numba.njit(error_model="numpy")
def _advance(x, m, t, p, tables, i, v_dc):
    for n in range(len(m)):
        t_n = t + n * p.ratio * p.T_S
        x = advance(x, m[n], source_at(t_n, 0, tables.grid), t_n, p, tables)
        i[n], v_dc[n] = x.i, x.v_dc


@pytest.fixture(scope="session")
def open_loop() -> Callable[..., tuple[np.ndarray, np.ndarray]]:
    """Current and DC voltage (A, V) at the end of each control period under modulating signals given, from 834 V."""

    def run(p, tables, m: np.ndarray, i0: complex = 0j, v0: float = 834.0) -> tuple[np.ndarray, np.ndarray]:
        i_pv = current_at(v0, 1000 * p.G, p.pv)
        x_pv = v0 / p.pv.n_series + p.pv.R_s * i_pv / p.pv.n_parallel
        relay = relays_at_rest(complex(p.protection.u_nom), p.protection.w_nom)
        start = PlantState(
            i=i0,
            v_dc=v0,
            x_pv=x_pv,
            i_pv=i_pv,
            relay=relay,
            trip=NO_TRIP,
            t_trip=0.0,
            closed=True,
            blocked=False,
            mean=PeriodMean(u=0j, i=i0),
        )
        deaf = p._replace(protection=p.protection._replace(i_max=1e12, v_dc_max=1e12))
        i, v_dc = np.empty(len(m), complex), np.empty(len(m))
        _advance(start, np.asarray(m, complex), 0.0, deaf, tables, i, v_dc)
        return i, v_dc

    return run


@numba.njit(error_model="numpy")
def _watch(relay, u, i, v_dc, p, curve, T_S):
    for n in range(len(u)):
        relay, trip = relays_step(relay, u[n], i[n], v_dc[n], undervoltage_limit(relay, p, curve), p, T_S)
        if trip != NO_TRIP:
            return n, trip
    return -1, NO_TRIP


@pytest.fixture(scope="session")
def watch(plant) -> Callable[..., tuple[float | None, int]]:
    """Show the relays voltages, currents and DC voltages; returns when they trip (s, None: never) and why."""

    def run(u=None, i=None, v_dc=None, frequency_hz: float = 50.0) -> tuple[float | None, int]:
        p, tables = plant(frequency_hz=frequency_hz)
        n = max(len(x) for x in (u, i, v_dc) if x is not None)
        nominal = p.protection.u_nom * np.exp(1j * p.protection.w_nom * p.T_S * np.arange(n))
        u = nominal if u is None else u
        i = np.zeros(n, complex) if i is None else i
        v_dc = np.full(n, 834.0) if v_dc is None else v_dc
        relay = relays_at_rest(complex(u[0]), p.protection.w_nom)
        step, code = _watch(relay, u, i, v_dc, p.protection, tables.undervoltage, p.T_S)
        return (step * p.T_S if code != NO_TRIP else None), code

    return run
