"""The border to a controller of single precision: the sensors' numbers are rounded on their way in.

How it computes with them is `control.precision`; what comes out of it is exact in 64 bits.
"""

from typing import Any

import numpy as np

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.measured import Measured

_float32: Any = np.float32  # unlike those of 64 bits no subclass of what the fields are declared as
_complex64: Any = np.complex64


@kernel
def single_measured(y: Measured) -> Measured:
    """Nearest numbers of 32 bits."""
    return Measured(
        u_g_ab=_complex64(y.u_g_ab),
        i_ab=_complex64(y.i_ab),
        v_dc=_float32(y.v_dc),
        i_pv=_float32(y.i_pv),
    )
