"""Arguments and results of compiled code as plain words: what a function takes that knows nothing of Python.

A word has 8 bytes. A number is one (a complex one two, or one of two halves in single precision), an array its address,
lengths and strides, a tuple its parts one after another, and none nothing.
"""

import ctypes
import importlib
from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

SCALARS: dict[str, str] = {"f8": "d", "f4": "f4x", "c16": "dd", "c8": "ff", "i8": "q", "u8": "Q", "b1": "?7x"}
"""Format of `struct` by kind of number."""

NONE = "none"

_KINDS: dict[type, str] = {
    **{float: "f8", complex: "c16", int: "i8", bool: "b1", type(None): NONE},
    **{np.float64: "f8", np.float32: "f4", np.complex128: "c16", np.complex64: "c8", np.int64: "i8", np.bool_: "b1"},
}
_DTYPES = "biufc"

_C_ORDER, _F_ORDER, _ALIGNED, _WRITEABLE = 0x1, 0x2, 0x100, 0x400  # of `numpy.ndarray.flags.num`


class NotFlatError(Exception):
    """Something is no number, array, tuple or none."""


class ArrayKind(NamedTuple):
    """What compiled code knows of an array beforehand."""

    dtype: str
    ndim: int
    order: str  # "C", "F" or, if neither, "A"
    writeable: bool


Kind = str | ArrayKind | tuple[type, int]
"""Of a number or none, of an array, or class and length of a tuple, whose parts follow."""


class Flat(NamedTuple):
    """Arguments: what they are, and their words."""

    kinds: tuple[Kind, ...]
    words: list[Any]


def flat(arguments: Iterable[Any]) -> Flat:
    """Take arguments apart.

    Raises
    ------
    NotFlatError
        When there is something else among them.
    """
    kinds: list[Kind] = []
    words: list[Any] = []
    for x in arguments:
        _take(x, kinds, words)
    return Flat(tuple(kinds), words)


def _take(x: Any, kinds: list[Kind], words: list[Any]) -> None:
    of = type(x)
    kind = _KINDS.get(of)
    if kind is not None:
        kinds.append(kind)
        if kind in ("c16", "c8"):
            words += (x.real, x.imag)
        elif kind != NONE:
            words.append(x)
    elif isinstance(x, tuple):
        kinds.append((of, len(x)))
        for part in x:
            _take(part, kinds, words)
    elif of is np.ndarray:
        kinds.append(_array_kind(x.dtype, x.ndim, x.flags.num))
        words += (_address(x), *x.shape, *x.strides)
    else:
        raise NotFlatError(f"{of.__module__}.{of.__qualname__}")


@lru_cache(maxsize=256)
def _array_kind(dtype: Any, ndim: int, flags: int) -> ArrayKind:
    """Kind of an array by its flags, all in one number: numpy takes as long to tell each as to tell all."""
    if not (dtype.isnative and dtype.kind in _DTYPES and flags & _ALIGNED):
        raise NotFlatError(f"numpy.ndarray of {dtype}")
    order = "C" if flags & _C_ORDER else "F" if flags & _F_ORDER else "A"
    return ArrayKind(dtype.str, ndim, order, bool(flags & _WRITEABLE))


def _address(x: Any) -> int:
    """Where the numbers of an array lie; of one that may be written, by a way four times as fast."""
    try:
        return ctypes.addressof(ctypes.c_char.from_buffer(x))
    except (TypeError, ValueError, BufferError):
        address: int = x.__array_interface__["data"][0]
        return address


def layout(kinds: Iterable[Kind]) -> str:
    """Format of `struct` of the words."""
    parts = ["="]
    for kind in kinds:
        if isinstance(kind, ArrayKind):
            parts.append("q" * (1 + 2 * kind.ndim))
        elif isinstance(kind, str):
            parts.append(SCALARS.get(kind, ""))
    return "".join(parts)


def spelt(kinds: Iterable[Kind]) -> str:
    """Spell kinds in the same words in every process."""
    return " ".join(kind if isinstance(kind, str) else _spelt(kind) for kind in kinds)


def _spelt(kind: ArrayKind | tuple[type, int]) -> str:
    if isinstance(kind, ArrayKind):
        return f"{kind.dtype}[{kind.ndim}{kind.order}{'' if kind.writeable else ' read-only'}]"
    of, length = kind
    return f"{of.__module__}.{of.__qualname__}({length}:{','.join(getattr(of, '_fields', ()))})"


class Result:
    """What a function returns: a kind of number, none, or ``[class, part, ...]``, with the class as ``module:name``."""

    def __init__(self, written: Any) -> None:
        self._kind = written if isinstance(written, str) else None
        self._of = _class_of(written[0]) if self._kind is None else tuple
        self._parts = [Result(part) for part in written[1:]] if self._kind is None else []

    @property
    def layout(self) -> str:
        """Format of `struct` of its words, without what stands before the first."""
        return SCALARS.get(self._kind or "", "") + "".join(part.layout for part in self._parts)

    def built(self, words: Iterator[Any]) -> Any:
        """Put it together."""
        if self._kind is None:
            parts = [part.built(words) for part in self._parts]
            return self._of(*parts) if hasattr(self._of, "_fields") else tuple(parts)
        if self._kind == NONE:
            return None
        return complex(next(words), next(words)) if self._kind in ("c16", "c8") else next(words)


def _class_of(name: str) -> Any:
    module, _, path = name.partition(":")
    found: Any = importlib.import_module(module)
    for part in path.split("."):
        found = getattr(found, part)
    return found
