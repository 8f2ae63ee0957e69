"""The loop over time with some of its blocks replaced: what wrong controllers and plants run in."""

import types
from collections.abc import Callable, Mapping
from typing import Any

import numba

from pvlvrt_compliance.control import controller, precision, synchronisation
from pvlvrt_compliance.kernel import in_single, kernel, plain
from pvlvrt_compliance.plant import plant
from pvlvrt_compliance.simulation import controlling, loop
from pvlvrt_compliance.simulation.outcome import Outcome

Loop = Callable[..., Any]


def rebuilt_loop(**replacements: Callable[..., Any]) -> Loop:
    """Build a loop over time, ``block_name=function, ...``, for `simulate(..., run=run)`.

    A name is that of any function which the wiring (plant.py, synchronisation.py, controller.py) or the loop
    (controlling.py, loop.py) calls. Compiling takes seconds: keep what it gives.
    """
    replacements.setdefault("ended", _for_good)  # its controller may have a state of its own: no run goes on
    modules = {module.__name__: module for module in (plant, synchronisation, controller, precision, controlling, loop)}
    unknown = {name for name in replacements if not any(hasattr(module, name) for module in modules.values())}
    assert not unknown, f"no block of the loop is named {unknown}"
    blocks = {name: block if hasattr(block, "py_func") else kernel(block) for name, block in replacements.items()}
    rewired = _with_globals(plain(loop.run), _rewired(modules, blocks))
    return numba.njit(rewired, nogil=True, error_model="numpy")


def _for_good(status: int, period: int, plant_state: plant.PlantState, _x: Any, _m: complex, _k: int) -> Outcome:
    """How a run ends, with nothing of the controller's state."""
    return Outcome(status=status, period=period, plant=plant_state)


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


def _with_globals(source: Any, replaced: Mapping[str, Any]) -> types.FunctionType:
    return types.FunctionType(source.__code__, {**source.__globals__, **replaced}, source.__name__)
