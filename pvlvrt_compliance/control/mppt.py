"""Perturb-and-observe tracking of the maximum-power point, and the non-MPPT mode that holds v*_DC (Fig. 6(a))."""

from typing import NamedTuple

from pvlvrt_compliance.kernel import kernel


class MpptParams(NamedTuple):
    """Pace of the search; the paper gives none."""

    period: int  # samples between two perturbations (-)
    dv: float  # size of a perturbation of v*_DC (V)
    v_min: float  # lower limit of v*_DC (V)
    v_max: float  # upper limit of v*_DC (V)


class MpptState(NamedTuple):
    """What the search remembers."""

    v_ref: float  # v*_DC (V)
    direction: float  # +1 or -1 (-)
    k: int  # samples since the last perturbation (-)
    energy: float  # sum of the power samples of the second half of the period (W)
    P_before: float  # mean power after the perturbation before; negative: unknown (W)


def searching_from(v_ref: float) -> MpptState:
    """State at the beginning of a search."""
    return MpptState(v_ref=v_ref, direction=1.0, k=0, energy=0.0, P_before=-1.0)


@kernel
def mppt_step(x: MpptState, v_dc: float, i_pv: float, limited: bool, p: MpptParams) -> MpptState:
    """Advance by one sample of the array's voltage (V) and current (A).

    While P* is limited the array is to the right of its maximum-power point by intent: v*_DC holds, and the search
    begins afresh from it afterwards. Power is averaged over the second half of a period, once the loop has settled.
    """
    if limited:
        return MpptState(v_ref=x.v_ref, direction=x.direction, k=0, energy=0.0, P_before=-1.0)
    half = p.period // 2
    energy = x.energy + (v_dc * i_pv if x.k >= half else 0.0)
    if x.k + 1 < p.period:
        return MpptState(v_ref=x.v_ref, direction=x.direction, k=x.k + 1, energy=energy, P_before=x.P_before)
    P = energy / float(p.period - half)
    direction = -x.direction if x.P_before > P else x.direction
    v_ref = min(max(x.v_ref + direction * p.dv, p.v_min), p.v_max)
    return MpptState(v_ref=v_ref, direction=direction, k=0, energy=0.0, P_before=P)
