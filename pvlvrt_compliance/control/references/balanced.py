"""Strategy 5 of section 2.2: P and Q both oscillate, currents sinusoidal and balanced."""

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.vectors import ahead, scaled


@kernel
def balanced(u_pos: complex, P_ref: float, Q_ref: float) -> complex:
    """Reference of the current vector (A) from the positive sequence (V), P* (W) and Q* (var).

    i* = (P* - j Q*) u+ / |u+|^2
    """
    pos2 = u_pos.real**2 + u_pos.imag**2
    return scaled(P_ref / pos2, u_pos) - scaled(Q_ref / pos2, ahead(u_pos))
