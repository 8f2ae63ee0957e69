"""What a synchronisation makes of harmonics, to first order: transfer functions of its filters and its loop."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.control.parameters import ControllerParameters
from validation.simulator.loops import ORDERS

Harmonics = dict[int, complex]
"""Space vectors as a part of the fundamental, by signed order: -5 turns backwards, five times as fast."""

_P = ControllerParameters()
_ANGLES = np.linspace(0, 2 * np.pi, 1440, endpoint=False)


class Passed(NamedTuple):
    """What of a harmonic arrives where."""

    positive: complex  # in u+ (-)
    negative: complex  # in u- (-)
    error: complex  # in the error of the loop (-)


def generators(orders: tuple[int, ...], K: float, h: float) -> Passed:
    """DSOGI-QSGs that decouple each other: u'_i = G_i e, e = u - sum of all u'_i, G_i = K w s / (s^2 + (i w)^2)."""
    if abs(h) in orders and abs(h) != 1:
        return Passed(0j, 0j, 0j)
    e = 1 / (1 + sum(1j * K * h / (i * i - h * h) for i in orders))
    u = 1j * K * h / (1 - h * h) * e
    return Passed(u * (1 + 1 / h) / 2, u * (1 - 1 / h) / 2, e)


def notch(n: float) -> complex:
    """The srf-pll's notch at twice the frequency, at n times the frequency."""
    return (4 - n * n) / (4 - n * n + 4j * _P.pnsd_notch_damping * n)


def passed(name: str, h: float) -> Passed:
    """What a synchronisation passes at an order ``h``, whole or not (not 1 or -1)."""
    if name == "srf-pll":
        return Passed(notch(h - 1), notch(h + 1), notch(h - 1))
    if name == "dsc-pll":
        quarter = 1j * np.exp(-0.5j * np.pi * h)
        return Passed((1 + quarter) / 2, (1 - quarter) / 2, (1 + quarter) / 2)
    if name == "ddsrf-pll":
        x = generators((1,), 2 * _P.ddsrf_filter_ratio, h)
        return x._replace(error=1 - x.negative)
    return generators(ORDERS if name == "msogi-fll" else (1,), _P.sogi_gain, h)


def loop_gain(name: str, n: int, w: float) -> complex:
    """Frequency (rad/s) by the error of the loop (rad), at n times the grid's frequency w (rad/s)."""
    s = 1j * n * w
    if name.endswith("fll"):
        return _P.fll_gain * _P.sogi_gain * w / 2 / s
    w_n = 2 * math.pi * _P.pll_bandwidth_hz
    return w_n**2 / s / (1 + (2 * _P.pll_damping * w_n * s + w_n**2) / s**2)


def _along(parts: Harmonics) -> NDArray[np.complex128]:
    """Sum of vectors, in the frame of the fundamental, over a cycle."""
    turning = [z * np.exp(1j * (h - 1) * _ANGLES) for h, z in parts.items()]
    along: NDArray[np.complex128] = np.sum(turning, axis=0, dtype=np.complex128)
    return along


def frequency_ripple_hz(name: str, harmonics: Harmonics, w: float) -> float:
    """Ripple (half peak-to-peak) of the estimated frequency: the q part of the error, through the loop."""
    error = _along({h: passed(name, h).error * u for h, u in harmonics.items()}).imag
    spectrum = np.fft.rfft(error)
    gains = [0, *(loop_gain(name, n, w) for n in range(1, len(spectrum)))]
    return float(np.ptp(np.fft.irfft(spectrum * np.array(gains))) / 2 / (2 * math.pi))


def positive_ripple(name: str, harmonics: Harmonics) -> float:
    """Ripple (half peak-to-peak) of |u+|, as a part of the fundamental."""
    return float(np.ptp(_along({h: passed(name, h).positive * u for h, u in harmonics.items()}).real) / 2)


def reference_thd_percent(name: str, harmonics: Harmonics) -> float:
    """Distortion of i* in a balanced grid, eq (5) to first order: i* = i (1 - conj(p) - n), p and n what u+- have.

    Each order of ``harmonics`` makes its own by u-, and by u+ the mirrored one, 2 - h.
    """
    found: Harmonics = {}
    for h, u in harmonics.items():
        x = passed(name, h)
        found[h] = found.get(h, 0) - x.negative * u
        found[2 - h] = found.get(2 - h, 0) - (x.positive * u).conjugate()
    return float(100 * np.sqrt(np.sum(np.abs(list(found.values())) ** 2)))
