"""Line: L filter and grid impedance in series, and the voltage at the point of common coupling between them."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.vectors import scaled


class LineParams(NamedTuple):
    """Exact one-step solution of (L + L_g) di/dt = u_inv - e - (R + R_g) i, and the divider at the PCC."""

    decay: float  # what is left of the current after one plant step (-)
    gain: float  # current per volt across the line after one plant step (A/V)
    k_u: float  # share of u_inv at the PCC (-)
    k_e: float  # share of the source at the PCC (-)
    k_i: float  # volts at the PCC per ampere (ohm)


class LineTable(NamedTuple):
    """Lines by the entry of the grid's breakpoints."""

    decay: NDArray[np.float64]
    gain: NDArray[np.float64]
    k_u: NDArray[np.float64]
    k_e: NDArray[np.float64]
    k_i: NDArray[np.float64]


@kernel
def line_at(k: int, table: LineTable) -> LineParams:
    """Line that goes with an entry of the grid's breakpoints."""
    return LineParams(decay=table.decay[k], gain=table.gain[k], k_u=table.k_u[k], k_e=table.k_e[k], k_i=table.k_i[k])


@kernel
def line_step(i: complex, u_inv: complex, e: complex, p: LineParams) -> complex:
    """Current after one plant step (A); voltages at the middle of the step (V)."""
    return scaled(p.decay, i) + scaled(p.gain, u_inv - e)


@kernel
def pcc_voltage(i: complex, u_inv: complex, e: complex, p: LineParams) -> complex:
    """Voltage at the PCC (V): u_PCC = e + R_g i + L_g di/dt, with di/dt from the whole line."""
    return scaled(p.k_u, u_inv) + scaled(p.k_e, e) + scaled(p.k_i, i)


def design(L: float, R: float, L_g: float, R_g: float, T_S: float) -> LineParams:
    """Parameters from the filter's and the grid's inductance (H) and resistance (ohm), and the plant step (s)."""
    L_t, R_t = L + L_g, R + R_g
    decay = math.exp(-R_t * T_S / L_t)
    gain = -math.expm1(-R_t * T_S / L_t) / R_t if R_t > 0 else T_S / L_t
    k_u = L_g / L_t
    return LineParams(decay=decay, gain=gain, k_u=k_u, k_e=1 - k_u, k_i=R_g - k_u * R_t)
