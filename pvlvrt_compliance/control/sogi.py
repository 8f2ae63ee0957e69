"""Second-order generalised integrator: the resonant cell of the MSOGI-FLL, of the PR regulators and of the relay."""

import math
from typing import NamedTuple

from pvlvrt_compliance.kernel import kernel


class SogiState(NamedTuple):
    """Outputs of one cell on a complex alpha-beta signal; both axes have the same real gains."""

    u: complex  # in-phase output, unit of the input
    qu: complex  # quadrature output, 90 degrees behind, unit of the input


class Rotation(NamedTuple):
    """Turn of a resonator in one sample."""

    c: float  # cosine of w T
    s: float  # sine of w T


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
def rotation(angle: float) -> Rotation:
    """Turn by an angle (rad)."""
    return Rotation(c=math.cos(angle), s=math.sin(angle))


@kernel
def rotate_on(r: Rotation, by: Rotation) -> Rotation:
    """Turn by the sum of two angles: multiples of an angle without further sines."""
    return Rotation(c=r.c * by.c - r.s * by.s, s=r.s * by.c + r.c * by.s)


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
    return SogiState(u=turn.c * x.u - turn.s * q, qu=forcing + turn.s * x.u + turn.c * q)
