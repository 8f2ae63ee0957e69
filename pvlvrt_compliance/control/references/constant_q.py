"""Strategy 4 of section 2.2: Q constant, P with a strong oscillation, currents sinusoidal."""

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.vectors import ahead, scaled


@kernel
def constant_q(u_pos: complex, u_neg: complex, P_ref: float, Q_ref: float) -> complex:
    """Reference of the current vector (A) from the sequences (V), P* (W) and Q* (var).

    i_P* = (u+ + u-) P* / (|u+|^2 + |u-|^2),  i_Q* = -j (u+ - u-) Q* / (|u+|^2 - |u-|^2)
    """
    pos2 = u_pos.real**2 + u_pos.imag**2
    neg2 = u_neg.real**2 + u_neg.imag**2
    return scaled(P_ref / (pos2 + neg2), u_pos + u_neg) - scaled(Q_ref / (pos2 - neg2), ahead(u_pos - u_neg))
