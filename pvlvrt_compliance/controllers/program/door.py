"""The door for another program, ``stdio:COMMAND`` or ``tcp://HOST:PORT``: one message a sample, one answer.

The protocol is in docs/controllers/program.md.
"""

import hashlib
import struct
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from pvlvrt_compliance.controllers.description import Description, Value
from pvlvrt_compliance.controllers.door import Door, DoorCall, DoorError
from pvlvrt_compliance.controllers.given_parameters import checked_parameters, seconds
from pvlvrt_compliance.controllers.mapping.commands import check_commands
from pvlvrt_compliance.controllers.mapping.constants import set_constants
from pvlvrt_compliance.controllers.mapping.file import load_mapping
from pvlvrt_compliance.controllers.mapping.sides import map_inputs, map_outputs
from pvlvrt_compliance.controllers.mapping.ties import Mapped, RawPort
from pvlvrt_compliance.controllers.program.hello import PortAnswer, as_line, greeting, hello_in, shown, table_in
from pvlvrt_compliance.controllers.program.link import STDIO, TCP, Conversation, command_of, files_of, link_to
from pvlvrt_compliance.simulation.door.blocks import Block, block_memory
from pvlvrt_compliance.simulation.door.native_call import FUNCTION, address_of, guarded
from pvlvrt_compliance.units import Nominal

TIMEOUT = "reply_timeout_s"
"""Parameter that every program takes here besides its own."""

SCHEMES = (STDIO, TCP)

_STARTING_S = 30.0  # to start, and to get ready
_REPLY_S = 10.0
_HEAD = 8  # bytes before the numbers of a block: the last four are the length of its frame


class ProgramDoor(Door):
    """Door for another program, which is greeted at once.

    Parameters
    ----------
    spec : str
        ``stdio:COMMAND`` or ``tcp://HOST:PORT``.
    given : mapping
        Parameters that the user has set; ``reply_timeout_s`` is not the program's but how long it may take to answer.
    mapping : str, optional
        Mapping file.

    Raises
    ------
    DoorError
        When it cannot be started or reached, does not answer as it should, or what is given does not fit it.
    """

    written = "stdio:COMMAND, tcp://HOST:PORT"
    schemes = SCHEMES

    def __init__(self, spec: str, given: Mapping[str, Value], mapping: str | None = None) -> None:
        self._spec, self._said, self._farewell = spec, "", as_line({"end": True})
        self._mapping_file = mapping
        self._mapping = load_mapping(mapping)
        self._reply_s = seconds(given, TIMEOUT) or _REPLY_S
        own = {name: value for name, value in given.items() if name != TIMEOUT}
        self._talk: Conversation | None = Conversation(link_to(spec, _STARTING_S), _STARTING_S)
        try:
            self._talk.tell(greeting(own))
            self._answer = self._talk.line()
            self._hello = hello_in(self._answer)
            self._given = checked_parameters(given, self._hello.parameter_infos(), besides=(TIMEOUT,))
        except DoorError:
            self.close()
            raise
        self._inputs, self._outputs = _laid_out(self._hello.inputs), _laid_out(self._hello.outputs)

    def describe(self) -> Description:
        """What it answered."""
        inputs, outputs = self._mapped(Nominal())
        found = self._hello.description(self._digest())
        return replace(found, inputs=inputs.ports, outputs=outputs.ports, mapping=self._mapping_file)

    def besides(self) -> str:
        """What a program reads and runs is not known."""
        here = "a program may read and run anything"
        return here if self.may_be_listed() else "it is not known what program runs behind an address"

    def may_be_listed(self) -> bool:
        """Of a program that is started here; one that runs already need not be that of its files."""
        return self._spec.startswith("stdio:")

    def open(self, nominal: Nominal) -> DoorCall:
        """Have it start, and make the function that the loop calls."""
        talk, binary = self._talk, self._hello.mode == "binary"
        assert talk is not None
        inputs, outputs = self._mapped(nominal)
        check_commands(outputs)
        memories = [block_memory(_HEAD + 8 * sum(p.width for p in ports)) for ports in (self._inputs, self._outputs)]
        set_constants(memories[0], inputs.constants)
        talk.tell(self._start(nominal))
        if table_in(talk.line()).get("ready") is not True:
            raise DoorError('it must answer the start by {"ready": true}')
        talk.timeout_s = self._reply_s
        if binary:
            self._farewell = struct.pack("<I", 0)
            exchange = _binary_exchange(talk, memories[0].data, memories[1].data)
        else:
            numbers = [memory.data.cast("d")[_HEAD // 8 :] for memory in memories]
            exchange = _json_exchange(talk, self._inputs, self._outputs, *numbers)
        function = FUNCTION(guarded(exchange, self._say))
        self._alive: Any = function
        return DoorCall(
            address=address_of(function),
            argument=0,
            inputs=Block(memories[0], inputs.elements),
            outputs=Block(memories[1], outputs.elements),
            in_volts=outputs.in_volts,
            in_a_frame=outputs.in_a_frame,
            every=self._hello.every,
            recorded=outputs.recorded,
        )

    def message(self) -> str:
        """Why the last exchange failed."""
        return self._said

    def close(self) -> None:
        """Tell the program that this is the end, and end it if it was started here."""
        talk, self._talk = self._talk, None
        if talk is not None:
            talk.end(self._farewell)

    def _start(self, nominal: Nominal) -> bytes:
        parameters = {name: p.value for name, p in self._hello.parameters.items()} | self._given
        rating = {
            "apparent_power_va": nominal.apparent_power_va,
            "phase_voltage_v": nominal.phase_voltage_v,
            "frequency_hz": nominal.frequency_hz,
        }
        return as_line({"start": {"nominal": rating, "parameters": parameters}})

    def _digest(self) -> str:
        """Of the files that a command names; of a program that runs elsewhere, what it answers."""
        digest = hashlib.sha256()
        files = files_of(command_of(self._spec)) if self.may_be_listed() else []
        for part in [file.read_bytes() for file in files] or [self._answer]:
            digest.update(hashlib.sha256(part).digest())
        return digest.hexdigest()

    def _mapped(self, nominal: Nominal) -> tuple[Mapped, Mapped]:
        return map_inputs(self._inputs, self._mapping, nominal), map_outputs(self._outputs, self._mapping, nominal)

    def _say(self, reason: str) -> None:
        self._said = reason


DOOR = ProgramDoor


def _laid_out(ports: Sequence[PortAnswer]) -> tuple[RawPort, ...]:
    """Ports as float64 one after another, after the head of the block."""
    raw, byte = [], _HEAD
    for port in ports:
        raw.append(RawPort(port.name, port.unit, port.width, byte, description=port.description))
        byte += 8 * port.width
    return tuple(raw)


def _binary_exchange(talk: Conversation, inputs: memoryview, outputs: memoryview) -> Callable[[], None]:
    """Exchange of frames: a length of four bytes, then float64, both little-endian."""
    begin = _HEAD - 4
    struct.pack_into("<I", inputs, begin, len(inputs) - _HEAD)
    expected = struct.pack("<I", len(outputs) - _HEAD)
    request, numbers = inputs[begin:], outputs[_HEAD:]
    size, tell, frame = len(numbers), talk.tell, talk.frame

    def exchange() -> None:
        tell(request)
        numbers[:] = frame(expected, size)

    return exchange


def _json_exchange(
    talk: Conversation, inputs: Sequence[RawPort], outputs: Sequence[RawPort], given: Any, taken: Any
) -> Callable[[], None]:
    """Exchange of lines of JSON."""
    template = "{" + ", ".join(f"{_word(p.name)}: {_places(p.width)}" for p in inputs) + "}\n"
    places = [(p.name, (p.byte - _HEAD) // 8, p.width) for p in outputs]
    tell, line = talk.tell, talk.line

    def exchange() -> None:
        tell((template % tuple(given)).encode())
        reply = table_in(answer := line())
        try:
            for name, place, width in places:
                if width == 1:
                    taken[place] = reply[name]
                else:
                    _take(reply[name], taken, place, width)
        except (TypeError, ValueError, KeyError) as error:
            raise DoorError(f"the program answered {shown(answer)}: {_what(error)}") from None

    return exchange


def _take(values: Any, taken: Any, place: int, width: int) -> None:
    if not isinstance(values, list) or len(values) != width:
        raise ValueError(f"a list of {width} numbers is due")
    for k, value in enumerate(values):
        taken[place + k] = value


def _what(error: Exception) -> str:
    if isinstance(error, KeyError):
        return f"there is no {error.args[0]!r}"
    return "a number is due" if isinstance(error, TypeError) else str(error)


def _word(name: str) -> str:
    """Name in JSON, for a template of Python."""
    return as_line({name: 0}).decode()[1:].rpartition(":")[0].replace("%", "%%")


def _places(width: int) -> str:
    return "%r" if width == 1 else "[" + ", ".join(["%r"] * width) + "]"
