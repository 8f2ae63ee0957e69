"""Single precision: a controller whose every number and every operation has 32 bits, as on most signal processors.

The blocks are the same sources, compiled with constants, parameters and states of 32 bits (`kernel.in_single`). The
sensors' numbers are rounded on their way in; what comes out is exact in 64 bits.
"""

from typing import Any

import numpy as np

from pvlvrt_compliance.control.controller import (
    ControllerParams,
    ControllerSignals,
    ControllerState,
    Measured,
    Precision,
    controller_step,
)
from pvlvrt_compliance.kernel import in_single, kernel, single

single_step = in_single(controller_step)
"""`controller_step` with constants of 32 bits, for states, inputs and parameters of 32 bits."""

_float32: Any = np.float32  # unlike those of 64 bits no subclass of what the fields are declared as
_complex64: Any = np.complex64


def in_single_precision(x: ControllerState, p: ControllerParams) -> tuple[ControllerState, ControllerParams]:
    """State and parameters of a controller that computes in single precision, from those of one in double."""
    return single(x), single(p._replace(precision=Precision(double=None, single=True)))


@kernel
def single_measured(y: Measured) -> Measured:
    """Nearest numbers of 32 bits."""
    return Measured(
        u_g_ab=_complex64(y.u_g_ab),
        i_ab=_complex64(y.i_ab),
        v_dc=_float32(y.v_dc),
        i_pv=_float32(y.i_pv),
    )


@kernel
def double_signals(s: ControllerSignals) -> ControllerSignals:
    """The same numbers in 64 bits, for the plant and the record."""
    return ControllerSignals(
        m=np.complex128(s.m),
        V_fault=np.float64(s.V_fault),
        fault=s.fault,
        w=np.float64(s.w),
        v_ref=np.float64(s.v_ref),
        P_ref=np.float64(s.P_ref),
        Q_ref=np.float64(s.Q_ref),
        i_ref=np.complex128(s.i_ref),
    )


@kernel
def controller_step_in_single(
    x: ControllerState, y: Measured, p: ControllerParams
) -> tuple[ControllerState, ControllerSignals]:
    """Advance a controller of single precision by one sample of numbers of 64 bits."""
    after, signals = single_step(x, single_measured(y), p)
    return after, double_signals(signals)
