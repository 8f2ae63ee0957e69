"""Parameters of the controller as a run has them, and its blocks driven over many samples."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numba
import numpy as np
import pytest

from pvlvrt_compliance.control.controller import ControllerParams
from pvlvrt_compliance.control.msogi_fll import MsogiFllState, locked, msogi_fll_step
from pvlvrt_compliance.scenario.parameters import Parameters
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.translate import controller_params


@pytest.fixture(scope="session")
def params() -> ControllerParams:
    """Parameters of Table 3 on the nominal plant at 50 Hz."""
    return controller_params(Parameters(), Scenario(sag=Sag(depth=0), duration_s=0.5))


class Track(NamedTuple):
    """Synchronisation over time, arrays of shape (n,)."""

    u_pos: np.ndarray
    u_neg: np.ndarray
    w: np.ndarray
    state: MsogiFllState


@numba.njit
def _track(x, u, p, T, u_pos, u_neg, w):
    for n in range(len(u)):
        x, y = msogi_fll_step(x, u[n], p, T)
        u_pos[n], u_neg[n], w[n] = y.u_pos, y.u_neg, y.w
    return x


@pytest.fixture(scope="session")
def synchronise(params) -> Callable[..., Track]:
    """Feed the MSOGI-FLL with samples of a voltage vector, shape (n,) (V); it starts locked at ``start_hz``."""

    def follow(u: np.ndarray, start_hz: float, gamma: float = params.sync.gamma) -> Track:
        n = len(u)
        u_pos, u_neg, w = np.empty(n, complex), np.empty(n, complex), np.empty(n)
        x = locked(complex(params.lvrt.u_nom), 2 * math.pi * start_hz)
        state = _track(x, np.asarray(u, complex), params.sync._replace(gamma=gamma), params.T, u_pos, u_neg, w)
        return Track(u_pos=u_pos, u_neg=u_neg, w=w, state=state)

    return follow
