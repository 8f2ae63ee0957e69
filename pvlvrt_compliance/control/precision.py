"""Single precision: a controller whose every number and every operation has 32 bits, as on most signal processors.

The blocks are the same sources, compiled with constants, parameters and states of 32 bits (`kernel.in_single`). Numbers
of the sensors come in rounded (`hardware.precision`); what comes out is exact in 64 bits.
"""

import numpy as np

from pvlvrt_compliance.control.controller import (
    ControllerParams,
    ControllerSignals,
    ControllerState,
    Precision,
    controller_step,
)
from pvlvrt_compliance.kernel import in_single, kernel, single

single_step = in_single(controller_step)
"""`controller_step` with constants of 32 bits, for states, inputs and parameters of 32 bits."""


def in_single_precision(x: ControllerState, p: ControllerParams) -> tuple[ControllerState, ControllerParams]:
    """State and parameters of a controller that computes in single precision, from those of one in double."""
    return single(x), single(p._replace(precision=Precision(double=None, single=True)))


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
