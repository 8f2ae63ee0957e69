"""The hardware around the control algorithm: sensors, converters and the time that things take."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.hardware.delays import DelayLines, acting, delayed, put
from pvlvrt_compliance.hardware.sensors import SensorParams, measure
from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.measured import Measured


class Hardware(NamedTuple):
    """All of it. A run without has ideal sensors, and its modulating signal acts one sample later."""

    sensors: SensorParams
    lines: DelayLines
    random: NDArray[np.float64]  # standard normal numbers, shape (samples or 1, len(sensors.CHANNELS))


@kernel
def seen_at(y: Measured, u_zero: float, k: int, hw: Hardware | None) -> Measured:
    """What the controller reads in its sample ``k``, from 0."""
    if hw is None:
        return y
    row = hw.random[k % len(hw.random)]
    return delayed(hw.lines, k, measure(y, u_zero, row, hw.sensors))


@kernel
def acting_as_sampled(latest: complex, k: int, hw: Hardware | None) -> complex:
    """Modulating signal that acts as sample ``k`` is taken; ``latest`` is what was computed from the one before."""
    if hw is None:
        return latest
    return acting(hw.lines, k)


@kernel
def acting_from(m: complex, latest: complex, k: int, hw: Hardware | None) -> complex:
    """Modulating signal that acts from sample ``k`` to the next; ``m`` did as it was taken, ``latest`` came of it."""
    if hw is None:
        return m
    put(hw.lines, k, latest)
    return acting(hw.lines, k)
