"""Limit of the modulating signal, and the feedforward of the grid voltage that the paper does not name."""

from typing import NamedTuple

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.vectors import length, scaled


class ModulatorParams(NamedTuple):
    """Scale and limit of the modulating signal."""

    K_PWM: float  # inverter gain per volt of v_DC, 2/3 (-)
    m_max: float  # end of the linear range with zero-sequence injection, |u_inv| = v_DC/sqrt(2) (-)
    feedforward: float  # share of the grid voltage added to the modulating signal (-)


@kernel
def modulate(m: complex, u_g_ab: complex, v_dc: float, p: ModulatorParams) -> complex:
    """Modulating signal that is handed to the PWM: with feedforward, its length limited."""
    if p.feedforward != 0.0:
        m = m + scaled(p.feedforward / (p.K_PWM * max(v_dc, 1.0)), u_g_ab)
    size = length(m)
    return m if size <= p.m_max else scaled(p.m_max / size, m)
