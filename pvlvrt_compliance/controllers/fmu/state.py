"""What an FMU remembers, by the functions of FMI for states: taken from one instance, put into one of another process.

They are called where the standard has them: of an initialised instance between two steps, none of which has failed or
asked for the end. A state is freed by the instance that has made it; one that fails is let go of with all that it has.
"""

import ctypes
from collections.abc import Mapping
from typing import Any, NamedTuple

from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.fmu.instance import Fmu

_POINTER, _SIZE = ctypes.c_void_p, ctypes.c_size_t


class FmuState(NamedTuple):
    """Where an FMU was between two steps."""

    steps: int  # that it has done
    log: tuple[str, ...]  # what it had logged last
    state: bytes  # as it has serialised it


class _Functions(NamedTuple):
    """How a version of FMI spells them."""

    get: str
    put: str
    free: str
    size: str
    serialize: str
    deserialize: str


_NAMES: Mapping[str, _Functions] = {
    "2": _Functions(
        *("GetFMUstate", "SetFMUstate", "FreeFMUstate"),
        *("SerializedFMUstateSize", "SerializeFMUstate", "DeSerializeFMUstate"),
    ),
    "3": _Functions(
        *("GetFMUState", "SetFMUState", "FreeFMUState"),
        *("SerializedFMUStateSize", "SerializeFMUState", "DeserializeFMUState"),
    ),
}


def taken(fmu: Fmu) -> FmuState:
    """What an FMU remembers; it may go on after that.

    Raises
    ------
    DoorError
        When it does not give that, with what it has logged.
    """
    names, steps, log = _NAMES[fmu.version], fmu.steps, fmu.log
    state, size = ctypes.c_void_p(), ctypes.c_size_t()
    fmu.call(names.get, _at(state))
    fmu.call(names.size, (_POINTER, state.value), _at(size))
    content = _bytes(size.value)
    fmu.call(names.serialize, (_POINTER, state.value), _at(content), (_SIZE, len(content)))
    fmu.call(names.free, _at(state))
    return FmuState(steps, log, bytes(content))


def put_back(fmu: Fmu, kept: FmuState) -> None:
    """Have an instance that has been initialised go on from what another one remembered.

    Raises
    ------
    DoorError
        When it does not take that, with what it has logged.
    """
    names, state = _NAMES[fmu.version], ctypes.c_void_p()
    content = (ctypes.c_ubyte * len(kept.state)).from_buffer_copy(kept.state)
    fmu.call(names.deserialize, _at(content), (_SIZE, len(content)), _at(state))
    fmu.call(names.put, (_POINTER, state.value))
    fmu.call(names.free, _at(state))
    fmu.go_on(kept.steps, kept.log)


def _at(place: Any) -> tuple[Any, int]:
    """A place as an argument; it has to live as long as the call."""
    return _POINTER, ctypes.addressof(place)


def _bytes(size: int) -> Any:
    try:
        return (ctypes.c_ubyte * size)()
    except (MemoryError, OverflowError):
        raise DoorError(f"its state takes {size} bytes, as it says: there is no memory for that") from None
