"""The whole controller: wires the blocks of Fig. 1. No arithmetic of its own."""

from typing import NamedTuple

from pvlvrt_compliance.control.current_references import CurrentReferenceParams, current_references
from pvlvrt_compliance.control.current_regulator import (
    CurrentRegulatorParams,
    CurrentRegulatorState,
    current_regulator_step,
)
from pvlvrt_compliance.control.dc_voltage_regulator import (
    DcVoltageRegulatorParams,
    DcVoltageRegulatorState,
    dc_voltage_regulator_step,
)
from pvlvrt_compliance.control.lvrt import LvrtParams, lvrt_step
from pvlvrt_compliance.control.modulator import ModulatorParams, modulate
from pvlvrt_compliance.control.mppt import MpptParams, MpptState, mppt_step
from pvlvrt_compliance.control.synchronisation import (
    SynchronisationParams,
    SynchronisationState,
    synchronise,
    with_arrays_of,
)
from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.measured import Measured


class Precision(NamedTuple):
    """Which numbers the controller computes with: one is there, the other none. numba compiles the one that is."""

    double: bool | None  # of 64 bits
    single: bool | None  # of 32 bits, see precision.py


class ControllerParams(NamedTuple):
    """Parameters by block, and the sample time."""

    sync: SynchronisationParams
    lvrt: LvrtParams
    dc_voltage: DcVoltageRegulatorParams
    mppt: MpptParams
    references: CurrentReferenceParams
    current: CurrentRegulatorParams
    modulator: ModulatorParams
    T: float  # T_reg (s)
    precision: Precision


class ControllerState(NamedTuple):
    """States by block."""

    sync: SynchronisationState
    dc_voltage: DcVoltageRegulatorState
    mppt: MpptState
    current: CurrentRegulatorState


def joined(before: ControllerState, x: ControllerState) -> ControllerState:
    """State at the end of a run that began in another, whose arrays it has written in, and which are these now."""
    return x._replace(sync=with_arrays_of(before.sync, x.sync))


class ControllerSignals(NamedTuple):
    """What the controller puts out: the modulating signal, and what it believed, for the record."""

    m: complex  # modulating signal, alpha + j beta (-)
    V_fault: float  # (pu)
    fault: bool  # Fault Signal
    w: float  # w0' (rad/s)
    v_ref: float  # v*_DC (V)
    P_ref: float  # P* (W)
    Q_ref: float  # Q* (var)
    i_ref: complex  # i* (A)


@kernel
def controller_step(x: ControllerState, y: Measured, p: ControllerParams) -> tuple[ControllerState, ControllerSignals]:
    """Advance the controller by one sample."""
    sync, grid = synchronise(x.sync, y.u_g_ab, p.sync, p.T)
    order = lvrt_step(grid.u_pos, grid.u_neg, p.lvrt)
    dc_voltage, P_ref, limited = dc_voltage_regulator_step(
        x.dc_voltage, y.v_dc, x.mppt.v_ref, order.P_limit, p.dc_voltage, p.T
    )
    mppt = mppt_step(x.mppt, y.v_dc, y.i_pv, limited, p.mppt)
    i_ref = current_references(grid.u_pos, grid.u_neg, P_ref, order.Q_ref, p.references)
    current, m = current_regulator_step(x.current, i_ref - y.i_ab, grid.w, grid.turns, p.current)
    signals = ControllerSignals(
        m=modulate(m, y.u_g_ab, y.v_dc, p.modulator),
        V_fault=order.V_fault,
        fault=order.fault,
        w=grid.w,
        v_ref=x.mppt.v_ref,
        P_ref=P_ref,
        Q_ref=order.Q_ref,
        i_ref=i_ref,
    )
    return ControllerState(sync=sync, dc_voltage=dc_voltage, mppt=mppt, current=current), signals
