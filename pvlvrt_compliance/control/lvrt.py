"""Fault detector and LVRT logic: what power to ask for during a sag (Figs 5 and 6(b), eqs (7) to (10))."""

import math
from typing import NamedTuple

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.vectors import length


class LvrtParams(NamedTuple):
    """Ratings and the curve of eq (9)."""

    S_nom: float  # nominal apparent power (VA)
    u_nom: float  # sqrt(3) u_gnom, nominal length of the voltage vector (V)
    V_detect: float  # a fault is flagged below it (pu)
    V_full: float  # full reactive power at and below it (pu)
    Q_full: float  # reactive power at and below V_full (pu of S_nom)
    Q_set: float  # reactive power in normal operation (var); 0 in the paper


class LvrtOrder(NamedTuple):
    """References for the power controllers."""

    V_fault: float  # eq (7) (pu)
    fault: bool  # Fault Signal
    P_limit: float  # upper limit of P* (W): S_nom, or P_fault during a fault
    Q_ref: float  # Q* (var)


@kernel
def reactive_power_of_voltage(V_fault: float, p: LvrtParams) -> float:
    """Reactive power asked for by eq (9) (var): 0 from V_detect on, a straight line, a plateau below V_full."""
    slope = p.Q_full / (p.V_detect - p.V_full)
    return p.S_nom * min(max(slope * (p.V_detect - V_fault), 0.0), p.Q_full)


@kernel
def lvrt_step(u_pos: complex, u_neg: complex, p: LvrtParams) -> LvrtOrder:
    """Decide between normal and faulty operation from the sequences of the grid voltage (V).

    The disconnection of Fig. 5 for sags longer than the envelope is the plant's undervoltage relay.
    """
    V_pos = length(u_pos) / p.u_nom
    V_neg = length(u_neg) / p.u_nom
    if V_pos >= p.V_detect:
        return LvrtOrder(V_fault=V_pos, fault=False, P_limit=p.S_nom, Q_ref=p.Q_set)
    S_fault = max(V_pos - V_neg, 0.0) * p.S_nom  # (8)
    Q = min(reactive_power_of_voltage(V_pos, p), S_fault)  # (9), clipped as in Fig. 6(b)
    P_fault = math.sqrt(max(S_fault**2 - Q**2, 0.0))  # (10)
    return LvrtOrder(V_fault=V_pos, fault=True, P_limit=P_fault, Q_ref=Q)
