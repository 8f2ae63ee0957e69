"""Single precision: what the controller's blocks compute with, and what 32 bits cost them."""

import math
import re
import types
from collections.abc import Iterator
from typing import Any, NamedTuple

import numba
import numpy as np
import pytest

from pvlvrt_compliance.control.controller import ControllerParams, ControllerState, controller_step
from pvlvrt_compliance.control.current_references import current_references
from pvlvrt_compliance.control.precision import double_signals, in_single_precision, single_step
from pvlvrt_compliance.control.synchronisation import synchronise
from pvlvrt_compliance.kernel import in_python, in_single, is_kernel, plain, single, single_in_python
from pvlvrt_compliance.measured import Measured
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import parameters_from
from pvlvrt_compliance.simulation.translate import controller_params, plant_params, plant_tables, steady_state

T_REG = 40.9568e-6
ULP = 2.0**-23  # of numbers from 1 to 2
ALGORITHMS = ["msogi-fll", "dsogi-fll", "srf-pll", "ddsrf-pll", "dsc-pll"]
STRATEGIES = ["constant-p-q", "constant-p-light-q", "constant-p-sinusoidal", "constant-q", "balanced"]
WIDE = re.compile(r"float64|complex128")


class Controller(NamedTuple):
    """A controller in the steady state of nominal operation."""

    state: ControllerState
    params: ControllerParams

    def in_single(self) -> "Controller":
        """Give the same in single precision."""
        return Controller(*in_single_precision(self.state, self.params))


def controller(*settings: str) -> Controller:
    """Nominal controller with some settings."""
    parameters, scenario = parameters_from(settings), Scenario(sag=Sag(depth=0), duration_s=0.5)
    params, plant = controller_params(parameters, scenario), plant_params(parameters, scenario)
    start = steady_state(plant, plant_tables(parameters, scenario).grid, params, scenario, 0.0)
    return Controller(state=start.controller, params=params)


def inputs(n: int) -> np.ndarray:
    """Columns of `Measured` over n samples, shape (n, 4): a sag of phase c to 10 %, and currents that lag."""
    angle = 100 * math.pi * T_REG * np.arange(n)
    sagged = np.where(np.arange(n) < n // 4, 0.0, 0.3)
    u = 398.0 * ((1 - sagged) * np.exp(1j * angle) - sagged * np.exp(-1j * angle + 2.0j))
    return np.stack([u, 1250 * np.exp(1j * (angle - 0.1)), 800 + 20 * np.sin(2 * angle), 600 + 0 * angle], axis=1)


def llvm_of(step: Any, measured: Any, of: Controller) -> str:
    """Text of the instructions that a step is compiled to, without anything of Python's around it."""
    function = numba.njit(
        lambda x, y, p: step(x, y, p),  # noqa: PLW0108
        error_model="numpy",
        no_cpython_wrapper=True,
        no_cfunc_wrapper=True,
    )
    function.compile((numba.typeof(of.state), numba.typeof(measured), numba.typeof(of.params)))
    return str(function.inspect_llvm(function.signatures[0]))


def kernels_of(function: Any, seen: dict[int, Any] | None = None) -> list[Any]:
    """A kernel and every kernel that it comes to."""
    seen = {} if seen is None else seen
    if id(function) not in seen:
        seen[id(function)] = function
        source = plain(function)
        for name in source.__code__.co_names:
            if is_kernel(source.__globals__.get(name)):
                kernels_of(source.__globals__[name], seen)
    return list(seen.values())


def inferred(function: Any) -> Iterator[tuple[str, str]]:
    """Name and type of everything in a kernel for which numba has inferred one, calls included."""
    for result in function.overloads.values():
        note = result.type_annotation
        for part in (note.typemap, note.calltypes):
            yield from ((f"{function.__name__}: {name}", str(kind)) for name, kind in part.items())


# Without a compiler there is no code to look into.
needs_compiled_code = pytest.mark.skipif(bool(numba.config.DISABLE_JIT), reason="looks into compiled code")


MEASURED = Measured(u_g_ab=398 + 0j, i_ab=1250 + 0j, v_dc=800.0, i_pv=600.0)


@needs_compiled_code
@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_nothing_computes_with_64_bits(algorithm):
    """Neither a variable, nor a call, nor an instruction of the compiled controller has 64-bit numbers.

    The strategy of power is chosen while running, so the code has all five.
    """
    made = llvm_of(single_step, single(MEASURED), controller(f"controller.synchronisation={algorithm}").in_single())
    assert re.search(r"= fmul float ", made)
    assert not re.search(r"\bdouble\b", made)
    found = [entry for kernel in kernels_of(single_step) for entry in inferred(kernel)]
    assert len(found) > 1000
    assert [entry for entry in found if WIDE.search(entry[1])] == []


@needs_compiled_code
def test_64_bits_would_be_seen():
    """The same search finds them in the controller of double precision."""
    made = llvm_of(controller_step, MEASURED, controller())
    assert re.search(r"= fmul double ", made)
    assert any(WIDE.search(kind) for kernel in kernels_of(controller_step) for _, kind in inferred(kernel))


@needs_compiled_code
def test_every_strategy_and_block_is_looked_at():
    """Every block of the controller has its counterpart of single precision."""
    names = {kernel.__name__ for kernel in kernels_of(controller_step)}
    assert names == {kernel.__name__ for kernel in kernels_of(single_step)}
    strategies = {"constant_p_q", "constant_p_light_q", "constant_p_sinusoidal", "constant_q", "balanced"}
    assert strategies | {"msogi_fll_step", "dsogi_fll_step", "srf_pll_step", "ddsrf_pll_step", "dsc_pll_step"} <= names


def numbers(x: Any) -> Iterator[Any]:
    """All numbers in nested tuples."""
    if isinstance(x, tuple):
        for part in x:
            yield from numbers(part)
    else:
        yield x


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_python_computes_with_32_bits_too(algorithm):
    """Without the compiler every number that is not whole stays one of numpy's 32-bit scalars, sample after sample."""
    x, p = controller(f"controller.synchronisation={algorithm}").in_single()
    step = single_in_python(controller_step)
    for u, i, v_dc, i_pv in inputs(200).tolist():
        x, signals = step(x, single(Measured(u_g_ab=u, i_ab=i, v_dc=v_dc.real, i_pv=i_pv.real)), p)
    kinds = {type(number) for number in numbers((x, signals))}
    assert kinds <= {np.float32, np.complex64, int, bool, np.bool_, np.ndarray, type(None)}
    assert not any(isinstance(line, np.ndarray) and line.dtype != np.complex64 for line in numbers(x))


def test_what_is_put_out_is_the_same_number_in_64_bits():
    """Signals reach plant and record exactly as they were computed with 32 bits."""
    x, p = controller().in_single()
    _, signals = single_in_python(controller_step)(x, single(MEASURED), p)
    out = plain(double_signals)(signals)
    assert out == signals
    assert {type(number) for number in out} <= {np.float64, np.complex128, bool, np.bool_}


@pytest.mark.parametrize("strategy", range(1, 6))
def test_strategies_agree_with_double_precision(strategy):
    """Each strategy gives double precision's current within a few ulp, more where |u+| - |u-| cancels."""
    references = single_in_python(current_references)
    p = controller().params.references._replace(strategy=strategy)
    u_pos, u_neg = 300 + 40j, -90 + 80j
    double = in_python(current_references)(u_pos, u_neg, 3e5, 1e5, p)
    found = references(*single((u_pos, u_neg, 3e5, 1e5, p)))
    assert type(found) is np.complex64
    assert 0 < abs(complex(found) - double) < 8 * ULP * abs(double)


@numba.njit
def compiled_step(x, y, p):
    """Advance the controller of single precision; numbers come back as Python's of 64 bits."""
    return single_step(x, y, p)


single_synchronise = in_single(synchronise)


@numba.njit
def synchronise_in_single(x, y, p, T):
    """Advance the synchronisation of single precision."""
    return single_synchronise(x, y, p, T)


def compiled_synchronise(*arguments: Any) -> Any:
    """Advance the compiled synchronisation; numbers come back as numpy's of 32 bits."""
    return single(synchronise_in_single(*arguments))


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_synchronisation_agrees_with_numpy(algorithm):
    """From the same state numpy's 32-bit synchronisation and the compiled one come to the same.

    They differ where numpy's sine and the machine's differ in the last bit: by 4 ulp of a number's largest value.
    """
    by_numpy = single_in_python(synchronise)
    x, p = controller(f"controller.synchronisation={algorithm}").in_single()
    rows = []
    for u in single(tuple(inputs(400)[:, 0].tolist())):
        ends = compiled_synchronise(x.sync, u, p.sync, p.T), by_numpy(x.sync, u, p.sync, p.T)
        x = x._replace(sync=ends[1][0])
        rows.append([[z for z in numbers(end) if np.isscalar(z)] for end in ends])
    one, other = np.array(rows).swapaxes(0, 1)
    assert (np.abs(one - other).max(axis=0) <= 4 * ULP * np.abs(other).max(axis=0)).all()


@pytest.mark.parametrize("strategy", STRATEGIES)
def test_everything_else_agrees_with_numpy_to_the_last_bit(strategy):
    """Given the compiled synchronisation, the only block with a sine, numpy's 32-bit controller gives the same bits."""
    python = single_in_python(controller_step)
    within = {**python.__globals__, "synchronise": compiled_synchronise}
    by_numpy = types.FunctionType(python.__code__, within)
    x, p = controller(f"controller.power_strategy={strategy}", "controller.mppt_period_s=0.001").in_single()
    for u, i, v_dc, i_pv in inputs(400).tolist():
        y = single(Measured(u_g_ab=u, i_ab=i, v_dc=v_dc.real, i_pv=i_pv.real))
        other, (x, signals) = compiled_step(x, y, p), by_numpy(x, y, p)
        assert (x, signals) == other
