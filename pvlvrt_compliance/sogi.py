"""Second-order generalised integrator: the resonant cell of the MSOGI-FLL, of the PR regulators and of the relay."""

from typing import NamedTuple

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.vectors import Rotation, ahead, rotate_on, rotation, scaled


class SogiState(NamedTuple):
    """Outputs of one cell on a complex alpha-beta signal; both axes have the same real gains."""

    u: complex  # in-phase output, unit of the input
    qu: complex  # quadrature output, 90 degrees behind, unit of the input


class Turns(NamedTuple):
    """Turns of the fundamental and of the harmonics that the controller treats, in one sample."""

    h1: Rotation
    h5: Rotation
    h7: Rotation
    h11: Rotation
    h13: Rotation


def at_rest() -> SogiState:
    """State of a cell that has never seen a signal."""
    return SogiState(u=0j, qu=0j)


def in_steady_state(u: complex) -> SogiState:
    """State of a cell locked to a positive-sequence vector ``u``."""
    return SogiState(u=u, qu=-1j * u)


@kernel
def sequences(x: SogiState) -> tuple[complex, complex]:
    """Positive and negative sequence from a signal and its quadrature (PNSC): (u' +- j qu')/2."""
    j_qu = ahead(x.qu)
    return scaled(0.5, x.u + j_qu), scaled(0.5, x.u - j_qu)


@kernel
def harmonic_turns(angle: float) -> Turns:
    """Turns by 1, 5, 7, 11 and 13 times an angle (rad), from one sine and one cosine."""
    r1 = rotation(angle)
    r2 = rotate_on(r1, r1)
    r4 = rotate_on(r2, r2)
    r5 = rotate_on(r4, r1)
    r7 = rotate_on(r5, r2)
    r11 = rotate_on(r7, r4)
    return Turns(h1=r1, h5=r5, h7=r7, h11=r11, h13=rotate_on(r11, r2))


@kernel
def sogi_step(x: SogiState, forcing: complex, turn: Rotation) -> SogiState:
    """Advance a cell by one sample.

    du'/dt = w (g - qu'),  dqu'/dt = w u',  with g the forcing, held over the sample.

    The DSOGI-QSG of Fig. 3(a) has g = (K/i) (u - u'); the resonators of eq (6) have g = (2 w_c / w) (e - u').
    Discretised by exact rotation about (0, g), so that the undamped pair stays on the unit circle at any step.
    """
    q = x.qu - forcing
    return SogiState(
        u=scaled(turn.c, x.u) - scaled(turn.s, q),
        qu=forcing + scaled(turn.s, x.u) + scaled(turn.c, q),
    )
