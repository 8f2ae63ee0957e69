"""Harmonics and total harmonic distortion over whole cycles."""

import math
from collections.abc import Callable

import numpy as np

from pvlvrt_compliance.measure.fourier import ComplexSamples, whole_cycles
from pvlvrt_compliance.waveforms.container import Samples

FUNDAMENTAL_FLOOR = 1e-3
"""Amplitude, in the unit of the signal, below which a distortion in percent of the fundamental means nothing."""

_EXACT = 1e-14
_TINY = 1e-300
_ONE_THREAD = 1 << 18  # products up to which the matrix library wakes no threads, which cost more than they give


def harmonic_amplitudes(
    x: Samples,
    dt_s: float,
    frequency_hz: float,
    highest: int = 40,
    by: Callable[[Samples, float, int], Samples] | None = None,
) -> Samples:
    """Amplitudes of the mean and the harmonics over the whole cycles at the beginning of a window.

    Least squares on all orders up to ``highest`` at once, hence exact for a periodic signal although its cycle is no
    whole number of samples. Orders that the sampling cannot carry (half the samples a cycle and above) are 0.

    Parameters
    ----------
    x : array, shape (..., n)
        Samples.
    dt_s, frequency_hz : float
        Sampling step (s); frequency of the fundamental (Hz).
    highest : int
        Highest order.
    by : function, optional
        Does so in place of numpy: samples of whole cycles, angle of the fundamental from one to the next, last order.

    Returns
    -------
    array, shape (..., highest + 1)
        Amplitudes (peak) by order in the unit of x; order 0 is the magnitude of the mean.

    Raises
    ------
    MeasurementError
        When the window does not hold one cycle.
    """
    n = whole_cycles(x.shape[-1], dt_s, frequency_hz).samples
    carried = min(highest, (n - 1) // 2, math.ceil(0.5 / (frequency_hz * dt_s)) - 1)
    amplitudes = np.zeros((*x.shape[:-1], highest + 1))
    amplitudes[..., : carried + 1] = (by or _amplitudes)(x[..., :n], 2 * np.pi * frequency_hz * dt_s, carried)
    return amplitudes


def _amplitudes(x: Samples, theta: float, carried: int) -> Samples:
    """Amplitudes of all orders up to the last that is carried, shape (..., carried + 1)."""
    projections = _projections(x, theta, carried)
    both_signs = np.concatenate([projections[:0:-1].conj(), projections])
    products = _inner_products(x.shape[-1], theta, carried)
    found = _least_squares(products, np.moveaxis(both_signs, 0, -1))
    amplitudes: Samples = 2 * np.abs(found[..., carried:])
    amplitudes[..., 0] /= 2
    return amplitudes


def _projections(x: Samples, theta: float, highest: int) -> ComplexSamples:
    """Sum of x exp(-j h theta k) over the samples k, for h = 0 .. highest; shape (highest + 1, ...).

    In rows of about sqrt(n) samples: what turns in a row is the same for all of them, and what turns from row to row
    for all samples of a row.
    """
    n, orders = x.shape[-1], np.arange(highest + 1)
    length = math.isqrt(n) + 1
    together = max(_ONE_THREAD // (2 * len(orders) * length), 1)
    groups = -(-n // (length * together))
    rows = np.zeros((*x.shape[:-1], groups, together, length))
    rows.reshape(*x.shape[:-1], -1)[..., :n] = x
    in_row = np.exp(-1j * theta * np.outer(np.arange(length), orders))
    from_row = np.exp(-1j * theta * length * np.outer(np.arange(groups * together), orders))
    of_rows = (rows @ in_row.view(np.float64)).view(np.complex128).reshape(*x.shape[:-1], *from_row.shape)
    of_rows *= from_row
    sums: ComplexSamples = np.moveaxis(of_rows.sum(axis=-2), -1, 0)
    return sums


def _inner_products(n: int, theta: float, highest: int) -> ComplexSamples:
    """Sum of exp(j m theta k) over k = 0 .. n - 1, for m = -2 highest .. 2 highest: geometric sums."""
    m = np.arange(-2 * highest, 2 * highest + 1)
    half = 0.5 * theta * m
    half[2 * highest] = 1.0
    ratio = np.sin(n * half) / np.sin(half)
    ratio[2 * highest] = n
    sums: ComplexSamples = ratio * np.exp(0.5j * (n - 1) * theta * m)
    return sums


def _least_squares(products: ComplexSamples, right: ComplexSamples) -> ComplexSamples:
    """Solve the normal equations, whose matrix has ``products[m' - m]`` in row m and column m'; shape (..., orders).

    Over whole cycles that matrix is n times the identity but for what a part of a sample leaves, so that conjugate
    gradients end after a few steps; and it is a convolution, hence the transforms.
    """
    size = right.shape[-1]
    length = 1 << int(len(products) + size).bit_length()
    turned = np.fft.fft(products[::-1], length)

    def times_matrix(c: ComplexSamples) -> ComplexSamples:
        image: ComplexSamples = np.fft.ifft(turned * np.fft.fft(c, length))[..., size - 1 : 2 * size - 1]
        return image

    found, rest = 0 * right, right  # what is not a number stays so
    direction, square = rest, _squares(rest)
    enough = _EXACT**2 * square
    for _ in range(size):
        if not (square > enough).any():
            break
        image = times_matrix(direction)
        step = square / np.maximum(np.sum(direction.conj() * image, axis=-1, keepdims=True).real, _TINY)
        found, rest = found + step * direction, rest - step * image
        last, square = square, _squares(rest)
        direction = rest + square / np.maximum(last, _TINY) * direction
    return found


def _squares(x: ComplexSamples) -> Samples:
    total: Samples = np.sum(x.real**2 + x.imag**2, axis=-1, keepdims=True)
    return total


def thd_percent(
    x: Samples, dt_s: float, frequency_hz: float, highest: int = 40, floor: float = FUNDAMENTAL_FLOOR
) -> float | None:
    """Total harmonic distortion of orders 2 to ``highest``, in percent of the fundamental.

    Parameters as `harmonic_amplitudes`, with x of shape (n,). None where the amplitude of the fundamental is below
    ``floor`` (in the unit of x).

    Raises
    ------
    MeasurementError
        When the window does not hold one cycle.
    """
    return distortion_percent(harmonic_amplitudes(x, dt_s, frequency_hz, highest), floor)


def distortion_percent(amplitudes: Samples, floor: float = FUNDAMENTAL_FLOOR) -> float | None:
    """Root of the sum of squares of orders 2 and up, in percent of order 1; None below the floor. Shape (orders,)."""
    if amplitudes[1] < floor:
        return None
    return float(100 * np.sqrt(np.sum(amplitudes[2:] ** 2)) / amplitudes[1])
