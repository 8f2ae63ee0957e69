"""Delays around the controller, in whole control periods: of what it reads, and of what it computes."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import kernel, plain
from pvlvrt_compliance.measured import Measured
from pvlvrt_compliance.places import numbered


class DelayParams(NamedTuple):
    """How many periods."""

    measurement: int  # from sample to controller (-)
    computation: int  # from sample to the period in which the modulating signal acts; 1: the next (-)


class ReadPlaces(NamedTuple):
    """Where in a row stands what is read."""

    u_g_ab: int
    i_ab: int
    dc: int  # v_dc + j i_pv


_AT = numbered(ReadPlaces)


class DelayLines(NamedTuple):
    """Rings of what is under way: period n writes entry n modulo their length, the next entry is the oldest."""

    read: NDArray[np.complex128]  # shape (measurement + 1, len(ReadPlaces._fields))
    m: NDArray[np.complex128]  # shape (computation + 1,): modulating signals


def filled(p: DelayParams, y: Measured, m: complex) -> DelayLines:
    """Delay lines in which the same has been under way for long."""
    row = np.empty(len(_AT), dtype=np.complex128)
    plain(put_read)(row, y)
    return DelayLines(read=np.tile(row, (p.measurement + 1, 1)), m=np.full(p.computation + 1, m))


@kernel
def put_read(row: NDArray[np.complex128], y: Measured) -> None:
    """Write what is read."""
    row[_AT.u_g_ab] = y.u_g_ab
    row[_AT.i_ab] = y.i_ab
    row[_AT.dc] = complex(y.v_dc, y.i_pv)


@kernel
def delayed(lines: DelayLines, n: int, y: Measured) -> Measured:
    """What was measured some periods before period ``n``."""
    size = len(lines.read)
    put_read(lines.read[n % size], y)
    row = lines.read[(n + 1) % size]
    return Measured(u_g_ab=row[_AT.u_g_ab], i_ab=row[_AT.i_ab], v_dc=row[_AT.dc].real, i_pv=row[_AT.dc].imag)


@kernel
def put(lines: DelayLines, n: int, m: complex) -> None:
    """Send off the modulating signal that was computed from the sample at the beginning of period ``n``."""
    lines.m[n % len(lines.m)] = m


@kernel
def acting(lines: DelayLines, n: int) -> complex:
    """Modulating signal that acts in period ``n``, as far as it has been computed."""
    m: complex = lines.m[(n + 1) % len(lines.m)]
    return m
