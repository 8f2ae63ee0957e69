"""What 32 bits cost the blocks whose state goes on for ever: the resonant cell, and the integrator of the frequency."""

import math
from typing import Any

import numba
import numpy as np
import pytest

from pvlvrt_compliance.control.fll import FllParams, fll_step
from pvlvrt_compliance.kernel import in_single, plain, single
from pvlvrt_compliance.sogi import SogiState, harmonic_turns, sogi_step
from pvlvrt_compliance.vectors import Rotation

T_REG = 40.9568e-6


def test_cell_agrees_with_numpy_to_the_last_bit():
    """The resonant cell gives what numpy gives on arrays of 32 bits, one rounding an operation."""
    step = in_single(sogi_step)

    @numba.njit
    def run(u, qu, forcing, c, s):
        out = np.empty((2, len(u)), dtype=np.complex64)
        for k in range(len(u)):
            y = step(SogiState(u=u[k], qu=qu[k]), forcing[k], Rotation(c=c[k], s=s[k]))
            out[0, k], out[1, k] = y.u, y.qu
        return out

    random = np.random.default_rng(1).standard_normal((7, 2000)).astype(np.float32)
    u, qu, forcing = (400 * (random[k] + 1j * random[k + 3]) for k in range(3))
    c, s = np.cos(random[6]), np.sin(random[6])
    assert (u.dtype, c.dtype) == (np.complex64, np.float32)
    found = run(u, qu, forcing, c, s)
    for part in ("real", "imag"):
        a, b, g = (getattr(z, part) for z in (u, qu, forcing))
        assert np.array_equal(getattr(found[0], part), c * a - s * (b - g))
        assert np.array_equal(getattr(found[1], part), (g + s * a) + c * (b - g))


def free_cell(step: Any, turn: Any, between: Any) -> Any:
    """Compile an undamped cell at rest from outside that turns n times; ``between`` is applied after each."""

    @numba.njit
    def run(x, angle, n, nothing):
        t = turn(angle).h1
        for _ in range(n):
            x = between(step(x, nothing, t))
        return x, t

    return run


@numba.njit
def as_it_is(x):
    """Change nothing."""
    return x


@numba.njit
def rounded(x):
    """Round what is stored, the least that 32 bits do."""
    return SogiState(u=np.complex128(np.complex64(x.u)), qu=np.complex128(np.complex64(x.qu)))


def test_rounded_turn_damps_the_undamped_cell():
    """With sine and cosine of 32 bits the pole leaves the unit circle: n samples scale by (c^2 + s^2)^(n/2).

    At 50 Hz that is -2.5e-4 in 0.8 s. Rounding the state alone would keep the length, so these are true 32-bit sums.
    """
    n, angle = 20_000, 100 * math.pi * T_REG
    x0 = SogiState(u=400 + 0j, qu=-400j)
    true, t = free_cell(in_single(sogi_step), in_single(harmonic_turns), as_it_is)(
        single(x0), np.float32(angle), n, np.complex64(0)
    )
    stored, _ = free_cell(sogi_step, harmonic_turns, rounded)(x0, angle, n, 0j)
    scale = math.hypot(float(t.c), float(t.s)) ** n - 1
    assert abs(scale) > 1e-4
    assert abs(complex(true.u)) / 400 - 1 == pytest.approx(scale, abs=2e-5)
    assert abs(complex(stored.u)) / 400 - 1 == pytest.approx(0, abs=2e-5)


@pytest.mark.parametrize("share", [0.45, 0.55])
def test_frequency_sticks_within_half_an_ulp(share):
    """The frequency stays for ever if a sample moves it by less than half an ulp (2^-16 rad/s at 50 Hz)."""
    w = np.float32(100 * math.pi)
    p = FllParams(K=math.sqrt(2), gamma=50.0, w_min=200.0, w_max=400.0, norm_min=1.0)
    x = SogiState(u=400 + 0j, qu=-400j)
    ulp = 2.0**-15
    error = share * ulp * 2 * 400 / (T_REG * p.gamma * p.K * float(w))  # e . qu' = -400 e, over |u'|^2 + |qu'|^2
    step = in_single(fll_step)

    @numba.njit
    def run(x, e, w, p, T):
        for _ in range(1000):
            w = step(x, e, w, p, T)
        return w

    end = run(single(x), np.complex64(1j * error), w, single(p), np.float32(T_REG))
    assert float(end) - float(w) == (0.0 if share < 0.5 else pytest.approx(1000 * ulp, rel=1e-6))
    double = plain(fll_step)(x, 1j * error, float(w), p, T_REG)
    assert double - float(w) == pytest.approx(share * ulp, rel=1e-6)
