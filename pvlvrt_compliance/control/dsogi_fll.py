"""DSOGI-FLL: frequency and sequences from one quadrature signal generator, without decoupling of harmonics."""

from typing import NamedTuple

from pvlvrt_compliance.control.fll import FllParams, fll_step
from pvlvrt_compliance.control.synchronised import Synchronisation
from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.sogi import SogiState, harmonic_turns, in_steady_state, sequences, sogi_step
from pvlvrt_compliance.vectors import scaled


class DsogiFllState(NamedTuple):
    """The DSOGI-QSG of the fundamental, and the estimated frequency."""

    h1: SogiState
    w: float  # w0', estimated angular frequency (rad/s)


def locked(u_pos: complex, w: float) -> DsogiFllState:
    """State of a synchronisation that is locked to a balanced, clean grid."""
    return DsogiFllState(h1=in_steady_state(u_pos), w=w)


@kernel
def dsogi_fll_step(x: DsogiFllState, u_g_ab: complex, p: FllParams, T: float) -> tuple[DsogiFllState, Synchronisation]:
    """Advance the synchronisation by one sample of the grid voltage (V).

    u'/u = K w s / (s^2 + K w s + w^2),  qu'/u = K w^2 / (s^2 + K w s + w^2),  u+- = (u' +- j qu')/2

    Source: reference [16] of the paper, Fig. 3 with the fundamental cell alone.
    """
    e = u_g_ab - x.h1.u
    turns = harmonic_turns(x.w * T)
    u_pos, u_neg = sequences(x.h1)
    after = DsogiFllState(h1=sogi_step(x.h1, scaled(p.K, e), turns.h1), w=fll_step(x.h1, e, x.w, p, T))
    return after, Synchronisation(u_pos=u_pos, u_neg=u_neg, w=x.w, turns=turns)
