"""Strategy 1 of section 2.2: P and Q constant at every instant, currents distorted."""

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.vectors import ahead, scaled


@kernel
def constant_p_q(u_pos: complex, u_neg: complex, P_ref: float, Q_ref: float) -> complex:
    """Reference of the current vector (A) from the sequences (V), P* (W) and Q* (var).

    i* = (P* - j Q*) u / |u|^2,  u = u+ + u-

    Since |u| swings at 2w, the currents hold the orders 1, 3, 5, ... of positive sequence, each |u-|/|u+| of the one
    before, and no negative sequence of the fundamental.
    """
    u = u_pos + u_neg
    u2 = u.real**2 + u.imag**2
    return scaled(P_ref / u2, u) - scaled(Q_ref / u2, ahead(u))
