"""The one decorator for compiled code (where that is kept: `cache`; what it goes by: `compiled.sources`)."""

import types
from collections.abc import Callable
from functools import cache
from typing import Any, TypeVar, cast

import numpy as np

from pvlvrt_compliance.cache import cache_root
from pvlvrt_compliance.compiled.entry import Entry
from pvlvrt_compliance.compiled.lazy import Block, Instructions, is_interpreted
from pvlvrt_compliance.compiled.sources import Sources

F = TypeVar("F", bound=Callable[..., Any])

# A division by zero gives inf, which the loop finds, instead of a check and a branch at every division.
_ERROR_MODEL = "numpy"

_blocks: set[types.FunctionType] = set()  # the Python of every kernel

_sources: dict[types.FunctionType, Sources] = {}  # of what Python calls


def sources_of(function: Callable[..., Any]) -> Sources:
    """Sources of what `cached_kernel` has compiled, or will."""
    return _sources[cast(types.FunctionType, plain(function))]


def kernel(function: F) -> F:
    """Compile a block: inlined into whatever calls it, never fast-math, float64 (float32, see `in_single`).

    Only compiled code can call it (from Python, see `plain`): wrappers for Python would double the time to compile.
    """
    _blocks.add(cast(types.FunctionType, function))
    if is_interpreted():
        return function
    block: Any = Block(
        function, error_model=_ERROR_MODEL, forceinline=True, no_cpython_wrapper=True, no_cfunc_wrapper=True
    )
    return cast(F, block)


def instructions(generator: Callable[..., Any], interpreted: F) -> F:
    """Make an intrinsic of the compiler of what `numba.extending.intrinsic` takes.

    ``interpreted`` does the same in Python, and has its place where compilation is turned off.
    """
    made: Any = interpreted if is_interpreted() else Instructions(generator)
    return cast(F, made)


def plain(function: F) -> F:
    """The Python behind a kernel, for the odd call outside compiled code that is not worth compiling for."""
    python: F = getattr(function, "py_func", function)
    return python


@cache
def in_python(function: F) -> F:
    """The Python behind a kernel and behind every kernel that it calls: to look at a block outside compiled code."""
    source: Any = plain(function)
    called = {name: in_python(block) for name, block in _named_in(source).items() if is_kernel(block)}
    python: Any = types.FunctionType(source.__code__, {**source.__globals__, **called}, source.__name__)
    return python  # type: ignore[no-any-return]


def is_kernel(x: Any) -> bool:
    """Whether something is a block that `kernel` has compiled, or will."""
    return isinstance(plain(x), types.FunctionType) and plain(x) in _blocks


def _named_in(source: Any) -> dict[str, Any]:
    """Globals that a function names."""
    return {name: source.__globals__[name] for name in source.__code__.co_names if name in source.__globals__}


def single(x: Any) -> Any:
    """The same in single precision: numbers, complex arrays, and tuples of them; what is none or whole stays."""
    if isinstance(x, float):
        return np.float32(x)
    if isinstance(x, complex):
        return np.complex64(x)
    if isinstance(x, np.ndarray) and np.iscomplexobj(x):
        return x.astype(np.complex64)
    if isinstance(x, tuple):
        parts = [single(part) for part in x]
        return type(x)(*parts) if hasattr(x, "_fields") else tuple(parts)
    return x


def _with_single(source: Any, called: Callable[[Any], Any], builtins: dict[str, Any]) -> Any:
    """Copy of a function whose constants are single, and whose blocks are what ``called`` makes of them."""
    named = {name: called(x) if is_kernel(x) else single(x) for name, x in _named_in(source).items()}
    code = source.__code__.replace(co_consts=single(source.__code__.co_consts))
    return types.FunctionType(code, {**source.__globals__, **named, **builtins}, source.__name__)


@cache
def in_single(function: F) -> F:
    """Kernel of the same source, and of those that it calls, in which every constant is a number of 32 bits.

    Called with float32 and complex64 it computes with nothing else; with float64 it is not meant to be called. The
    source has to keep whole numbers out of its arithmetic (``5.0 * x``, ``float(n)``): numba makes float64 of them.
    """
    if is_interpreted():
        python: F = single_in_python(function)
        return python
    compiled: F = kernel(_with_single(plain(function), in_single, {"float": np.float32}))
    return compiled


@cache
def single_in_python(function: F) -> F:
    """The Python behind what `in_single` gives, on numpy's scalars."""
    # Those of Python's own functions that give double precision, whatever they are given.
    builtins = {"float": np.float32, "complex": _single_complex, "math": np}
    python: F = _with_single(plain(function), single_in_python, builtins)
    return python


def _single_complex(real: Any, imag: Any) -> np.complex64:
    return np.complex64(complex(real, imag))


def cached_kernel(function: F) -> F:
    """Compile an entry point, which Python calls, and keep the machine code between processes.

    The global interpreter lock is released while it runs.
    """
    source, root = cast(types.FunctionType, function), cache_root()
    _sources[source] = Sources(source, __name__, root)
    if is_interpreted():
        return function
    entry: Any = Entry(source, _sources[source], root, error_model=_ERROR_MODEL)
    return cast(F, entry)
