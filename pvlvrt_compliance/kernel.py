"""The one decorator for compiled code, and where its cache lives.

numba's cache key sees the file of the compiled function only, not the files of the functions it calls. The cache
folder is therefore named after a digest of every kernel source, so that an edit anywhere compiles anew.
"""

import hashlib
import os
import types
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path
from typing import Any, TypeVar

import numba
import platformdirs

F = TypeVar("F", bound=Callable[..., Any])

# A division by zero gives inf, which the loop finds, instead of a check and a branch at every division.
_njit: Any = partial(numba.njit, error_model="numpy")

_PACKAGE = Path(__file__).resolve().parent
_KERNEL_FOLDERS = ("control", "plant", "simulation")
_KERNEL_FILES = ("kernel.py", "space_vectors.py", "vectors.py", "sogi.py")


@cache
def kernel_digest() -> str:
    """Digest of all sources that compiled code is made from (16 hexadecimal digits)."""
    digest = hashlib.sha256(f"numba {numba.__version__}".encode())
    files = [_PACKAGE / name for name in _KERNEL_FILES]
    for folder in _KERNEL_FOLDERS:
        files += sorted((_PACKAGE / folder).rglob("*.py"))
    for file in files:
        digest.update(file.name.encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()[:16]


def cache_folder() -> Path:
    """Folder of the compiled code of this version of the sources; ``NUMBA_CACHE_DIR`` moves it."""
    root = os.environ.get("NUMBA_CACHE_DIR") or platformdirs.user_cache_dir("pvlvrt-compliance", appauthor=False)
    return Path(root) / f"kernels-{kernel_digest()}"


def kernel(function: F) -> F:
    """Compile a block: inlined into whatever calls it, never fast-math, float64.

    Only compiled code can call it (from Python, see `plain`): wrappers for Python would double the time to compile.
    """
    compiled: F = _njit(function, forceinline=True, no_cpython_wrapper=True, no_cfunc_wrapper=True)
    return compiled


def plain(function: F) -> F:
    """The Python behind a kernel, for the odd call outside compiled code that is not worth compiling for."""
    python: F = getattr(function, "py_func", function)
    return python


@cache
def in_python(function: F) -> F:
    """The Python behind a kernel and behind every kernel that it calls: to look at a block outside compiled code."""
    source: Any = plain(function)
    named = {name: source.__globals__.get(name) for name in source.__code__.co_names}
    called = {name: in_python(block) for name, block in named.items() if hasattr(block, "py_func")}
    python: Any = types.FunctionType(source.__code__, {**source.__globals__, **called}, source.__name__)
    return python  # type: ignore[no-any-return]


def cached_kernel(function: F) -> F:
    """Compile an entry point, which Python calls, and keep the machine code between processes.

    The global interpreter lock is released while it runs.
    """
    # numba reads the folder when the function is decorated; other users of numba in this process keep theirs.
    config: Any = numba.config
    before = config.CACHE_DIR
    config.CACHE_DIR = str(cache_folder())
    try:
        compiled: F = _njit(function, cache=True, nogil=True, no_cfunc_wrapper=True)
    except RuntimeError:  # no writable folder anywhere: compile every time rather than not at all
        compiled = _njit(function, nogil=True, no_cfunc_wrapper=True)
    finally:
        config.CACHE_DIR = before
    return compiled
