"""What a door is: the contract between the loop and every kind of controller from outside."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.simulation import ports
from pvlvrt_compliance.simulation.exchange import COMMANDS, SIGNALS
from pvlvrt_compliance.simulation.ports import REAL64, Memory, PortTable
from pvlvrt_compliance.units import Nominal

Value = float | int | bool | str

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

MODULATING, VOLTAGES = COMMANDS[:3], COMMANDS[3:]
"""Commands of a controller that modulates, and of one that commands voltages."""


class DoorError(UsageError):
    """A controller cannot be opened, or has stopped; the message is for its author."""


@dataclass(frozen=True)
class Port:
    """A place where a controller takes or gives numbers.

    Parameters
    ----------
    name, unit, description : str
        As the controller has them.
    mapped_to : str or None
        Signal that it is given, command that it gives, or the name it is recorded under; None: neither.
    width : int
        Numbers that it holds.
    note : str
        Why it is not mapped, where that needs saying.
    """

    name: str
    unit: str = ""
    description: str = ""
    mapped_to: str | None = None
    width: int = 1
    note: str = ""

    @property
    def is_loose(self) -> bool:
        """Whether the port, or an element of it, is tied to nothing."""
        return self.mapped_to is None or "-" in self.mapped_to.split(", ")


@dataclass(frozen=True)
class ParameterInfo:
    """A parameter of a controller, as ``--set controller.NAME=`` reaches it."""

    name: str
    value: Value
    unit: str = ""
    description: str = ""
    minimum: float | None = None
    maximum: float | None = None


@dataclass(frozen=True)
class Description:
    """What a controller says of itself.

    Parameters
    ----------
    kind : str
        Kind of door.
    name : str
        Name and version of the controller.
    digest : str
        SHA-256 of its file, or of what names it (hexadecimal).
    sample_time_s : float
        From one call to the next (s).
    notes : tuple of str
        What else there is to know of it.
    """

    kind: str
    name: str
    digest: str
    sample_time_s: float
    inputs: tuple[Port, ...] = ()
    outputs: tuple[Port, ...] = ()
    parameters: tuple[ParameterInfo, ...] = ()
    notes: tuple[str, ...] = ()

    def to_json(self) -> dict[str, Any]:
        """As plain dictionaries."""
        return asdict(self)

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "Description":
        """Back from plain dictionaries."""
        return cls(
            **{
                **data,
                "inputs": tuple(Port(**port) for port in data["inputs"]),
                "outputs": tuple(Port(**port) for port in data["outputs"]),
                "parameters": tuple(ParameterInfo(**parameter) for parameter in data["parameters"]),
                "notes": tuple(data["notes"]),
            }
        )


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


class DoorCall(NamedTuple):
    """An open door. Addresses are of functions ``int32_t f(void *argument)`` in this process that return 0 on success.

    A function that returns 1 has something to say: with a ``note_address``, that is called, and the run goes on.
    Memory and functions live until the door is closed; the door keeps them alive.
    """

    address: int  # advances the controller by one sample
    argument: int  # what it is called with
    inputs: Block  # written before every call
    outputs: Block  # read after it; held in between
    first_address: int = 0  # called once before all others, when the first inputs are there; 0: none
    hold_address: int = 0  # called before it as long as the controller does not act yet; 0: none
    note_address: int = 0  # called after a function has returned 1; 0: that is a failure
    in_volts: bool = False  # whether the outputs command voltages
    recorded: tuple[str, ...] = ()  # names of the further signals, by which they are recorded
    notes: Sequence[str] = ()  # what the controller has to say; grows as it runs


class Door(Protocol):
    """One kind of controller. Used in a process of its own: opened once, run once, closed."""

    def describe(self) -> Description:
        """Name, ports, parameters and sample time, known before it is opened.

        Raises
        ------
        DoorError
            When there is nothing to open.
        """

    def open(self, nominal: Nominal) -> DoorCall:
        """Make a controller at rest for an inverter of this rating, ready for its first sample.

        Raises
        ------
        DoorError
            When it refuses.
        """

    def message(self) -> str:
        """What the controller has said last, above all why it failed."""

    def close(self) -> None:
        """End the controller."""


def block_memory(size: int) -> NDArray[np.uint8]:
    """Zeros, at least so many bytes, aligned for any number."""
    return np.zeros((max(size, 8) + 7) // 8, dtype=np.float64).view(np.uint8)


def real_block(signals: Sequence[int]) -> Block:
    """Block of one real64 after another, mapped one to one to these signals."""
    elements = tuple(Element(signal, 8 * k) for k, signal in enumerate(signals))
    return Block(block_memory(8 * len(elements)), elements)


def port_table(block: Block) -> PortTable:
    """Block as the loop has it, in the order of the signals."""
    elements = sorted(block.elements)
    for element in elements:
        if element.byte % ITEM_SIZES[element.kind]:
            raise DoorError(f"a number at byte {element.byte} is not aligned to {ITEM_SIZES[element.kind]} bytes")
    size = len(block.memory)
    if size % 8:
        raise DoorError(f"a block has {size} bytes; it must be a multiple of 8")
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


def signal_index(name: str) -> int:
    """Index of a signal that can be given."""
    return SIGNALS.index(name)


def command_index(name: str) -> int:
    """Index of a command."""
    return COMMANDS.index(name)
