"""Current References Generator (section 2.2): chooses the power strategy and guards its division."""

from typing import NamedTuple

from pvlvrt_compliance.control.references.balanced import balanced
from pvlvrt_compliance.control.references.constant_p_light_q import constant_p_light_q
from pvlvrt_compliance.control.references.constant_p_q import constant_p_q
from pvlvrt_compliance.control.references.constant_p_sinusoidal import constant_p_sinusoidal
from pvlvrt_compliance.control.references.constant_q import constant_q
from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.vectors import length

CONSTANT_P_Q, CONSTANT_P_LIGHT_Q, CONSTANT_P_SINUSOIDAL, CONSTANT_Q, BALANCED = range(1, 6)
"""Strategies by their number in section 2.2."""


class CurrentReferenceParams(NamedTuple):
    """Strategy, and the guard of its division."""

    strategy: int  # number in section 2.2 (-)
    u_pos_less_neg_min: float  # below this |u+| - |u-| the reference is zero (V)


@kernel
def current_references(
    u_pos: complex, u_neg: complex, P_ref: float, Q_ref: float, p: CurrentReferenceParams
) -> complex:
    """Reference of the current vector (A) from the sequences (V), P* (W) and Q* (var).

    |u+| - |u-| is the short half axis of the voltage: every strategy but the fifth divides by it or more.
    """
    if length(u_pos) - length(u_neg) < p.u_pos_less_neg_min:
        return 0j
    if p.strategy == CONSTANT_P_Q:
        return constant_p_q(u_pos, u_neg, P_ref, Q_ref)
    if p.strategy == CONSTANT_P_LIGHT_Q:
        return constant_p_light_q(u_pos, u_neg, P_ref, Q_ref)
    if p.strategy == CONSTANT_Q:
        return constant_q(u_pos, u_neg, P_ref, Q_ref)
    if p.strategy == BALANCED:
        return balanced(u_pos, P_ref, Q_ref)
    return constant_p_sinusoidal(u_pos, u_neg, P_ref, Q_ref)
