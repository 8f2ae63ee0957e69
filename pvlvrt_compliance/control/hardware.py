"""The hardware around the control algorithm: sensors, converters and the time that things take."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.control.controller import Measured
from pvlvrt_compliance.control.delays import DelayLines, delayed
from pvlvrt_compliance.control.sensors import SensorParams, measure
from pvlvrt_compliance.kernel import kernel


class Hardware(NamedTuple):
    """All of it. A run without has ideal sensors, and its modulating signal acts one period later."""

    sensors: SensorParams
    lines: DelayLines
    random: NDArray[np.float64]  # standard normal numbers, shape (periods or 1, 8)


@kernel
def read(y: Measured, u_zero: float, n: int, first: int, hw: Hardware) -> Measured:
    """What the controller reads in period ``n`` of a run that began with ``first``."""
    row = hw.random[(n - first) % len(hw.random)]
    return delayed(hw.lines, n - first, measure(y, u_zero, row, hw.sensors))
