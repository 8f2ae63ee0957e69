"""One controller in C at work: the memory that it works in, its calls, what it says, snapshots."""

import ctypes
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.controllers.description import Value
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.library.info import EMT, LibraryInfo, text_of
from pvlvrt_compliance.controllers.library.layout import (
    C_STRING,
    TYPES,
    Instance,
    Layout,
    Member,
    layout_of,
    one_after_another,
)
from pvlvrt_compliance.controllers.notes import note_once
from pvlvrt_compliance.simulation.door.blocks import block_memory
from pvlvrt_compliance.texts import shortened

OK, MESSAGE, ERROR = range(3)
"""What a function of a library returns."""

_LONGEST = 2000  # characters of a message


class Snapshot(NamedTuple):
    """Everything that the interface lets a controller remember, as bytes."""

    time: float  # of the latest call (s)
    inputs: bytes
    outputs: bytes
    parameters: bytes
    int_states: bytes
    float_states: bytes
    double_states: bytes


class LibraryInstance:
    """Memory of one controller: Instance, inputs, outputs, parameters and states lie in one array.

    So the loop writes Instance.Time as it writes any input, and calls the library's functions by their address.

    Parameters
    ----------
    info : LibraryInfo
        What the library announces.
    settings : mapping
        Value of every parameter.
    """

    def __init__(self, info: LibraryInfo, settings: Mapping[str, Value]) -> None:
        self._info = info
        members = [Member(p.kind) for p in info.parameters]
        self.input_layout = layout_of([port.member for port in info.inputs])
        self.output_layout = layout_of([port.member for port in info.outputs])
        self._parameter_layout = layout_of(members)
        self._sizes = (
            ctypes.sizeof(Instance),
            self.input_layout.size,
            self.output_layout.size,
            self._parameter_layout.size,
            4 * info.int_states,
            4 * info.float_states,
            8 * info.double_states,
        )
        self._places: Layout = one_after_another(self._sizes)
        self.memory: NDArray[np.uint8] = block_memory(self._places.size)
        self._address = int(self.memory.ctypes.data)
        self.instance: Any = Instance.from_address(self._address)
        self._texts: list[Any] = []  # kept alive
        self.notes: list[str] = []
        self._point()
        self._put(settings)

    @property
    def address(self) -> int:
        """Address of the Instance: what every function is called with."""
        return self._address

    @property
    def inputs_at(self) -> int:
        """Place of the inputs in the memory (byte)."""
        return self._places.offsets[1]

    @property
    def outputs_at(self) -> int:
        """Place of the outputs in the memory (byte)."""
        return self._places.offsets[2]

    @property
    def time_at(self) -> int:
        """Place of Instance.Time in the memory (byte)."""
        return int(Instance.Time.offset)

    def parameters(self) -> dict[str, Value]:
        """Parameters as they are now; the library may have changed them."""
        return {p.name: self._parameter(k) for k, p in enumerate(self._info.parameters)}

    def call(self, function: Any, name: str) -> None:
        """Call a function of the library; what it says is noted.

        Raises
        ------
        DoorError
            When it fails, with what it says.
        """
        answer = function(self._address)
        if answer not in (OK, MESSAGE):
            raise DoorError(f"{name} failed: {self.error() or f'it returned {answer}'}")
        self.note()

    def note(self) -> None:
        """Keep the latest message of the library, once."""
        note_once(self.notes, _text_at(self.instance.LastGeneralMessage))

    def error(self) -> str:
        """Its latest error."""
        return _text_at(self.instance.LastErrorMessage)

    def snapshot(self) -> Snapshot:
        """What the controller remembers.

        Raises
        ------
        DoorError
            When it keeps no state where the interface has it.
        """
        if not self._info.keeps_states:
            raise DoorError("the controller keeps no state in the arrays of the interface: no snapshot can be made")
        return Snapshot(float(self.instance.Time), *(self._part(k).tobytes() for k in range(1, len(self._sizes))))

    def restore(self, snapshot: Snapshot) -> None:
        """Put back what a controller of the same library remembered, in this or another process.

        A library that exports Model_FirstCall wants it called next.

        Raises
        ------
        DoorError
            When the snapshot is not of this library.
        """
        parts = snapshot[1:]
        if tuple(map(len, parts)) != self._sizes[1:]:
            raise DoorError("the snapshot is of another controller")
        texts = {k: value for k, value in enumerate(self._text_addresses()) if value is not None}
        for k, part in enumerate(parts, start=1):
            self._part(k)[:] = np.frombuffer(part, dtype=np.uint8)
        for k, value in texts.items():  # where a text lies is this instance's affair
            self._member(k, ctypes.c_void_p).value = value
        self.instance.Time = snapshot.time

    def _point(self) -> None:
        at = [self._address + offset for offset in self._places.offsets]
        i = self.instance
        i.ExternalInputs, i.ExternalOutputs, i.Parameters = at[1:4]
        i.IntStates, i.FloatStates, i.DoubleStates = at[4:7]
        i.SimTool_EMT_RMS_Mode = EMT

    def _part(self, k: int) -> NDArray[np.uint8]:
        begin = self._places.offsets[k]
        return self.memory[begin : begin + self._sizes[k]]

    def _member(self, k: int, kind: Any) -> Any:
        return kind.from_address(self._address + self._places.offsets[3] + self._parameter_layout.offsets[k])

    def _put(self, settings: Mapping[str, Value]) -> None:
        for k, p in enumerate(self._info.parameters):
            value: Any = settings[p.name]
            if p.kind == C_STRING:
                self._texts.append(ctypes.create_string_buffer(str(value).encode()))
                self._member(k, ctypes.c_void_p).value = ctypes.addressof(self._texts[-1])
            else:
                self._member(k, _number_type(p.kind)).value = value

    def _parameter(self, k: int) -> Value:
        kind = self._info.parameters[k].kind
        if kind == C_STRING:
            return _text_at(self._member(k, ctypes.c_void_p).value)
        found: Value = self._member(k, _number_type(kind)).value
        return found

    def _text_addresses(self) -> Sequence[int | None]:
        kinds = [p.kind for p in self._info.parameters]
        return [self._member(k, ctypes.c_void_p).value if c == C_STRING else None for k, c in enumerate(kinds)]


def _number_type(kind: int) -> Any:
    """Type of a number; a char is one, too."""
    return ctypes.c_int8 if TYPES[kind] is ctypes.c_char else TYPES[kind]


def _text_at(address: int | None) -> str:
    if not address:
        return ""
    return shortened(text_of(ctypes.cast(address, ctypes.c_char_p).value), _LONGEST)
