"""The only loop over time: samples, controller, plant, recorder, at two rates."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.control.controller import (
    ControllerParams,
    ControllerSignals,
    ControllerState,
    Measured,
    controller_step,
)
from pvlvrt_compliance.control.delays import acting, put
from pvlvrt_compliance.control.hardware import Hardware, read
from pvlvrt_compliance.control.precision import controller_step_in_single
from pvlvrt_compliance.kernel import cached_kernel, kernel
from pvlvrt_compliance.plant.grid import source_at
from pvlvrt_compliance.plant.plant import Observed, PlantParams, PlantState, PlantTables, advance, as_at, observe
from pvlvrt_compliance.plant.protection import NO_TRIP
from pvlvrt_compliance.simulation.recorder import RecordingPlan, next_row
from pvlvrt_compliance.vectors import phases_of

COMPLETED, NOT_FINITE = range(2)
"""How a run ended."""

PLANT_CHANNELS = (
    *("u_a_v", "u_b_v", "u_c_v", "u0_a_v", "u0_b_v", "u0_c_v", "i_a_a", "i_b_a", "i_c_a"),
    *("v_dc_v", "i_pv_a", "irradiance_w_m2", "connected", "trip_cause"),
)
"""Channels that the plant gives, whichever controller runs it; the first columns of every record."""

CHANNELS = (
    *PLANT_CHANNELS,
    *("v_fault_pu", "fault_signal", "frequency_estimate_hz", "v_dc_ref_v", "p_ref_w", "q_ref_var"),
    *("i_ref_alpha_a", "i_ref_beta_a", "m_alpha", "m_beta"),
)
"""Channels of a record, in the order of its columns; from ``v_fault_pu`` on the controller's own."""


class Outcome(NamedTuple):
    """How a run ended, and where the plant was then."""

    status: int
    periods: int  # control periods that came out finite, unrecorded settling left out
    plant: PlantState


@kernel
def record_phases(row: NDArray[np.float64], column: int, ab: complex, zero: float) -> None:
    """Write the three phases of a vector, zero sequence included, from a column on."""
    x = phases_of(ab)
    row[column], row[column + 1], row[column + 2] = x.a + zero, x.b + zero, x.c + zero


@kernel
def record_plant(row: NDArray[np.float64], x: PlantState, y: Observed, G: float) -> None:
    """Write one sample of the plant in the order of `PLANT_CHANNELS`."""
    record_phases(row, 0, y.u_ab, y.u_zero)
    record_phases(row, 3, y.u0_ab, y.u_zero)
    record_phases(row, 6, x.i, 0.0)
    row[9], row[10], row[11], row[12] = x.v_dc, x.i_pv, 1000.0 * G, 1.0 if x.closed else 0.0
    row[13] = float(x.trip)


@kernel
def record(row: NDArray[np.float64], x: PlantState, y: Observed, s: ControllerSignals, G: float) -> None:
    """Write one sample in the order of `CHANNELS`."""
    record_plant(row, x, y, G)
    row[14], row[15], row[16], row[17] = s.V_fault, 1.0 if s.fault else 0.0, s.w / (2 * math.pi), s.v_ref
    row[18], row[19] = s.P_ref, s.Q_ref
    row[20], row[21], row[22], row[23] = s.i_ref.real, s.i_ref.imag, s.m.real, s.m.imag


def tripped_at_s(plant: PlantState, now_s: float) -> float | None:
    """When a plant that is in this state now has tripped (s), None when it has not."""
    return None if plant.trip == NO_TRIP else now_s - plant.t_trip


@kernel
def is_finite(x: PlantState, s: ControllerSignals) -> bool:
    """Whether every number that the next sample depends on is one: a sum is finite only if all its terms are.

    After a trip the bridge is blocked, and none depends on the controller.
    """
    plant = x.v_dc + x.i.real + x.i.imag + x.i_pv
    if x.trip != NO_TRIP:
        return math.isfinite(plant)
    return math.isfinite(plant + s.m.real + s.m.imag + s.w + s.P_ref + s.v_ref)


@kernel
def controller_with(
    x: ControllerState, y: Measured, p: ControllerParams, double: bool | None, single: bool | None
) -> tuple[ControllerState, ControllerSignals]:
    """Advance the controller by one sample, in the precision of its numbers."""
    if double is not None:
        return controller_step(x, y, p)
    if single is None:
        raise ValueError("no precision is chosen")
    return controller_step_in_single(x, y, p)


@cached_kernel
def run(
    plant: PlantState,
    controller: ControllerState,
    m: complex,
    first: int,
    plant_params: PlantParams,
    tables: PlantTables,
    controller_params: ControllerParams,
    hardware: Hardware | None,
    plan: RecordingPlan,
    samples: NDArray[np.float64],
) -> Outcome:
    """Simulate from control period ``first`` (negative: unrecorded settling) to the end of the plan.

    The controller samples at the beginning of a period; what it computes acts from the next period on, held for one:
    1.5 periods in all, unless ``hardware`` says otherwise. Period n begins at n T_reg.

    Parameters
    ----------
    plant, controller : PlantState, ControllerState
        States at the beginning.
    m : complex
        Modulating signal of the first period (-).
    plan : RecordingPlan
        Which periods are recorded.
    samples : array, shape (n, len(CHANNELS))
        Filled with the record, a row for every period of the plan.
    """
    T_reg = plant_params.ratio * plant_params.T_S
    k_grid = 0
    row, stretch, due = 0, 0, plan.first[0]
    for n in range(first, plan.first[-1]):
        t = n * T_reg
        source = source_at(t, k_grid, tables.grid)
        k_grid = source.k
        if hardware is not None:
            m = acting(hardware.lines, n - first)
        now = as_at(t, k_grid, plant_params, tables)
        y = observe(plant, m, source, t, now, tables)
        sampled = Measured(u_g_ab=y.u_ab, i_ab=plant.i, v_dc=plant.v_dc, i_pv=plant.i_pv)
        if hardware is not None:
            sampled = read(sampled, y.u_zero, n, first, hardware)
        precision = controller_params.precision
        controller, signals = controller_with(
            controller, sampled, controller_params, precision.double, precision.single
        )
        if not is_finite(plant, signals):
            return Outcome(status=NOT_FINITE, periods=max(n, 0), plant=plant)
        if n == due:
            record(samples[row], plant, y, signals, now.G)
            row += 1
            stretch, due = next_row(stretch, n, plan)
        if hardware is not None:
            put(hardware.lines, n - first, signals.m)
            m = acting(hardware.lines, n - first)
        plant = advance(plant, m, source, t, now, tables)
        m = signals.m
    return Outcome(status=COMPLETED, periods=plan.first[-1], plant=plant)
