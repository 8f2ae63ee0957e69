"""Phase-locked loop on a positive-sequence vector: the PI regulator that all PLLs of this folder share."""

import math
from typing import NamedTuple

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.space_vectors import PI
from pvlvrt_compliance.vectors import length


class PllParams(NamedTuple):
    """Gains of the loop, and its guards."""

    K_P: float  # proportional gain ((rad/s)/rad)
    K_I: float  # integral gain ((rad/s^2)/rad)
    w_min: float  # lower guard of the frequency (rad/s)
    w_max: float  # upper guard of the frequency (rad/s)
    u_min: float  # floor of |u+| in the normalisation (V)


class PllState(NamedTuple):
    """Frame of the loop."""

    theta: float  # angle of the frame at the next sample, -pi to pi (rad)
    w: float  # integral part: the estimated angular frequency (rad/s)


@kernel
def pll_step(x: PllState, u_pos_dq: complex, p: PllParams, T: float) -> PllState:
    """Advance the loop by one sample of the positive sequence (V), seen in its frame.

    e = u_q / |u+|,  dw/dt = K_I e,  dtheta/dt = w + K_P e

    Normalised, e is the sine of the angle by which the frame lags. The estimate is the integral part alone, so a jump
    of the angle moves the frame at once and the frequency hardly.
    """
    e = u_pos_dq.imag / max(length(u_pos_dq), p.u_min)
    rate = min(max(x.w + p.K_P * e, p.w_min), p.w_max)
    theta = x.theta + rate * T
    return PllState(
        theta=theta - 2.0 * PI if theta > PI else theta,
        w=min(max(x.w + p.K_I * e * T, p.w_min), p.w_max),
    )


def locked(u_pos: complex, w: float) -> PllState:
    """State of a loop that is locked to a positive sequence."""
    return PllState(theta=math.atan2(u_pos.imag, u_pos.real), w=w)


def design(
    bandwidth_hz: float, damping: float, frequency_min_hz: float, frequency_max_hz: float, u_nominal_ab: float
) -> PllParams:
    """Parameters from the natural frequency (Hz) and damping (-) of the loop, guards (Hz) and |u_ab| nominal (V).

    Linearised, the angle follows with (2 zeta w_n s + w_n^2) / (s^2 + 2 zeta w_n s + w_n^2): K_P = 2 zeta w_n,
    K_I = w_n^2. The normalisation stops at 1 % of the nominal voltage.
    """
    w_n = 2 * math.pi * bandwidth_hz
    return PllParams(
        K_P=2 * damping * w_n,
        K_I=w_n**2,
        w_min=2 * math.pi * frequency_min_hz,
        w_max=2 * math.pi * frequency_max_hz,
        u_min=0.01 * u_nominal_ab,
    )
