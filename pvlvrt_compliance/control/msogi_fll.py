"""MSOGI-FLL: grid frequency and sequences of the fundamental, free of harmonics (section 2.1, Figs 2 and 3)."""

from typing import NamedTuple

from pvlvrt_compliance.control.fll import FllParams, fll_step
from pvlvrt_compliance.control.synchronised import Synchronisation
from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.sogi import (
    SogiState,
    at_rest,
    harmonic_turns,
    in_steady_state,
    sequences,
    sogi_step,
)
from pvlvrt_compliance.vectors import scaled


class MsogiFllState(NamedTuple):
    """One DSOGI-QSG a harmonic, and the estimated frequency."""

    h1: SogiState
    h5: SogiState
    h7: SogiState
    h11: SogiState
    h13: SogiState
    w: float  # w0', estimated angular frequency (rad/s)


def locked(u_pos: complex, w: float) -> MsogiFllState:
    """State of a synchronisation that is locked to a balanced, clean grid."""
    rest = at_rest()
    return MsogiFllState(h1=in_steady_state(u_pos), h5=rest, h7=rest, h11=rest, h13=rest, w=w)


@kernel
def msogi_fll_step(x: MsogiFllState, u_g_ab: complex, p: FllParams, T: float) -> tuple[MsogiFllState, Synchronisation]:
    """Advance the synchronisation by one sample of the grid voltage (V).

    The decoupling network feeds each cell with the grid voltage less the outputs of all others, so every cell sees
    the same error e = u - sum of all outputs, and (K/i) (i w) = K w: the cells differ only in their turn.
    """
    e = u_g_ab - (x.h1.u + x.h5.u + x.h7.u + x.h11.u + x.h13.u)
    turns = harmonic_turns(x.w * T)
    u_pos, u_neg = sequences(x.h1)
    after = MsogiFllState(
        h1=sogi_step(x.h1, scaled(p.K, e), turns.h1),
        h5=sogi_step(x.h5, scaled(p.K / 5.0, e), turns.h5),
        h7=sogi_step(x.h7, scaled(p.K / 7.0, e), turns.h7),
        h11=sogi_step(x.h11, scaled(p.K / 11.0, e), turns.h11),
        h13=sogi_step(x.h13, scaled(p.K / 13.0, e), turns.h13),
        w=fll_step(x.h1, e, x.w, p, T),
    )
    return after, Synchronisation(u_pos=u_pos, u_neg=u_neg, w=x.w, turns=turns)
