"""What every synchronisation gives to the rest of the controller."""

from typing import NamedTuple

from pvlvrt_compliance.sogi import Turns


class Synchronisation(NamedTuple):
    """Fundamental of the grid voltage at the instant of the sample."""

    u_pos: complex  # u+_g1', positive sequence of the fundamental (V)
    u_neg: complex  # u-_g1', negative sequence of the fundamental (V)
    w: float  # w0' (rad/s)
    turns: Turns  # turns of fundamental and harmonics in one sample
