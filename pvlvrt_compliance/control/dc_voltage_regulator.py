"""PI regulator of the DC-link voltage, with limit, anti-windup and bumpless transfer (section 3, Table 3)."""

from typing import NamedTuple

from pvlvrt_compliance.kernel import kernel


class DcVoltageRegulatorParams(NamedTuple):
    """Gains of Table 3."""

    K_P: float  # proportional gain (W/V)
    K_I: float  # integral gain (W/(V s))


class DcVoltageRegulatorState(NamedTuple):
    """Integral part."""

    integral: float  # (W)


def settled(P_ref: float, v_dc: float, v_ref: float, p: DcVoltageRegulatorParams) -> DcVoltageRegulatorState:
    """State that puts out ``P_ref`` (W) at this voltage (V)."""
    return DcVoltageRegulatorState(integral=P_ref - p.K_P * (v_dc - v_ref))


@kernel
def dc_voltage_regulator_step(
    x: DcVoltageRegulatorState, v_dc: float, v_ref: float, P_limit: float, p: DcVoltageRegulatorParams, T: float
) -> tuple[DcVoltageRegulatorState, float, bool]:
    """Advance by one sample; return the state, P* (W) and whether P* sits at its upper limit.

    P* = K_P (v_DC - v*_DC) + K_I integral, within 0 and ``P_limit`` (S_nom, or P_fault during a fault). The integral
    follows the limited output, so it never winds up, and P* goes on without a step when a limit is lifted.
    """
    e = v_dc - v_ref
    wanted = p.K_P * e + x.integral
    P_ref = min(max(wanted, 0.0), P_limit)
    after = DcVoltageRegulatorState(integral=P_ref - p.K_P * e + p.K_I * e * T)
    return after, P_ref, wanted > P_limit
