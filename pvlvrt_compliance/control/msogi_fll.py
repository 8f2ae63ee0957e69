"""MSOGI-FLL: grid frequency and sequences of the fundamental, free of harmonics (section 2.1, Figs 2 and 3)."""

import math
from typing import NamedTuple

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.sogi import (
    SogiState,
    Turns,
    at_rest,
    harmonic_turns,
    in_steady_state,
    sequences,
    sogi_step,
)
from pvlvrt_compliance.vectors import scaled


class MsogiFllParams(NamedTuple):
    """Gains of Table 3 and the guards that the paper leaves open."""

    K: float  # gain of the fundamental DSOGI-QSG; harmonic i has K/i (-)
    gamma: float  # gain of the FLL (1/s)
    w_min: float  # lower guard of the frequency (rad/s)
    w_max: float  # upper guard of the frequency (rad/s)
    norm_min: float  # floor of |u'|^2 + |qu'|^2 in the normalisation (V^2)


class MsogiFllState(NamedTuple):
    """One DSOGI-QSG a harmonic, and the estimated frequency."""

    h1: SogiState
    h5: SogiState
    h7: SogiState
    h11: SogiState
    h13: SogiState
    w: float  # w0', estimated angular frequency (rad/s)


class Synchronisation(NamedTuple):
    """What the rest of the controller reads."""

    u_pos: complex  # u+_g1', positive sequence of the fundamental (V)
    u_neg: complex  # u-_g1', negative sequence of the fundamental (V)
    w: float  # w0' (rad/s)
    turns: Turns  # turns of fundamental and harmonics in one sample


def locked(u_pos: complex, w: float) -> MsogiFllState:
    """State of a synchronisation that is locked to a balanced, clean grid."""
    rest = at_rest()
    return MsogiFllState(h1=in_steady_state(u_pos), h5=rest, h7=rest, h11=rest, h13=rest, w=w)


@kernel
def fll_step(x: SogiState, e: complex, w: float, p: MsogiFllParams, T: float) -> float:
    """Advance the frequency-locked loop of Fig. 3(b) by one sample and keep it within its guards.

    dw/dt = -Gamma K w (e . qu') / (|u'|^2 + |qu'|^2)
    """
    norm = x.u.real**2 + x.u.imag**2 + x.qu.real**2 + x.qu.imag**2
    e_qu = e.real * x.qu.real + e.imag * x.qu.imag
    w_next = w - T * p.gamma * p.K * w * e_qu / max(norm, p.norm_min)
    return min(max(w_next, p.w_min), p.w_max)


@kernel
def msogi_fll_step(
    x: MsogiFllState, u_g_ab: complex, p: MsogiFllParams, T: float
) -> tuple[MsogiFllState, Synchronisation]:
    """Advance the synchronisation by one sample of the grid voltage (V).

    The decoupling network feeds each cell with the grid voltage less the outputs of all others, so every cell sees
    the same error e = u - sum of all outputs, and (K/i) (i w) = K w: the cells differ only in their turn.
    """
    e = u_g_ab - (x.h1.u + x.h5.u + x.h7.u + x.h11.u + x.h13.u)
    turns = harmonic_turns(x.w * T)
    u_pos, u_neg = sequences(x.h1)
    after = MsogiFllState(
        h1=sogi_step(x.h1, scaled(p.K, e), turns.h1),
        h5=sogi_step(x.h5, scaled(p.K / 5, e), turns.h5),
        h7=sogi_step(x.h7, scaled(p.K / 7, e), turns.h7),
        h11=sogi_step(x.h11, scaled(p.K / 11, e), turns.h11),
        h13=sogi_step(x.h13, scaled(p.K / 13, e), turns.h13),
        w=fll_step(x.h1, e, x.w, p, T),
    )
    return after, Synchronisation(u_pos=u_pos, u_neg=u_neg, w=x.w, turns=turns)


def design(
    K: float, gamma: float, frequency_min_hz: float, frequency_max_hz: float, u_nominal_ab: float
) -> MsogiFllParams:
    """Parameters from gains (-, 1/s), guards (Hz) and the nominal length of the voltage vector (V).

    The normalisation stops at 1 % of the nominal voltage: below it the loop would only follow rounding.
    """
    return MsogiFllParams(
        K=K,
        gamma=gamma,
        w_min=2 * math.pi * frequency_min_hz,
        w_max=2 * math.pi * frequency_max_hz,
        norm_min=2 * (0.01 * u_nominal_ab) ** 2,
    )
