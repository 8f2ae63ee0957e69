"""From the plant to the numbers that the controller computes with: transducers, noise, conversion."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.measured import Measured
from pvlvrt_compliance.places import numbered
from pvlvrt_compliance.space_vectors import SQRT2_3, SQRT3_2


class Channels(NamedTuple):
    """Signals that are measured: the place of each in every array here."""

    u_a: int
    u_b: int
    u_c: int
    i_a: int
    i_b: int
    i_c: int
    v_dc: int
    i_pv: int


CHANNELS = Channels._fields
_AT = numbered(Channels)


class SensorParams(NamedTuple):
    """One entry for each of `CHANNELS`, in V and A."""

    gain: NDArray[np.float64]  # (-)
    offset: NDArray[np.float64]  # (V, A)
    noise: NDArray[np.float64]  # standard deviation (V, A)
    step: NDArray[np.float64]  # resolution of the conversion, 0: none (V, A)
    low: NDArray[np.float64]  # ends of its range (V, A)
    high: NDArray[np.float64]


@kernel
def converted(value: float, k: int, random: float, p: SensorParams) -> float:
    """Number that stands for a value of channel ``k``; ``random`` is a standard normal number."""
    seen: float = p.gain[k] * value + p.offset[k] + p.noise[k] * random
    seen = min(max(seen, p.low[k]), p.high[k])
    if p.step[k] > 0.0:
        seen = p.step[k] * np.floor(seen / p.step[k] + 0.5)
    return seen


@kernel
def space_vector(a: float, b: float, c: float) -> complex:
    """Clarke transform, eq (1)."""
    return complex(SQRT2_3 * (a - 0.5 * b - 0.5 * c), SQRT2_3 * SQRT3_2 * (b - c))


@kernel
def measure(y: Measured, u_zero: float, random: NDArray[np.float64], p: SensorParams) -> Measured:
    """What the controller reads, from what there is.

    Parameters
    ----------
    y : Measured
        True values (V, A).
    u_zero : float
        Zero sequence of the grid voltage, which the transducers see, too (V).
    random : array, shape (len(CHANNELS),)
        Standard normal numbers, one a channel.
    """
    u, across_u = SQRT2_3 * y.u_g_ab.real, SQRT2_3 * SQRT3_2 * y.u_g_ab.imag
    i, across_i = SQRT2_3 * y.i_ab.real, SQRT2_3 * SQRT3_2 * y.i_ab.imag
    return Measured(
        u_g_ab=space_vector(
            converted(u + u_zero, _AT.u_a, random[_AT.u_a], p),
            converted(-0.5 * u + across_u + u_zero, _AT.u_b, random[_AT.u_b], p),
            converted(-0.5 * u - across_u + u_zero, _AT.u_c, random[_AT.u_c], p),
        ),
        i_ab=space_vector(
            converted(i, _AT.i_a, random[_AT.i_a], p),
            converted(-0.5 * i + across_i, _AT.i_b, random[_AT.i_b], p),
            converted(-0.5 * i - across_i, _AT.i_c, random[_AT.i_c], p),
        ),
        v_dc=converted(y.v_dc, _AT.v_dc, random[_AT.v_dc], p),
        i_pv=converted(y.i_pv, _AT.i_pv, random[_AT.i_pv], p),
    )
