"""Parameters of the controller as a run has them, and its blocks driven over many samples."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numba
import numpy as np
import pytest

from pvlvrt_compliance.control.controller import ControllerParams
from pvlvrt_compliance.control.synchronisation import SynchronisationState, locked
from pvlvrt_compliance.control.synchronisation import synchronise as synchronise_step
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters, parameters_from
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
    state: SynchronisationState


@numba.njit
def _track(x, u, p, T, u_pos, u_neg, w):
    for n in range(len(u)):
        x, y = synchronise_step(x, u[n], p, T)
        u_pos[n], u_neg[n], w[n] = y.u_pos, y.u_neg, y.w
    return x


@pytest.fixture(scope="session")
def track(params) -> Callable[..., Track]:
    """Feed a synchronisation with samples of a voltage vector, shape (n,) (V); it starts locked at ``start_hz``.

    ``settings`` are of the controller, as ``name=value``; ``**fll`` are fields of the parameters of the FLL.
    """

    def follow(u: np.ndarray, start_hz: float, *settings: str, **fll: float) -> Track:
        n = len(u)
        scenario = Scenario(sag=Sag(depth=0), duration_s=0.5)
        p = controller_params(parameters_from(f"controller.{text}" for text in settings), scenario).sync
        p = p._replace(fll=p.fll._replace(**fll))
        u_pos, u_neg, w = np.empty(n, complex), np.empty(n, complex), np.empty(n)
        x = locked(complex(params.lvrt.u_nom), 2 * math.pi * start_hz, p, params.T)
        state = _track(x, np.asarray(u, complex), p, params.T, u_pos, u_neg, w)
        return Track(u_pos=u_pos, u_neg=u_neg, w=w, state=state)

    return follow
