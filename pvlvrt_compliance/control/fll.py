"""Frequency-locked loop on a quadrature signal generator (section 2.1, Fig. 3(b))."""

import math
from typing import NamedTuple

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.sogi import SogiState


class FllParams(NamedTuple):
    """Gains of Table 3 and the guards that the paper leaves open."""

    K: float  # gain of the fundamental DSOGI-QSG; harmonic i has K/i (-)
    gamma: float  # gain of the FLL (1/s)
    w_min: float  # lower guard of the frequency (rad/s)
    w_max: float  # upper guard of the frequency (rad/s)
    norm_min: float  # floor of |u'|^2 + |qu'|^2 in the normalisation (V^2)


@kernel
def fll_step(x: SogiState, e: complex, w: float, p: FllParams, T: float) -> float:
    """Advance the frequency-locked loop of Fig. 3(b) by one sample and keep it within its guards.

    dw/dt = -Gamma K w (e . qu') / (|u'|^2 + |qu'|^2)
    """
    norm = x.u.real**2 + x.u.imag**2 + x.qu.real**2 + x.qu.imag**2
    e_qu = e.real * x.qu.real + e.imag * x.qu.imag
    w_next = w - T * p.gamma * p.K * w * e_qu / max(norm, p.norm_min)
    return min(max(w_next, p.w_min), p.w_max)


def design(K: float, gamma: float, frequency_min_hz: float, frequency_max_hz: float, u_nominal_ab: float) -> FllParams:
    """Parameters from gains (-, 1/s), guards (Hz) and the nominal length of the voltage vector (V).

    The normalisation stops at 1 % of the nominal voltage: below it the loop would only follow rounding.
    """
    return FllParams(
        K=K,
        gamma=gamma,
        w_min=2 * math.pi * frequency_min_hz,
        w_max=2 * math.pi * frequency_max_hz,
        norm_min=2 * (0.01 * u_nominal_ab) ** 2,
    )
