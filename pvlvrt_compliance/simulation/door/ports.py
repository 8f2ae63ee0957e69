"""Numbers in the memory that a user's controller shares with the loop: typed places, each with a scale."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import kernel

CHAR, INT8, UINT8, INT16, UINT16, INT32, UINT32, REAL32, REAL64 = range(1, 10)
"""Types of a number, by the codes of the IEEE/CIGRE DLL interface (CIGRE TB 958)."""


class Memory(NamedTuple):
    """The same bytes as numbers of every type."""

    int8: NDArray[np.int8]
    uint8: NDArray[np.uint8]
    int16: NDArray[np.int16]
    uint16: NDArray[np.uint16]
    int32: NDArray[np.int32]
    uint32: NDArray[np.uint32]
    real32: NDArray[np.float32]
    real64: NDArray[np.float64]


class PortTable(NamedTuple):
    """Where numbers lie, and what they stand for: number = gain * signal + offset. Arrays of shape (numbers,)."""

    memory: Memory
    kind: NDArray[np.int64]  # code of the type
    place: NDArray[np.int64]  # index in the memory, seen as numbers of this type
    signal: NDArray[np.int64]  # index of the signal
    gain: NDArray[np.float64]  # units of the port per unit of the signal
    offset: NDArray[np.float64]  # units of the port


@kernel
def whole(value: float, low: float, high: float) -> float:
    """Nearest whole number in a range; what is not a number is 0."""
    if math.isnan(value):
        return 0.0
    return math.floor(min(max(value, low), high) + 0.5)


@kernel
def put_number(memory: Memory, kind: int, place: int, value: float) -> None:
    """Write a number; whole ones are rounded and stay in the range of their type."""
    if kind == REAL64:
        memory.real64[place] = value
    elif kind == REAL32:
        memory.real32[place] = value
    elif kind == INT32:
        memory.int32[place] = int(whole(value, -2147483648.0, 2147483647.0))
    elif kind == UINT32:
        memory.uint32[place] = int(whole(value, 0.0, 4294967295.0))
    elif kind == INT16:
        memory.int16[place] = int(whole(value, -32768.0, 32767.0))
    elif kind == UINT16:
        memory.uint16[place] = int(whole(value, 0.0, 65535.0))
    elif kind == UINT8:
        memory.uint8[place] = int(whole(value, 0.0, 255.0))
    else:
        memory.int8[place] = int(whole(value, -128.0, 127.0))


@kernel
def whole_number_at(memory: Memory, kind: int, place: int) -> int:
    """Read a whole number."""
    if kind == INT32:
        return int(memory.int32[place])
    if kind == UINT32:
        return int(memory.uint32[place])
    if kind == INT16:
        return int(memory.int16[place])
    if kind == UINT16:
        return int(memory.uint16[place])
    return int(memory.uint8[place]) if kind == UINT8 else int(memory.int8[place])


@kernel
def number_at(memory: Memory, kind: int, place: int) -> float:
    """Read a number."""
    if kind == REAL64:
        return float(memory.real64[place])
    if kind == REAL32:
        return float(memory.real32[place])
    return float(whole_number_at(memory, kind, place))


@kernel
def gather(signals: NDArray[np.float64], table: PortTable) -> None:
    """Write signals into the ports that they are mapped to."""
    for k in range(len(table.kind)):
        value = table.gain[k] * signals[table.signal[k]] + table.offset[k]
        put_number(table.memory, table.kind[k], table.place[k], value)


@kernel
def scatter(table: PortTable, signals: NDArray[np.float64]) -> None:
    """Read signals from the ports that they are mapped to."""
    for k in range(len(table.kind)):
        number = number_at(table.memory, table.kind[k], table.place[k])
        signals[table.signal[k]] = (number - table.offset[k]) / table.gain[k]
