"""How fast the FLL follows a small step of the frequency, beside theory."""

import math
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.control.msogi_fll import locked, msogi_fll_step
from pvlvrt_compliance.kernel import in_python
from pvlvrt_compliance.sogi import SogiState
from validation.simulator.loops import ORDERS, W, nominal_controller

STEP_HZ = 0.01
_U = 398.4


@numba.njit(error_model="numpy")
def _follow(x: Any, u: Any, p: Any, T: Any, w: Any) -> None:
    for n in range(len(u)):
        x, y = msogi_fll_step(x, u[n], p, T)
        w[n] = y.w


def estimate(gamma: float, seconds: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Time (s) and what is left of a small step of the frequency (-), from a locked start."""
    p = nominal_controller()
    params = p.sync.fll._replace(gamma=gamma)
    t = p.T * np.arange(round(seconds / p.T), dtype=np.float64)
    target = W + 2 * math.pi * STEP_HZ
    w = np.empty(len(t))
    _follow(locked(complex(_U), W), _U * np.exp(1j * target * t), params, p.T, w)
    return t, (target - w) / (2 * math.pi * STEP_HZ)


def decay_rate(gamma: float) -> float:
    """Rate (1/s) at which the difference decays from 30 % to 2 % of the step, by least squares."""
    t, left = estimate(gamma, 4 / gamma + 0.02)
    tail = (left < 0.3) & (left > 0.02)
    return float(-np.polyfit(t[tail], np.log(left[tail]), 1)[0])


def slowest_mode(gamma: float) -> float:
    """Slowest rate (1/s) of the whole synchronisation linearised about a locked state, in the turning frame."""
    p = nominal_controller()
    params = p.sync.fll._replace(gamma=gamma)
    step, back = in_python(msogi_fll_step), np.exp(-1j * W * p.T)
    rest = locked(complex(_U), W)

    def after(x: NDArray[np.float64]) -> NDArray[np.float64]:
        z = x[:10] + 1j * x[10:20]
        cells = {f"h{h}": SogiState(u=z[2 * k], qu=z[2 * k + 1]) for k, h in enumerate(ORDERS)}
        y, _ = step(rest._replace(**cells, w=x[20]), complex(_U), params, p.T)
        turned = np.array([value * back for cell in y[:5] for value in cell])
        return np.concatenate([turned.real, turned.imag, [y.w]])

    z = np.array([value for cell in rest[:5] for value in cell])
    at = np.concatenate([z.real, z.imag, [W]])
    columns = [(after(at + 1e-3 * axis) - after(at - 1e-3 * axis)) / 2e-3 for axis in np.eye(21)]
    return float(-np.log(np.abs(np.linalg.eigvals(np.transpose(columns))).max()) / p.T)


def filter_rate() -> float:
    """Rate at which a quadrature generator follows amplitude and angle, K w/2 (1/s)."""
    return nominal_controller().sync.fll.K * W / 2


def second_order_rate(gamma: float) -> float:
    """Slower root of s^2 + a s + Gamma a with a = K w/2: the loop behind the lag of its filter (1/s)."""
    a = filter_rate()
    return a / 2 - math.sqrt(a**2 / 4 - gamma * a)
