"""Calling a C function by its address from compiled code."""

import ctypes
from collections.abc import Callable
from typing import Any

from pvlvrt_compliance.kernel import instructions
from pvlvrt_compliance.simulation.door.ending import keep

FUNCTION = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p)
"""What is at the address: ``int32_t function(void *argument)``, 0 when all is well."""

FAILED = 2
"""What a function returns that has failed; 1 is for one that only has something to say."""


def address_of(function: Any) -> int:
    """Address of a function of C; 0 of None."""
    return 0 if function is None else int(ctypes.cast(function, ctypes.c_void_p).value or 0)


def guarded(do: Callable[[], None], tell: Callable[[str], None]) -> Callable[[Any], int]:
    """Python to stand at an address: whatever is raised is told and counts as a failure."""

    def call(_argument: Any) -> int:
        try:
            do()
        except BaseException as error:
            keep(error)
            tell(str(error) or repr(error))
            return FAILED
        return 0

    return call


def _call_compiled(typing_context: Any, address: Any, argument: Any) -> Any:
    """Address and argument are plain integers at run time, so that compiled code is the same for every library."""
    from llvmlite import ir  # type: ignore[import-untyped]
    from numba import types

    del typing_context, address, argument

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        del context, signature
        pointer = ir.IntType(8).as_pointer()
        function = ir.FunctionType(ir.IntType(32), [pointer]).as_pointer()
        return builder.call(builder.inttoptr(arguments[0], function), [builder.inttoptr(arguments[1], pointer)])

    return types.int32(types.int64, types.int64), generate


def _call_interpreted(address: int, argument: int) -> int:
    return int(FUNCTION(address)(argument))


call_address: Any = instructions(_call_compiled, _call_interpreted)
"""``call_address(address, argument) -> int32``, for compiled code (for Python, where compilation is turned off)."""
