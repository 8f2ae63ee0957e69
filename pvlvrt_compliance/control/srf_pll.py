"""SRF-PLL with a positive- and negative-sequence detector (PNSD) in dq axes."""

from typing import NamedTuple

from pvlvrt_compliance.control.pll import PllParams, PllState, pll_step
from pvlvrt_compliance.control.pll import locked as pll_locked
from pvlvrt_compliance.control.synchronised import Synchronisation
from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.sogi import SogiState, harmonic_turns, in_steady_state, sogi_step
from pvlvrt_compliance.vectors import Rotation, rotate_on, rotation, scaled, turned, turned_back


class SrfPllParams(NamedTuple):
    """Loop, and the notch of the detector."""

    pll: PllParams
    K: float  # twice the damping of the notch (-)


class SrfPllState(NamedTuple):
    """Loop, and what swings at twice the frequency in each frame."""

    pll: PllState
    pos_2w: SogiState  # in the frame of the positive sequence (V)
    neg_2w: SogiState  # in the frame of the negative sequence (V)


def locked(u_pos: complex, w: float, p: SrfPllParams) -> SrfPllState:
    """State of a synchronisation that is locked to a balanced grid.

    What stands charges the band-pass with K times itself in its quadrature output. In the frame of the negative
    sequence the positive one turns forwards at twice the frequency.
    """
    amplitude = abs(u_pos)
    neg_2w = u_pos**2 / amplitude if amplitude > 0 else 0j
    return SrfPllState(
        pll=pll_locked(u_pos, w),
        pos_2w=SogiState(u=0j, qu=complex(p.K * amplitude)),
        neg_2w=in_steady_state(neg_2w),
    )


@kernel
def band_step(x: SogiState, u_dq: complex, K: float, turn: Rotation) -> SogiState:
    """Advance the band-pass around twice the frequency by one sample; the notch is what it leaves."""
    return sogi_step(x, scaled(K, u_dq - x.u), turn)


@kernel
def srf_pll_step(x: SrfPllState, u_g_ab: complex, p: SrfPllParams, T: float) -> tuple[SrfPllState, Synchronisation]:
    """Advance the synchronisation by one sample of the grid voltage (V).

    In a frame that turns with one sequence that one stands and the other turns at 2w: a notch there,
    (s^2 + (2w)^2) / (s^2 + 2 zeta (2w) s + (2w)^2), leaves the one. The loop regulates the q axis of the notched
    positive sequence to zero.

    Source: references [12] to [14] of the paper name the parts; the notch is the choice of this project.
    """
    frame = rotation(x.pll.theta)
    turns = harmonic_turns(x.pll.w * T)
    turn_2w = rotate_on(turns.h1, turns.h1)
    pos, neg = turned_back(u_g_ab, frame), turned(u_g_ab, frame)
    u_pos_dq, u_neg_dq = pos - x.pos_2w.u, neg - x.neg_2w.u
    after = SrfPllState(
        pll=pll_step(x.pll, u_pos_dq, p.pll, T),
        pos_2w=band_step(x.pos_2w, pos, p.K, turn_2w),
        neg_2w=band_step(x.neg_2w, neg, p.K, turn_2w),
    )
    u_pos, u_neg = turned(u_pos_dq, frame), turned_back(u_neg_dq, frame)
    return after, Synchronisation(u_pos=u_pos, u_neg=u_neg, w=x.pll.w, turns=turns)
