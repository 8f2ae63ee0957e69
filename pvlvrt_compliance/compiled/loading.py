"""Object code of a function that takes and gives words (`flat`): as bytes, and loaded by LLVM, without numba."""

import ctypes
import json
import math
import pickle
import struct
import sys
from collections.abc import Sequence
from typing import Any, NamedTuple

from llvmlite import binding  # type: ignore[import-untyped]

from pvlvrt_compliance.compiled.flat import Kind, Result, layout

_FUNCTION = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_char_p, ctypes.c_char_p)
_RAISED = struct.Struct("=QQ")  # where what was raised is pickled, and in how many bytes


class ObjectCode(NamedTuple):
    """Objects of one function, and what there is to know of them."""

    entry: str  # name of the function that is called
    result: Any  # what `flat.Result` reads
    needs: list[str]  # names that are looked for outside the objects
    objects: tuple[bytes, ...]

    def written(self) -> bytes:
        """Everything as bytes."""
        head = [self.entry, self.result, self.needs, [len(x) for x in self.objects]]
        return b"\n".join([json.dumps(head).encode(), b"".join(self.objects)])


def read(data: bytes) -> ObjectCode:
    """Read what `ObjectCode.written` gave."""
    head, _, code = data.partition(b"\n")
    entry, result, needs, sizes = json.loads(head)
    objects = []
    for size in sizes:
        objects.append(code[:size])
        code = code[size:]
    return ObjectCode(entry, result, needs, tuple(objects))


class Loaded:
    """A function in this process; the interpreter's lock is released while it runs.

    Raises
    ------
    UnresolvedError
        When something that it needs is nowhere.
    """

    def __init__(self, code: ObjectCode, kinds: Sequence[Kind]) -> None:
        _find(code.needs)
        self._engine = _engine()
        for data in code.objects:
            self._engine.add_object_file(binding.ObjectFileRef.from_data(data))
        self._engine.finalize_object()
        self._function = _FUNCTION(self._engine.get_function_address(code.entry))
        self._result = Result(code.result)
        self._given, self._taken = struct.Struct(layout(kinds)), struct.Struct(f"={self._result.layout}")

    def __call__(self, words: Sequence[Any]) -> Any:
        """Call it with the words of its arguments."""
        taken = ctypes.create_string_buffer(max(self._taken.size, _RAISED.size))
        if self._function(self._given.pack(*words), taken):
            error, arguments, *_ = pickle.loads(ctypes.string_at(*_RAISED.unpack_from(taken)))
            raise error(*arguments)
        return self._result.built(iter(self._taken.unpack_from(taken)))


_OF_MATHEMATICS = ("expm1", "log1p", "atan2", "hypot", "cbrt")
"""Functions of C's library that compiled code calls by their names."""


class UnresolvedError(Exception):
    """Code needs something that is nowhere."""


def _find(names: Sequence[str]) -> None:
    """See that all names are known to LLVM, which ends the process where one is not.

    What a platform's own libraries lack, and memory that compiled code allocates, are numba's.
    """
    if sys.platform != "win32" and not _missing(_mathematics(names)):
        return
    from numba.core.registry import cpu_target

    context: Any = cpu_target.target_context
    context.refresh()
    if missing := _missing(names):
        raise UnresolvedError(", ".join(missing))


def _mathematics(names: Sequence[str]) -> Sequence[str]:
    """The same names, once LLVM knows those of them that Python's own `math` has from C's library."""
    missing = _missing(names)
    if missing:
        library = ctypes.CDLL(getattr(math, "__file__", None))  # built in where it has no file
        for name in missing:
            if name in _OF_MATHEMATICS and (function := getattr(library, name, None)) is not None:
                binding.add_symbol(name, ctypes.cast(function, ctypes.c_void_p).value)
    return names


def _missing(names: Sequence[str]) -> list[str]:
    return [name for name in names if binding.address_of_symbol(name) is None]


def _engine() -> Any:
    """Make what holds code: one for each function, so that no name meets its like."""
    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    triple = binding.get_process_triple()
    module = binding.parse_assembly("")
    module.triple = triple
    return binding.create_mcjit_compiler(module, binding.Target.from_triple(triple).create_target_machine(jit=True))
