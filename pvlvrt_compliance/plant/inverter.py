"""Inverter, averaged over a carrier period."""

import math
from typing import NamedTuple

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.vectors import length, scaled

K_PWM = 2 / 3
"""Inverter gain of Table 2: u_inv = K_PWM v_DC m."""
M_MAX = 3 / (2 * math.sqrt(2))
"""End of the linear range with zero-sequence injection, |u_inv| = v_DC / sqrt(2)."""


class Bridge(NamedTuple):
    """What the bridge does at an instant."""

    u: complex  # u_inv (V)
    i_dc: float  # current taken from the DC link (A)


@kernel
def limit_modulation(m: complex) -> complex:
    """Modulating signal within the linear range, its direction kept."""
    size = length(m)
    return m if size <= M_MAX else scaled(M_MAX / size, m)


@kernel
def modulated(m: complex, i: complex, v_dc: float) -> Bridge:
    """Bridge that follows the modulating signal: u_inv = 2/3 v_DC m, i_DC = Re(u_inv conj(i)) / v_DC."""
    return Bridge(u=scaled(K_PWM * v_dc, m), i_dc=K_PWM * (m.real * i.real + m.imag * i.imag))
