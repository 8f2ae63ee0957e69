"""DSC-PLL: sequences by delayed signal cancellation, a quarter of a cycle, and a phase-locked loop."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.control.pll import PllParams, PllState, pll_step
from pvlvrt_compliance.control.pll import locked as pll_locked
from pvlvrt_compliance.control.synchronised import Synchronisation
from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.sogi import harmonic_turns
from pvlvrt_compliance.space_vectors import PI
from pvlvrt_compliance.vectors import ahead, rotation, scaled, turned_back


class DscPllState(NamedTuple):
    """Loop, and the voltage of the last quarter of a cycle."""

    pll: PllState
    k: int  # place in the line of the next sample (-)
    line: NDArray[np.complex128]  # ring of samples, written in place: a run needs one of its own (V)


def samples_of_line(w_min: float, T: float) -> int:
    """Number of samples that hold a quarter of a cycle at the lowest frequency."""
    return math.ceil(0.5 * math.pi / (w_min * T)) + 2


def locked(u_pos: complex, w: float, w_min: float, T: float) -> DscPllState:
    """State of a synchronisation that has long seen a balanced grid, at ``u_pos`` in the next sample."""
    n = samples_of_line(w_min, T)
    line = u_pos * np.exp(1j * w * T * (np.arange(n) - n))
    return DscPllState(pll=pll_locked(u_pos, w), k=0, line=line)


@kernel
def delayed(line: NDArray[np.complex128], k: int, samples: float) -> complex:
    """Signal as it was a number of samples, whole or not, before the one at ``k``: straight lines in between.

    The number is kept within what the line holds: compiled code does not check its indices.
    """
    size = len(line)
    samples = min(max(samples, 1.0), float(size) - 2.0)
    whole = min(max(int(samples), 1), size - 2)  # once more, for a number that is none
    nearer: complex = line[(k - whole) % size]
    farther: complex = line[(k - whole - 1) % size]
    return nearer + scaled(samples - float(whole), farther - nearer)


@kernel
def dsc_pll_step(x: DscPllState, u_g_ab: complex, p: PllParams, T: float) -> tuple[DscPllState, Synchronisation]:
    """Advance the synchronisation by one sample of the grid voltage (V).

    u+- = (u(t) +- j u(t - T_1/4))/2, with a quarter of the estimated cycle T_1 = 2 pi/w: what turns backwards cancels
    in u+, what turns forwards in u-. The loop regulates the q axis of u+ to zero.

    Source: reference [21] of the paper.
    """
    x.line[x.k] = u_g_ab
    j_quarter = ahead(delayed(x.line, x.k, 0.5 * PI / (x.pll.w * T)))
    u_pos, u_neg = scaled(0.5, u_g_ab + j_quarter), scaled(0.5, u_g_ab - j_quarter)
    after = DscPllState(
        pll=pll_step(x.pll, turned_back(u_pos, rotation(x.pll.theta)), p, T),
        k=(x.k + 1) % len(x.line),
        line=x.line,
    )
    return after, Synchronisation(u_pos=u_pos, u_neg=u_neg, w=x.pll.w, turns=harmonic_turns(x.pll.w * T))
