"""The door for another program, ``stdio:COMMAND`` or ``tcp://HOST:PORT``: one message a sample, one answer.

The protocol is in docs/controllers/program.md.
"""

import hashlib
import math
import struct
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from pvlvrt_compliance.controllers.debugging import is_debugged
from pvlvrt_compliance.controllers.description import Description, Value
from pvlvrt_compliance.controllers.door import Door, DoorCall, DoorError
from pvlvrt_compliance.controllers.faults import RAISED, Faults
from pvlvrt_compliance.controllers.file import content_of
from pvlvrt_compliance.controllers.given_parameters import checked_parameters, seconds
from pvlvrt_compliance.controllers.mapping.as_far import both_sides, loaded
from pvlvrt_compliance.controllers.mapping.bare import both_bare
from pvlvrt_compliance.controllers.mapping.commands import check_commands
from pvlvrt_compliance.controllers.mapping.constants import set_constants
from pvlvrt_compliance.controllers.mapping.file import check_alone
from pvlvrt_compliance.controllers.mapping.ties import Mapped, RawPort
from pvlvrt_compliance.controllers.notes import of_slow_task
from pvlvrt_compliance.controllers.program.exchange import HEAD, binary_exchange, json_exchange
from pvlvrt_compliance.controllers.program.hello import (
    Hello,
    PortAnswer,
    as_line,
    greeting,
    hello_in,
    table_in,
    usable_of,
)
from pvlvrt_compliance.controllers.program.link import STDIO, TCP, Conversation, command_of, files_of, link_to
from pvlvrt_compliance.simulation.door.blocks import Block, block_memory
from pvlvrt_compliance.simulation.door.exchange import SIGNALS
from pvlvrt_compliance.simulation.door.native_call import FUNCTION, address_of, guarded
from pvlvrt_compliance.units import Nominal

TIMEOUT = "reply_timeout_s"
"""Parameter that every program takes here besides its own."""

SLOW_TASK_DUE = "slow_task_due"
"""Signal that says in which samples a slow task is due."""

SCHEMES = (STDIO, TCP)

_STARTING_S = 30.0  # to start, and to get ready
_REPLY_S = 10.0


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
    allow_out_of_range : bool
        Whether a parameter may be out of the range that it states for it.

    Raises
    ------
    DoorError
        When it cannot be started or reached, does not answer as it should, or what is given does not fit it.
    """

    written = "stdio:COMMAND, tcp://HOST:PORT"
    schemes = SCHEMES
    keeps_faults = True

    def __init__(
        self,
        spec: str,
        given: Mapping[str, Value],
        mapping: str | None = None,
        faults: Faults = RAISED,
        *,
        allow_out_of_range: bool = False,
    ) -> None:
        self._spec, self._said, self._farewell = spec, "", as_line({"end": True})
        self._faults, self._talk = faults, None
        self._mapping_file = mapping
        self._mapping = loaded(mapping, faults)
        self._reply_s = _patience(_REPLY_S)
        with faults.told():
            self._reply_s = seconds(given, TIMEOUT) or self._reply_s
        self._given: dict[str, Value] = {}
        try:
            self._hello = self._greeted({name: value for name, value in given.items() if name != TIMEOUT})
            with faults.told():
                known = self._hello.parameter_infos()
                self._given = checked_parameters(given, known, None, (TIMEOUT,), allow_out_of_range)
        except DoorError:
            self.close()
            with faults.told():
                check_alone(self._mapping)
            raise
        self._inputs, self._outputs = _laid_out(self._hello.inputs), _laid_out(self._hello.outputs)

    _talk: Conversation | None
    _unusable = ""

    def _greeted(self, own: Mapping[str, Value]) -> Hello:
        """Answer to the greeting; where faults are kept, what can be used of it.

        Raises
        ------
        DoorError
            When there is none, or it cannot be used.
        """
        self._talk = Conversation(link_to(self._spec, _STARTING_S), _patience(_STARTING_S))
        self._talk.tell(greeting(own))
        self._answer = self._talk.line()
        try:
            return hello_in(self._answer)
        except DoorError as error:
            self._faults.tell(str(error))
            self._unusable = str(error)
        found = usable_of(self._answer)
        if found is None and own:  # it may have given up because of its parameters
            self.close()
            return self._greeted({})
        if found is None:
            raise DoorError(self._unusable)
        return found

    def describe(self) -> Description:
        """What it answered."""
        inputs, outputs = self._mapped(Nominal())
        found = self._hello.description(self._digest())
        notes = of_slow_task(self._hello.every, found.sample_time_s)
        if notes and SIGNALS.index(SLOW_TASK_DUE) not in {element.signal for element in inputs.elements}:
            notes += (
                f"none of its inputs is tied to {SLOW_TASK_DUE}, which says where that is due: it has to count itself",
            )
        return replace(found, notes=notes, inputs=inputs.ports, outputs=outputs.ports, mapping=self._mapping_file)

    def besides(self) -> str:
        """What a program reads and runs is not known."""
        here = "a program may read and run anything"
        return here if self.may_be_listed() else "it is not known what program runs behind an address"

    def may_be_listed(self) -> bool:
        """Of a program that is started here; one that runs already need not be that of its files."""
        return self._spec.startswith("stdio:")

    def open(self, nominal: Nominal) -> DoorCall:
        """Have it start, and make the function that the loop calls."""
        if self._unusable:
            raise DoorError(self._unusable)
        talk, binary = self._talk, self._hello.mode == "binary"
        assert talk is not None
        inputs, outputs = self._mapped(nominal)
        if not self._faults.kept:
            check_commands(outputs)
        memories = [block_memory(HEAD + 8 * sum(p.width for p in ports)) for ports in (self._inputs, self._outputs)]
        set_constants(memories[0], inputs.constants)
        talk.tell(self._start(nominal))
        if table_in(talk.line()).get("ready") is not True:
            raise DoorError('it must answer the start by {"ready": true}')
        talk.timeout_s = self._reply_s
        if binary:
            self._farewell = struct.pack("<I", 0)
            exchange = binary_exchange(talk, memories[0].data, memories[1].data)
        else:
            numbers = [memory.data.cast("d")[HEAD // 8 :] for memory in memories]
            exchange = json_exchange(talk, self._inputs, self._outputs, *numbers)
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

    def snapshot(self) -> Any:
        """A program has its memory to itself."""
        raise DoorError("a program does not give what it remembers")

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
        for part in [content_of(file) for file in files] or [self._answer]:
            digest.update(hashlib.sha256(part).digest())
        return digest.hexdigest()

    def _mapped(self, nominal: Nominal) -> tuple[Mapped, Mapped]:
        if self.bare:
            return both_bare(self._inputs, self._outputs)
        return both_sides(self._inputs, self._outputs, self._mapping, nominal, self._faults)

    def _say(self, reason: str) -> None:
        self._said = reason


DOOR = ProgramDoor


def _patience(most_s: float) -> float:
    """How long a program may take to answer (s); one that is debugged may be stopped for as long as anybody likes."""
    return math.inf if is_debugged() else most_s


def _laid_out(ports: Sequence[PortAnswer]) -> tuple[RawPort, ...]:
    """Ports as float64 one after another, after the head of the block."""
    raw, byte = [], HEAD
    for port in ports:
        raw.append(RawPort(port.name, port.unit, port.width, byte, description=port.description))
        byte += 8 * port.width
    return tuple(raw)
