"""Memory that loop and controller share: plain data that says which number of which type lies where.

What is open is told so by whoever has opened it; `port_table` gives it the form in which compiled code reads it.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.simulation.door import ports
from pvlvrt_compliance.simulation.door.exchange import COMMANDED_M, COMMANDED_U, COMMANDS
from pvlvrt_compliance.simulation.door.ports import REAL64, Memory, PortTable

NUMBER_TYPES: Mapping[int, type[np.number]] = {
    ports.CHAR: np.int8,
    ports.INT8: np.int8,
    ports.UINT8: np.uint8,
    ports.INT16: np.int16,
    ports.UINT16: np.uint16,
    ports.INT32: np.int32,
    ports.UINT32: np.uint32,
    ports.REAL32: np.float32,
    ports.REAL64: np.float64,
}
"""Type of a number by its code."""

ITEM_SIZES = {code: np.dtype(number).itemsize for code, number in NUMBER_TYPES.items()}
"""Bytes of a number by the code of its type."""

MODULATING, VOLTAGES = (tuple(COMMANDS[place] for place in places) for places in (COMMANDED_M, COMMANDED_U))
IN_A_FRAME = ("u_d_ref_v", "u_q_ref_v", "angle_rad")
"""Commands of a controller that modulates, and of one that commands voltages: by phase, or in a frame that turns."""


class Element(NamedTuple):
    """One number in a block: number = gain * signal + offset."""

    signal: int  # index in `SIGNALS`; of outputs in `COMMANDS`, and beyond it the further signals in order
    byte: int  # offset in the memory, a multiple of the number's size
    kind: int = REAL64  # code of its type
    gain: float = 1.0  # units of the port per unit of the signal; of outputs not 0
    offset: float = 0.0  # units of the port


class Block(NamedTuple):
    """Memory that loop and controller share, and the numbers in it that the loop writes or reads."""

    memory: NDArray[np.uint8]
    elements: tuple[Element, ...]


def block_memory(size: int) -> NDArray[np.uint8]:
    """Zeros, at least so many bytes, aligned for any number."""
    return np.zeros((max(size, 8) + 7) // 8, dtype=np.float64).view(np.uint8)


def real_block(signals: Sequence[int]) -> Block:
    """Block of one real64 after another, mapped one to one to these signals."""
    elements = tuple(Element(signal, 8 * k) for k, signal in enumerate(signals))
    return Block(block_memory(8 * len(elements)), elements)


def port_table(block: Block) -> PortTable:
    """Block as the loop has it, in the order of the signals.

    Raises
    ------
    UsageError
        When a number or the block is not aligned.
    """
    elements = sorted(block.elements)
    for element in elements:
        if element.byte % ITEM_SIZES[element.kind]:
            raise UsageError(f"a number at byte {element.byte} is not aligned to {ITEM_SIZES[element.kind]} bytes")
    size = len(block.memory)
    if size % 8:
        raise UsageError(f"a block has {size} bytes; it must be a multiple of 8")
    x = block.memory
    return PortTable(
        memory=Memory(
            int8=x.view(np.int8),
            uint8=x.view(np.uint8),
            int16=x.view(np.int16),
            uint16=x.view(np.uint16),
            int32=x.view(np.int32),
            uint32=x.view(np.uint32),
            real32=x.view(np.float32),
            real64=x.view(np.float64),
        ),
        kind=np.array([e.kind for e in elements], dtype=np.int64),
        place=np.array([e.byte // ITEM_SIZES[e.kind] for e in elements], dtype=np.int64),
        signal=np.array([e.signal for e in elements], dtype=np.int64),
        gain=np.array([e.gain for e in elements], dtype=np.float64),
        offset=np.array([e.offset for e in elements], dtype=np.float64),
    )
