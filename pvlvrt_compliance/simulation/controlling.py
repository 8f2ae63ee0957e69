"""The bundled controller in the loop, in the precision of its numbers."""

from pvlvrt_compliance.control.controller import (
    ControllerParams,
    ControllerSignals,
    ControllerState,
    controller_step,
)
from pvlvrt_compliance.control.precision import double_signals, single_step
from pvlvrt_compliance.hardware.precision import single_measured
from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.measured import Measured


@kernel
def commanding(m: complex) -> ControllerSignals:
    """Signals of a controller of which only the modulating signal is known."""
    return ControllerSignals(m=m, V_fault=0.0, fault=False, w=0.0, v_ref=0.0, P_ref=0.0, Q_ref=0.0, i_ref=0j)


@kernel
def controller_with(
    x: ControllerState, y: Measured, p: ControllerParams, double: bool | None, single: bool | None
) -> tuple[ControllerState, ControllerSignals]:
    """Advance the controller by one sample, in the precision of its numbers."""
    if double is not None:
        return controller_step(x, y, p)
    if single is None:
        raise ValueError("no precision is chosen")
    after, signals = single_step(x, single_measured(y), p)
    return after, double_signals(signals)


@kernel
def controlled(
    x: ControllerState | None, y: Measured, p: ControllerParams
) -> tuple[ControllerState, ControllerSignals]:
    """Advance the controller by one sample."""
    if x is None:
        raise ValueError("parameters without a state")
    return controller_with(x, y, p, p.precision.double, p.precision.single)
