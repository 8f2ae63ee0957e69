"""DDSRF-PLL: decoupled double synchronous reference frame phase-locked loop."""

from typing import NamedTuple

from pvlvrt_compliance.control.pll import PllParams, PllState, pll_step
from pvlvrt_compliance.control.pll import locked as pll_locked
from pvlvrt_compliance.control.synchronised import Synchronisation
from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.sogi import harmonic_turns
from pvlvrt_compliance.vectors import rotation, scaled, turned, turned_back


class DdsrfPllParams(NamedTuple):
    """Loop, and the filters of the decoupling network."""

    pll: PllParams
    ratio: float  # cut-off of the filters by the estimated frequency (-)


class DdsrfPllState(NamedTuple):
    """Loop, and the filtered sequences, each in its own frame."""

    pll: PllState
    pos_dq: complex  # (V)
    neg_dq: complex  # (V)


def locked(u_pos: complex, w: float) -> DdsrfPllState:
    """State of a synchronisation that is locked to a balanced grid."""
    return DdsrfPllState(pll=pll_locked(u_pos, w), pos_dq=complex(abs(u_pos)), neg_dq=0j)


@kernel
def ddsrf_pll_step(
    x: DdsrfPllState, u_g_ab: complex, p: DdsrfPllParams, T: float
) -> tuple[DdsrfPllState, Synchronisation]:
    """Advance the synchronisation by one sample of the grid voltage (V).

    Each frame sees the voltage less the filtered other sequence: u+_dq = (u - u-') exp(-j theta), and likewise u-_dq;
    w_f / (s + w_f) filters both. While the angle is right, the sequences are those of a DSOGI with K = 2 w_f / w.
    The loop regulates the q axis of u+_dq to zero.

    Source: reference [15] of the paper.
    """
    frame = rotation(x.pll.theta)
    u_pos, u_neg = turned(x.pos_dq, frame), turned_back(x.neg_dq, frame)
    pos_dq, neg_dq = turned_back(u_g_ab - u_neg, frame), turned(u_g_ab - u_pos, frame)
    share = p.ratio * x.pll.w * T
    after = DdsrfPllState(
        pll=pll_step(x.pll, pos_dq, p.pll, T),
        pos_dq=x.pos_dq + scaled(share, pos_dq - x.pos_dq),
        neg_dq=x.neg_dq + scaled(share, neg_dq - x.neg_dq),
    )
    return after, Synchronisation(u_pos=u_pos, u_neg=u_neg, w=x.pll.w, turns=harmonic_turns(x.pll.w * T))
