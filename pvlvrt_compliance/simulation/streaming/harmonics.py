"""Harmonics over whole cycles, compiled: `measure.harmonics.harmonic_amplitudes`."""

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import cached_kernel, kernel
from pvlvrt_compliance.simulation.streaming.blocks import Rows
from pvlvrt_compliance.simulation.streaming.windows import SILENT
from pvlvrt_compliance.waveforms.container import Samples

# As `measure.harmonics` has them: part of the first residual that ends the steps, and what is no divisor.
EXACT = 1e-14
TINY = 1e-300

HALF = 32
"""Half of the samples that are taken together, those as far before their middle as after it; a multiple of four."""

_ABREAST = 16  # orders are as many as a multiple of this, so that the processor does several at once and has no rest


@kernel
def add_four(sums: Samples, table: Rows, m: int, x: Samples) -> None:
    """Add four rows of a table, from row ``m`` on, times as many numbers."""
    first, second, third, fourth = table[m], table[m + 1], table[m + 2], table[m + 3]
    a, b, c, d = x[m], x[m + 1], x[m + 2], x[m + 3]
    for h in range(len(sums)):
        sums[h] += (a * first[h] + b * second[h]) + (c * third[h] + d * fourth[h])


@kernel
def projected(x: Samples, theta: float, tables: NDArray[np.float64], work: Rows, re: Samples, im: Samples) -> None:
    """Write the sum of x exp(-j h theta k) over the samples k, for each order h.

    Of samples as far before a middle as after it, sum and difference: a cosine and a sine each.

    Parameters
    ----------
    x : array, shape (n,)
        The samples.
    theta : float
        Angle of the fundamental from one to the next (rad).
    tables : array, shape (2, HALF, orders)
        Cosine and sine of h theta (m + 1/2), m being the row.
    work : array, shape (8, orders)
        Of no value before or after.
    re, im : array, shape (orders,)
        Real and imaginary parts.
    """
    n, cosines, sines = len(x), tables[0], tables[1]
    even, odd, here_x, here_y, at_x, at_y, on_x, on_y = (
        work[0], work[1], work[2], work[3], work[4], work[5], work[6], work[7]
    )  # fmt: skip
    for h in range(len(re)):
        re[h] = im[h] = 0.0
        start, step = h * theta * (HALF - 0.5), h * theta * (2 * HALF)
        at_x[h], at_y[h], on_x[h], on_y[h] = math.cos(start), math.sin(start), math.cos(step), math.sin(step)
    for begin in range(0, n, 2 * HALF):
        middle = begin + HALF
        for m in range(HALF):
            after = x[middle + m] if middle + m < n else 0.0
            before = x[middle - 1 - m] if middle - 1 - m < n else 0.0
            even[m], odd[m] = after + before, after - before
        here_x[:] = 0.0
        here_y[:] = 0.0
        for m in range(0, HALF, 4):
            add_four(here_x, cosines, m, even)
            add_four(here_y, sines, m, odd)
        for h in range(len(re)):
            re[h] += here_x[h] * at_x[h] - here_y[h] * at_y[h]
        for h in range(len(re)):
            im[h] -= here_x[h] * at_y[h] + here_y[h] * at_x[h]
        for h in range(len(re)):
            at_x[h], at_y[h] = at_x[h] * on_x[h] - at_y[h] * on_y[h], at_x[h] * on_y[h] + at_y[h] * on_x[h]


@kernel
def image_into(highest: int, products: Rows, x: Samples, y: Samples, image_x: Samples, image_y: Samples) -> None:
    """Write the matrix of `measure.harmonics` times a vector whose orders below 0 are conjugates of those above.

    Parameters
    ----------
    highest : int
        Highest order.
    products : array, shape (2, 4 highest + 1 and more)
        Real and imaginary part of the sum of exp(-j m theta k) over the samples, for m = -2 highest .. 2 highest.
    x, y, image_x, image_y : array, shape (orders,)
        Real and imaginary parts of orders 0 and up.
    """
    width = len(image_x)
    image_x[:] = 0.0
    image_y[:] = 0.0
    for order in range(-highest, highest + 1):
        a, b = x[abs(order)], y[abs(order)] if order >= 0 else -y[abs(order)]
        begin = 2 * highest - order
        of_x, of_y = products[0, begin : begin + width], products[1, begin : begin + width]
        for m in range(width):
            image_x[m] += a * of_x[m] - b * of_y[m]
        for m in range(width):
            image_y[m] += a * of_y[m] + b * of_x[m]


@kernel
def product(highest: int, a_x: Samples, a_y: Samples, b_x: Samples, b_y: Samples) -> float:
    """Real part of the inner product of two such vectors, orders below 0 included."""
    total: float = 0.5 * (a_x[0] * b_x[0] + a_y[0] * b_y[0])
    for h in range(1, highest + 1):
        total += a_x[h] * b_x[h] + a_y[h] * b_y[h]
    return 2.0 * total


@kernel
def solved(highest: int, products: Rows, work: Rows, x: Samples, y: Samples) -> None:
    """Put in place of projections what the normal equations make of them: conjugate gradients, a few steps.

    Parameters as `image_into`, with ``work`` of shape (6, orders).
    """
    rest_x, rest_y, along_x, along_y, image_x, image_y = work[0], work[1], work[2], work[3], work[4], work[5]
    for h in range(len(x)):
        rest_x[h], rest_y[h] = x[h], y[h]
        along_x[h], along_y[h] = x[h], y[h]
        x[h], y[h] = 0.0 * x[h], 0.0 * y[h]  # what is not a number stays so
    square = product(highest, rest_x, rest_y, rest_x, rest_y)
    enough = EXACT * EXACT * square
    for _ in range(2 * highest + 1):
        if not square > enough:
            break
        image_into(highest, products, along_x, along_y, image_x, image_y)
        step = square / max(product(highest, along_x, along_y, image_x, image_y), TINY)
        for h in range(highest + 1):
            x[h] += step * along_x[h]
            y[h] += step * along_y[h]
            rest_x[h] -= step * image_x[h]
            rest_y[h] -= step * image_y[h]
        last, square = square, product(highest, rest_x, rest_y, rest_x, rest_y)
        further = square / max(last, TINY)
        for h in range(highest + 1):
            along_x[h] = rest_x[h] + further * along_x[h]
            along_y[h] = rest_y[h] + further * along_y[h]


@cached_kernel
def harmonics_into(
    x: Rows, theta: float, highest: int, tables: NDArray[np.float64], products: Rows, work: Rows, out: Rows
) -> None:
    """Write amplitudes of the mean and the harmonics of signals.

    Parameters
    ----------
    x : array, shape (signals, n)
        Samples of whole cycles.
    theta, highest, tables, products
        As `projected` and `image_into` have them.
    work : array, shape (10, orders)
        Of no value before or after.
    out : array, shape (signals, highest + 1)
        Amplitudes (peak); of order 0 the magnitude of the mean.
    """
    re, im = work[8], work[9]
    for signal in range(len(x)):
        projected(x[signal], theta, tables, work, re, im)
        solved(highest, products, work, re, im)
        for h in range(highest + 1):
            out[signal, h] = (2.0 if h > 0 else 1.0) * math.sqrt(re[h] * re[h] + im[h] * im[h])


@SILENT
def harmonic_amplitudes(x: Samples, theta: float, highest: int) -> Samples:
    """Amplitudes of orders 0 to the highest of signals, shape (signals, n) of whole cycles: as the definition has them.

    ``theta`` is the angle of the fundamental from one sample to the next.
    """
    orders = _ABREAST * max(math.ceil((highest + 1) / _ABREAST), HALF // _ABREAST)
    m = np.arange(-2 * highest, 2 * highest + 1)
    products, found = np.zeros((2, len(m) + orders)), np.empty((len(x), highest + 1))
    with np.errstate(divide="ignore"):
        sizes = np.sin(0.5 * theta * x.shape[-1] * m) / np.sin(0.5 * theta * m)
    sizes[2 * highest] = x.shape[-1]
    middle = 0.5 * (x.shape[-1] - 1) * theta * m
    products[:, : len(m)] = sizes * np.cos(middle), -sizes * np.sin(middle)
    samples = np.ascontiguousarray(x, dtype=np.float64)
    harmonics_into(samples, theta, highest, _tables(theta, orders), products, np.empty((10, orders)), found)
    return found


@lru_cache(maxsize=4)
def _tables(theta: float, orders: int) -> NDArray[np.float64]:
    """Those of `projected`, the same for all windows of a record as a rule."""
    angles = theta * np.outer(np.arange(HALF) + 0.5, np.arange(orders))
    return np.stack([np.cos(angles), np.sin(angles)])
