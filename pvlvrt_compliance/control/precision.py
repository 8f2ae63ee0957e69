"""Single precision: what a controller that computes with 32-bit numbers keeps from one sample to the next.

Everything that the controller reads, remembers and puts out is rounded to single precision; within a sample the sums
are those of double precision, so this is the least that 32-bit arithmetic does.
"""

import types
from typing import Any, NamedTuple, get_args, get_type_hints

import numpy as np
from numba.core.types import NoneType
from numba.extending import overload

from pvlvrt_compliance.control.controller import ControllerSignals, ControllerState, Measured
from pvlvrt_compliance.kernel import kernel


@kernel
def single_float(x: float) -> float:
    """Nearest number of single precision."""
    return np.float64(np.float32(x))


@kernel
def single_complex(x: complex) -> complex:
    """Nearest vector of single precision."""
    return complex(np.float64(np.float32(x.real)), np.float64(np.float32(x.imag)))


def _if_there(rounding: Any) -> Any:
    """The same for what may be none, decided by its type, as numba would make an optional of it otherwise."""

    def if_there(x: Any) -> Any:
        return None if x is None else rounding(x)

    @overload(if_there)
    def _of_type(x):  # type: ignore[no-untyped-def] # numba compares the annotations with those of the lambdas
        return (lambda x: None) if isinstance(x, NoneType) else (lambda x: rounding(x))  # noqa: ARG005, PLW0108

    return if_there


def _rounding(named_tuple: type[NamedTuple]) -> Any:
    """Kernel that rounds every number of a NamedTuple and of those within; what is none, whole or an array stays.

    Written out field by field from the annotations: numba can neither loop over fields of different types nor recurse.
    """
    known: dict[str, Any] = {"Tuple": named_tuple}
    fields = []
    for name, hint in get_type_hints(named_tuple).items():
        inner = next((part for part in get_args(hint) or (hint,) if hasattr(part, "_fields")), None)
        if inner is not None:
            known[f"round_{name}"] = _if_there(_rounding(inner)) if type(None) in get_args(hint) else _rounding(inner)
        elif hint is float:
            known[f"round_{name}"] = single_float
        elif hint is complex:
            known[f"round_{name}"] = single_complex
        fields.append(f"{name}=round_{name}(x.{name})" if f"round_{name}" in known else f"{name}=x.{name}")
    source = f"def rounded(x):\n    return Tuple({', '.join(fields)})\n"
    code = next(part for part in compile(source, __file__, "exec").co_consts if isinstance(part, types.CodeType))
    return kernel(types.FunctionType(code, known, f"single_{named_tuple.__name__}"))


single_measured = _rounding(Measured)
single_state = _rounding(ControllerState)
single_signals = _rounding(ControllerSignals)
