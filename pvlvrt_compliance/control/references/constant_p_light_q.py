"""Strategy 2 of section 2.2: P constant, Q with a light oscillation, currents lightly distorted."""

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.vectors import ahead, scaled


@kernel
def constant_p_light_q(u_pos: complex, u_neg: complex, P_ref: float, Q_ref: float) -> complex:
    """Reference of the current vector (A) from the sequences (V), P* (W) and Q* (var).

    i_P* = P* u+ / (u . u+),  i_Q* = -j Q* u / |u|^2,  u = u+ + u-

    i_P* is along the positive sequence; i_Q* is in quadrature with the voltage, so that it moves no active power.
    With r = |u-|/|u+|, Q swings by at most P* r / sqrt(1 - r^2), against P* 2 r / (1 - r^2) in strategy 3.
    """
    u = u_pos + u_neg
    along = u.real * u_pos.real + u.imag * u_pos.imag
    return scaled(P_ref / along, u_pos) - scaled(Q_ref / (u.real**2 + u.imag**2), ahead(u))
