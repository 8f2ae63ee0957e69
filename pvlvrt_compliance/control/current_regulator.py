"""Proportional-resonant current regulators with harmonic compensators, tuned to the estimated frequency (eq (6))."""

from typing import NamedTuple

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.sogi import SogiState, Turns, at_rest, sogi_step
from pvlvrt_compliance.vectors import Rotation, scaled


class CurrentRegulatorParams(NamedTuple):
    """Gains of Table 3; those of the harmonic compensators are not in the paper."""

    K_P: float  # proportional gain (1/A)
    K_I: float  # gain of the PR at resonance (1/A)
    K_I5: float  # gain of the harmonic compensators at resonance (1/A)
    K_I7: float
    K_I11: float
    K_I13: float
    w_c: float  # cut-off of every resonator (rad/s)
    lead: int  # samples by which each resonator's output leads, for the delay of the loop


class CurrentRegulatorState(NamedTuple):
    """One resonator each; outputs in A, before their gains."""

    h1: SogiState
    h5: SogiState
    h7: SogiState
    h11: SogiState
    h13: SogiState


def at_rest_regulator() -> CurrentRegulatorState:
    """State without any signal."""
    rest = at_rest()
    return CurrentRegulatorState(h1=rest, h5=rest, h7=rest, h11=rest, h13=rest)


@kernel
def resonator_step(x: SogiState, e: complex, k: float, turn: Rotation) -> SogiState:
    """Advance 2 w_c s / (s^2 + 2 w_c s + w^2) by one sample; k = 2 w_c / w."""
    return sogi_step(x, scaled(k, e - x.u), turn)


@kernel
def leading_output(x: SogiState, turn: Rotation, lead: int) -> complex:
    """Output of a resonator as it will be ``lead`` samples ahead if left alone."""
    u, qu = x.u, x.qu
    for _ in range(lead):
        u, qu = scaled(turn.c, u) - scaled(turn.s, qu), scaled(turn.s, u) + scaled(turn.c, qu)
    return u


@kernel
def current_regulator_step(
    x: CurrentRegulatorState, e: complex, w: float, turns: Turns, p: CurrentRegulatorParams
) -> tuple[CurrentRegulatorState, complex]:
    """Advance by one sample of the current error (A); return the state and the modulating signal (-).

    The resonators sit at h w0', from the turns of the synchronisation.
    """
    k = 2.0 * p.w_c / w
    after = CurrentRegulatorState(
        h1=resonator_step(x.h1, e, k, turns.h1),
        h5=resonator_step(x.h5, e, k / 5.0, turns.h5),
        h7=resonator_step(x.h7, e, k / 7.0, turns.h7),
        h11=resonator_step(x.h11, e, k / 11.0, turns.h11),
        h13=resonator_step(x.h13, e, k / 13.0, turns.h13),
    )
    m = scaled(p.K_P, e) + scaled(p.K_I, leading_output(x.h1, turns.h1, p.lead))
    m += scaled(p.K_I5, leading_output(x.h5, turns.h5, p.lead))
    m += scaled(p.K_I7, leading_output(x.h7, turns.h7, p.lead))
    m += scaled(p.K_I11, leading_output(x.h11, turns.h11, p.lead))
    m += scaled(p.K_I13, leading_output(x.h13, turns.h13, p.lead))
    return after, m
