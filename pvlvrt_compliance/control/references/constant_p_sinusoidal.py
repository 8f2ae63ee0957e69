"""Strategy 3 of section 2.2, the paper's choice: P constant, Q with a strong oscillation, currents sinusoidal."""

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.vectors import ahead, scaled


@kernel
def constant_p_sinusoidal(u_pos: complex, u_neg: complex, P_ref: float, Q_ref: float) -> complex:
    """Reference of the current vector (A) from the sequences (V), P* (W) and Q* (var) (eq (5)).

    i_P* = (u+ - u-) P* / (|u+|^2 - |u-|^2),  i_Q* = -j (u+ + u-) Q* / (|u+|^2 - |u-|^2)
    """
    D = u_pos.real**2 + u_pos.imag**2 - u_neg.real**2 - u_neg.imag**2
    return scaled(P_ref / D, u_pos - u_neg) - scaled(Q_ref / D, ahead(u_pos + u_neg))
