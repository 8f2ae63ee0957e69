"""Clarke transform and symmetrical components.

A space vector is one complex number, alpha + j beta, power-invariant (eq (1) of the paper), so that
P + jQ = u conj(i). Positive sequence turns as exp(+jwt), negative sequence as exp(-jwt).
The functions take scalars or arrays; kernels inline the scalar forms below.
"""

import math
from typing import Any, NamedTuple

SQRT2_3 = math.sqrt(2 / 3)
SQRT3_2 = math.sqrt(3) / 2

PI = math.pi  # here for the kernels, which change the precision of constants that they name

ROTATION_120 = complex(-0.5, SQRT3_2)
"""The operator a = exp(j 2 pi / 3)."""

# The kernels call these with scalars and the measurements with arrays; both are one formula.
Complex = Any
Real = Any


class Sequences(NamedTuple):
    """Symmetrical components of three phasors, in the unit of the phasors: numbers, or arrays of one shape."""

    positive: Complex
    negative: Complex
    zero: Complex


def clarke(a: Real, b: Real, c: Real) -> Complex:
    """Space vector of three phase quantities, eq (1); the zero sequence drops out."""
    return SQRT2_3 * (a - 0.5 * b - 0.5 * c) + 1j * SQRT2_3 * SQRT3_2 * (b - c)


def fortescue(a: Complex, b: Complex, c: Complex) -> tuple[Complex, Complex, Complex]:
    """Positive, negative and zero sequence of three phasors (Fortescue)."""
    r, r2 = ROTATION_120, ROTATION_120.conjugate()
    return (a + r * b + r2 * c) / 3, (a + r2 * b + r * c) / 3, (a + b + c) / 3


def phases(positive: Complex, negative: Complex, zero: Complex) -> tuple[Complex, Complex, Complex]:
    """Three phasors from their symmetrical components: the inverse of `fortescue`."""
    both, across = positive + negative, 1j * SQRT3_2 * (negative - positive)
    beside = zero - 0.5 * both
    return zero + both, beside + across, beside - across
