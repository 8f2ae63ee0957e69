"""Loops over time with one block replaced: wrong controllers and plants that tests tell from the right ones."""

import math
import types
from collections.abc import Callable, Mapping
from typing import Any

import numba
import pytest

from pvlvrt_compliance import kernel as kernel_module
from pvlvrt_compliance.control import controller, precision, synchronisation
from pvlvrt_compliance.control.dc_voltage_regulator import DcVoltageRegulatorState
from pvlvrt_compliance.control.lvrt import LvrtOrder, lvrt_step
from pvlvrt_compliance.kernel import in_single, kernel, plain
from pvlvrt_compliance.plant import plant
from pvlvrt_compliance.plant.plant import PlantState, advance, plant_step
from pvlvrt_compliance.plant.protection import NO_TRIP, UNDERVOLTAGE
from pvlvrt_compliance.simulation import loop
from pvlvrt_compliance.vectors import scaled

Loop = Callable[..., Any]


def _rewired(modules: Mapping[str, Any], replaced: dict[str, Any]) -> dict[str, Any]:
    """Add to ``replaced`` every kernel, but the loop itself, that comes to a replaced one; callees stand before."""
    for module in modules.values():
        for name, block in list(vars(module).items()):
            source = plain(block)
            own = isinstance(source, types.FunctionType) and source.__module__ == module.__name__
            if own and name not in {*replaced, "run"} and set(source.__code__.co_names) & set(replaced):
                replaced[name] = kernel(_with_globals(source, replaced))
        if module is controller and "controller_step" in replaced:
            replaced["single_step"] = in_single(replaced["controller_step"])
    return replaced


def _with_globals(source: types.FunctionType, replaced: Mapping[str, Any]) -> types.FunctionType:
    return types.FunctionType(source.__code__, {**source.__globals__, **replaced}, source.__name__)


@pytest.fixture(scope="session")
def rebuild_loop() -> Callable[..., Loop]:
    """Build ``rebuild_loop(block_name=function, ...) -> run``, for `simulate(..., run=run)`.

    A name is that of any function which the wiring (plant.py, synchronisation.py, controller.py) or the loop calls.
    Compiling takes seconds: keep what it gives.
    """

    def rebuild(**replacements: Callable[..., Any]) -> Loop:
        modules = {module.__name__: module for module in (plant, synchronisation, controller, precision, loop)}
        unknown = {name for name in replacements if not any(hasattr(module, name) for module in modules.values())}
        assert not unknown, f"no block of the loop is named {unknown}"
        blocks = {name: block if hasattr(block, "py_func") else kernel(block) for name, block in replacements.items()}
        rewired = _with_globals(plain(loop.run), _rewired(modules, blocks))
        return numba.njit(rewired, nogil=True, error_model="numpy")

    return rebuild


def no_reactive_support(u_pos, u_neg, p):
    """Give all of S_fault to active power."""
    right = lvrt_step(u_pos, u_neg, p)
    P_limit = math.hypot(right.P_limit, right.Q_ref)
    return LvrtOrder(V_fault=right.V_fault, fault=right.fault, P_limit=P_limit, Q_ref=0.0)


def no_current_limit(u_pos, u_neg, p):
    """Ask for nominal power whatever the voltage."""
    right = lvrt_step(u_pos, u_neg, p)
    return LvrtOrder(V_fault=right.V_fault, fault=right.fault, P_limit=p.S_nom, Q_ref=right.Q_ref)


def balanced_currents(u_pos, u_neg, P_ref, Q_ref, p):
    """Give positive-sequence current only, i = (P - jQ) u+ / |u+|^2."""
    if abs(u_pos) - abs(u_neg) < p.u_pos_less_neg_min:
        return 0j
    return complex(P_ref, -Q_ref) * scaled(1 / abs(u_pos) ** 2, u_pos)


def dc_sign_reversed(x, v_dc, v_ref, P_limit, p, T):
    """Lower P* when the DC voltage rises."""
    e = v_ref - v_dc
    wanted = p.K_P * e + x.integral
    P_ref = min(max(wanted, 0.0), P_limit)
    return DcVoltageRegulatorState(integral=P_ref - p.K_P * e + p.K_I * e * T), P_ref, wanted > P_limit


def bridge_blocked(x, m, e, u_min, p):
    """Block the bridge at the first low voltage, for good, with the breaker left closed."""
    after = plant_step(x, m, e, u_min, p)
    return PlantState(
        i=after.i,
        v_dc=after.v_dc,
        x_pv=after.x_pv,
        i_pv=after.i_pv,
        relay=after.relay,
        trip=UNDERVOLTAGE if after.trip == NO_TRIP and after.relay.t_low > 0 else after.trip,
        t_trip=0.0,
        closed=True,
        mean=after.mean,
    )


def not_a_number(x, m, source, t, p, tables):
    """Lose the DC voltage from 0.5 s on."""
    after = advance(x, m, source, t, p, tables)
    return PlantState(
        i=after.i,
        v_dc=after.v_dc if t < 0.5 else math.nan,
        x_pv=after.x_pv,
        i_pv=after.i_pv,
        relay=after.relay,
        trip=after.trip,
        t_trip=after.t_trip,
        closed=after.closed,
        mean=after.mean,
    )


WRONG_PARTS = {
    "no_reactive_support": {"lvrt_step": no_reactive_support},
    "no_current_limit": {"lvrt_step": no_current_limit},
    "balanced_currents": {"current_references": balanced_currents},
    "dc_sign_reversed": {"dc_voltage_regulator_step": dc_sign_reversed},
    "bridge_blocked": {"plant_step": bridge_blocked},
    "not_a_number": {"advance": not_a_number},
}


@pytest.fixture(scope="session")
def in_python() -> Callable[..., Any]:
    """Give the Python behind a kernel and behind every kernel that it calls.

    Kernels can only be called from compiled code; a test of a single block needs none of that.
    """
    return kernel_module.in_python


class WrongRuns(dict[str, Loop]):
    """Loops by the name of what is wrong with them, compiled when first asked for."""

    def __init__(self, rebuild: Callable[..., Loop]) -> None:
        super().__init__()
        self._rebuild = rebuild

    def __missing__(self, name: str) -> Loop:
        self[name] = self._rebuild(**WRONG_PARTS[name])
        return self[name]


@pytest.fixture(scope="session")
def wrong_runs(rebuild_loop) -> WrongRuns:
    """Loops with one wrong part each, by name: the keys of `WRONG_PARTS`."""
    return WrongRuns(rebuild_loop)
