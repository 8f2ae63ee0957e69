"""Compiled arithmetic on space vectors."""

import math
from typing import NamedTuple

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.space_vectors import SQRT2_3, SQRT3_2


class Rotation(NamedTuple):
    """Turn of a vector in one sample."""

    c: float  # cosine of w T
    s: float  # sine of w T


class Phases(NamedTuple):
    """One number a phase."""

    a: float
    b: float
    c: float


@kernel
def phases_of(z: complex) -> Phases:
    """Phase quantities of a vector, without zero sequence: the inverse of eq (1)."""
    along, across = SQRT2_3 * z.real, SQRT2_3 * SQRT3_2 * z.imag
    return Phases(a=along, b=-0.5 * along + across, c=-0.5 * along - across)


@kernel
def vector_of(x: Phases) -> complex:
    """Vector of phase quantities, eq (1); their zero sequence drops out."""
    return complex(SQRT2_3 * (x.a - 0.5 * x.b - 0.5 * x.c), SQRT2_3 * SQRT3_2 * (x.b - x.c))


@kernel
def dot(y: complex, z: complex) -> float:
    """Inner product of two vectors, Re(y conj(z)): of voltage and current, the power."""
    return y.real * z.real + y.imag * z.imag


@kernel
def length(z: complex) -> float:
    """Length of a vector. Cheaper than `abs`, which guards against overflow far beyond any voltage."""
    return math.sqrt(z.real * z.real + z.imag * z.imag)


@kernel
def scaled(k: float, z: complex) -> complex:
    """Multiple of a vector. Half the work of ``k * z``, which numba computes as a product of two complex numbers."""
    return complex(k * z.real, k * z.imag)


@kernel
def ahead(z: complex) -> complex:
    """Vector 90 degrees ahead, j z."""
    return complex(-z.imag, z.real)


@kernel
def rotation(angle: float) -> Rotation:
    """Turn by an angle (rad)."""
    return Rotation(c=math.cos(angle), s=math.sin(angle))


@kernel
def rotate_on(r: Rotation, by: Rotation) -> Rotation:
    """Turn by the sum of two angles: multiples of an angle without further sines."""
    return Rotation(c=r.c * by.c - r.s * by.s, s=r.s * by.c + r.c * by.s)


@kernel
def turned(z: complex, by: Rotation) -> complex:
    """Vector turned forwards: out of a frame at this angle."""
    return complex(by.c * z.real - by.s * z.imag, by.s * z.real + by.c * z.imag)


@kernel
def turned_back(z: complex, by: Rotation) -> complex:
    """Vector turned backwards: into a frame at this angle."""
    return complex(by.c * z.real + by.s * z.imag, by.c * z.imag - by.s * z.real)
