"""Delays around the controller, in whole control periods: of what it reads, and of what it computes."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.control.controller import Measured
from pvlvrt_compliance.kernel import kernel


class DelayParams(NamedTuple):
    """How many periods."""

    measurement: int  # from sample to controller (-)
    computation: int  # from sample to the period in which the modulating signal acts; 1: the next (-)


class DelayLines(NamedTuple):
    """Rings of what is under way: period n writes entry n modulo their length, the next entry is the oldest."""

    read: NDArray[np.complex128]  # shape (measurement + 1, 3): u_g_ab, i_ab, v_dc + j i_pv
    m: NDArray[np.complex128]  # shape (computation + 1,): modulating signals


def filled(p: DelayParams, y: Measured, m: complex) -> DelayLines:
    """Delay lines in which the same has been under way for long."""
    row = np.array([y.u_g_ab, y.i_ab, complex(y.v_dc, y.i_pv)])
    return DelayLines(read=np.tile(row, (p.measurement + 1, 1)), m=np.full(p.computation + 1, m))


@kernel
def delayed(lines: DelayLines, n: int, y: Measured) -> Measured:
    """What was measured some periods before period ``n``."""
    size = len(lines.read)
    lines.read[n % size, 0] = y.u_g_ab
    lines.read[n % size, 1] = y.i_ab
    lines.read[n % size, 2] = complex(y.v_dc, y.i_pv)
    row = lines.read[(n + 1) % size]
    return Measured(u_g_ab=row[0], i_ab=row[1], v_dc=row[2].real, i_pv=row[2].imag)


@kernel
def put(lines: DelayLines, n: int, m: complex) -> None:
    """Send off the modulating signal that was computed from the sample at the beginning of period ``n``."""
    lines.m[n % len(lines.m)] = m


@kernel
def acting(lines: DelayLines, n: int) -> complex:
    """Modulating signal that acts in period ``n``, as far as it has been computed."""
    m: complex = lines.m[(n + 1) % len(lines.m)]
    return m
