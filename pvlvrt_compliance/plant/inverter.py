"""Inverter, averaged over a carrier period: modulated, or blocked with only its diodes conducting."""

import math
from typing import NamedTuple

from pvlvrt_compliance.kernel import kernel

K_PWM = 2 / 3
"""Inverter gain of Table 2: u_inv = K_PWM v_DC m."""
M_MAX = 3 / (2 * math.sqrt(2))
"""End of the linear range with zero-sequence injection, |u_inv| = v_DC / sqrt(2)."""
# Fundamental of the six-step voltage that conducting diodes put against the current, per volt of v_DC.
_K_DIODES = math.sqrt(6) / math.pi


class Bridge(NamedTuple):
    """What the bridge does at an instant."""

    u: complex  # u_inv (V)
    i_dc: float  # current taken from the DC link (A)


@kernel
def limit_modulation(m: complex) -> complex:
    """Modulating signal within the linear range, its direction kept."""
    length = abs(m)
    return m if length <= M_MAX else m * (M_MAX / length)


@kernel
def modulated(m: complex, i: complex, v_dc: float) -> Bridge:
    """Bridge that follows the modulating signal: u_inv = 2/3 v_DC m, i_DC = Re(u_inv conj(i)) / v_DC."""
    return Bridge(u=K_PWM * v_dc * m, i_dc=K_PWM * (m.real * i.real + m.imag * i.imag))


@kernel
def freewheeling(i: complex, v_dc: float) -> Bridge:
    """Blocked bridge: the diodes oppose the current, which flows back into the DC link.

    Holds while v_DC exceeds the peak of the line-to-line voltage; then no current can build up again.
    """
    length = abs(i)
    if length == 0.0:
        return Bridge(u=0j, i_dc=0.0)
    return Bridge(u=-_K_DIODES * v_dc / length * i, i_dc=-_K_DIODES * length)
