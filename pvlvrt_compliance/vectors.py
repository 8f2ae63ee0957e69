"""Compiled arithmetic on space vectors."""

import math
from typing import NamedTuple

from pvlvrt_compliance.kernel import kernel


class Rotation(NamedTuple):
    """Turn of a vector in one sample."""

    c: float  # cosine of w T
    s: float  # sine of w T


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
