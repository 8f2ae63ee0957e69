"""Current references for constant active power with sinusoidal currents (eq (5), strategy 3 of section 2.2)."""

from typing import NamedTuple

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.vectors import ahead, length, scaled


class CurrentReferenceParams(NamedTuple):
    """Guard of the division in eq (5)."""

    u_pos_less_neg_min: float  # below this |u+| - |u-| the reference is zero (V)


@kernel
def current_references(
    u_pos: complex, u_neg: complex, P_ref: float, Q_ref: float, p: CurrentReferenceParams
) -> complex:
    """Reference of the current vector (A) from the sequences (V), P* (W) and Q* (var).

    i_P* = (u+ - u-) P* / (|u+|^2 - |u-|^2),  i_Q* = -j (u+ + u-) Q* / (|u+|^2 - |u-|^2)
    """
    if length(u_pos) - length(u_neg) < p.u_pos_less_neg_min:
        return 0j
    D = u_pos.real**2 + u_pos.imag**2 - u_neg.real**2 - u_neg.imag**2
    return scaled(P_ref / D, u_pos - u_neg) - scaled(Q_ref / D, ahead(u_pos + u_neg))
