"""The columns of a record, by name: the only list of its channels, and what writes a sample into them."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.control.controller import ControllerSignals
from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.places import PhasePlaces, numbered
from pvlvrt_compliance.plant.plant import Observed, PlantState
from pvlvrt_compliance.vectors import Phases, phases_of


class PlantColumns(NamedTuple):
    """Channels that the plant gives, whichever controller runs it; the first columns of every record."""

    u_a_v: int
    u_b_v: int
    u_c_v: int
    u0_a_v: int
    u0_b_v: int
    u0_c_v: int
    i_a_a: int
    i_b_a: int
    i_c_a: int
    v_dc_v: int
    i_pv_a: int
    irradiance_w_m2: int
    connected: int
    trip_cause: int


class ControllerColumns(NamedTuple):
    """Channels of the bundled controller, after the plant's."""

    v_fault_pu: int
    fault_signal: int
    frequency_estimate_hz: int
    v_dc_ref_v: int
    p_ref_w: int
    q_ref_var: int
    i_ref_alpha_a: int
    i_ref_beta_a: int
    m_alpha: int
    m_beta: int


class ForeignColumns(NamedTuple):
    """Channels of every controller from outside, after the plant's; signals of its own follow."""

    m_alpha: int
    m_beta: int


PLANT = numbered(PlantColumns)
CONTROLLER = numbered(ControllerColumns, len(PLANT))
FOREIGN = numbered(ForeignColumns, len(PLANT))
FURTHER = len(PLANT) + len(FOREIGN)
"""First column of the signals of a controller's own."""

U = PhasePlaces(PLANT.u_a_v, PLANT.u_b_v, PLANT.u_c_v)
U0 = PhasePlaces(PLANT.u0_a_v, PLANT.u0_b_v, PLANT.u0_c_v)
I = PhasePlaces(PLANT.i_a_a, PLANT.i_b_a, PLANT.i_c_a)  # noqa: E741 - the symbol of the current

PLANT_CHANNELS = PlantColumns._fields
"""Channels that the plant gives, in the order of their columns."""

CHANNELS = (*PLANT_CHANNELS, *ControllerColumns._fields)
"""Channels of a record, in the order of its columns; from ``v_fault_pu`` on the bundled controller's own."""

RECORDED = (*PLANT_CHANNELS, *ForeignColumns._fields)
"""Channels of every record of a controller from outside."""


@kernel
def put_phases(x: NDArray[np.float64], at: PhasePlaces, ab: complex, zero: float) -> None:
    """Write the three phases of a vector, zero sequence included."""
    phases = phases_of(ab)
    x[at.a], x[at.b], x[at.c] = phases.a + zero, phases.b + zero, phases.c + zero


@kernel
def phases_at(x: NDArray[np.float64], at: PhasePlaces) -> Phases:
    """Read three phases."""
    return Phases(a=x[at.a], b=x[at.b], c=x[at.c])


@kernel
def record_plant(row: NDArray[np.float64], x: PlantState, y: Observed, G: float) -> None:
    """Write one sample of the plant."""
    put_phases(row, U, y.u_ab, y.u_zero)
    put_phases(row, U0, y.u0_ab, y.u_zero)
    put_phases(row, I, x.i, 0.0)
    row[PLANT.v_dc_v] = x.v_dc
    row[PLANT.i_pv_a] = x.i_pv
    row[PLANT.irradiance_w_m2] = 1000.0 * G
    row[PLANT.connected] = 1.0 if x.closed else 0.0
    row[PLANT.trip_cause] = float(x.trip)


@kernel
def record_controller(row: NDArray[np.float64], s: ControllerSignals) -> None:
    """Write one sample of the bundled controller."""
    row[CONTROLLER.v_fault_pu] = s.V_fault
    row[CONTROLLER.fault_signal] = 1.0 if s.fault else 0.0
    row[CONTROLLER.frequency_estimate_hz] = s.w / (2 * math.pi)
    row[CONTROLLER.v_dc_ref_v] = s.v_ref
    row[CONTROLLER.p_ref_w] = s.P_ref
    row[CONTROLLER.q_ref_var] = s.Q_ref
    row[CONTROLLER.i_ref_alpha_a] = s.i_ref.real
    row[CONTROLLER.i_ref_beta_a] = s.i_ref.imag
    row[CONTROLLER.m_alpha] = s.m.real
    row[CONTROLLER.m_beta] = s.m.imag
