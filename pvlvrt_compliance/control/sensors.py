"""From the plant to the numbers that the controller computes with: transducers, noise, conversion."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.control.controller import Measured
from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.space_vectors import SQRT2_3, SQRT3_2

CHANNELS = ("u_a", "u_b", "u_c", "i_a", "i_b", "i_c", "v_dc", "i_pv")
"""Signals that are measured, in the order of every array here."""


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
    random : array, shape (8,)
        Standard normal numbers, one a channel.
    """
    u, across_u = SQRT2_3 * y.u_g_ab.real, SQRT2_3 * SQRT3_2 * y.u_g_ab.imag
    i, across_i = SQRT2_3 * y.i_ab.real, SQRT2_3 * SQRT3_2 * y.i_ab.imag
    return Measured(
        u_g_ab=space_vector(
            converted(u + u_zero, 0, random[0], p),
            converted(-0.5 * u + across_u + u_zero, 1, random[1], p),
            converted(-0.5 * u - across_u + u_zero, 2, random[2], p),
        ),
        i_ab=space_vector(
            converted(i, 3, random[3], p),
            converted(-0.5 * i + across_i, 4, random[4], p),
            converted(-0.5 * i - across_i, 5, random[5], p),
        ),
        v_dc=converted(y.v_dc, 6, random[6], p),
        i_pv=converted(y.i_pv, 7, random[7], p),
    )
