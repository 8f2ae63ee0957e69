"""Which plant signal each port of a controller is given, and which command it gives: by a mapping file, or by name."""

from collections.abc import Iterable, Sequence
from typing import Any

from pvlvrt_compliance.controllers.channels import TAKEN, check_channel
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.mapping.channel_units import scale_of_channel
from pvlvrt_compliance.controllers.mapping.commands import of_a_kind
from pvlvrt_compliance.controllers.mapping.constants import Constant
from pvlvrt_compliance.controllers.mapping.described import into_the_inverter
from pvlvrt_compliance.controllers.mapping.file import InputEntry, MappingFile, OutputEntry, check_alone, refusal
from pvlvrt_compliance.controllers.mapping.names import Guess, Hints, guess_input, guess_output
from pvlvrt_compliance.controllers.mapping.port_units import Bases, Scale, scale_of
from pvlvrt_compliance.controllers.mapping.quantities import QUANTITIES
from pvlvrt_compliance.controllers.mapping.telling import NO_CHANNEL
from pvlvrt_compliance.controllers.mapping.ties import INVERTED, Mapped, RawPort, Side, Slot, Tie, tied
from pvlvrt_compliance.simulation.door.blocks import Element
from pvlvrt_compliance.simulation.door.exchange import COMMANDS, SIGNALS, SWITCHES
from pvlvrt_compliance.units import Nominal

_WHAT = "the ports of the controller cannot be tied to the plant"


def map_ports(
    inputs: Sequence[RawPort], outputs: Sequence[RawPort], mapping: MappingFile | None, nominal: Nominal
) -> tuple[Mapped, Mapped]:
    """Tie both sides: see `map_inputs` and `map_outputs`.

    Raises
    ------
    DoorError
        With all that is wrong with the file, by itself and with these ports, at once.
    """
    mapping = mapping or MappingFile()
    given, wrong = _inputs(inputs, mapping, nominal)
    commanded, wrong_too = _outputs(outputs, mapping, nominal)
    if not (wrong or wrong_too):
        check_alone(mapping)
    _refuse((*mapping.mistakes, *wrong, *wrong_too))
    return given, commanded


def map_inputs(ports: Sequence[RawPort], mapping: MappingFile | None, nominal: Nominal) -> Mapped:
    """Tie inputs to plant signals and constants: as the file says, else by name where that is clear.

    Raises
    ------
    DoorError
        When the file names a port or signal that is not there, or a unit does not fit; all problems at once.
    """
    mapped, problems = _inputs(ports, mapping or MappingFile(), nominal)
    _refuse(problems)
    return mapped


def map_outputs(ports: Sequence[RawPort], mapping: MappingFile | None, nominal: Nominal) -> Mapped:
    """Tie outputs to commands and to channels of the record: as the file says, else by name where that is clear.

    Whether all commands are given is in ``missing``: see `commands.check_commands`.

    Raises
    ------
    DoorError
        When the file names a port or command that is not there, two outputs give one command, or a unit does not fit.
    """
    mapped, problems = _outputs(ports, mapping or MappingFile(), nominal)
    _refuse(problems)
    return mapped


def _refuse(problems: Iterable[str]) -> None:
    if found := tuple(dict.fromkeys(problems)):
        raise refusal(_WHAT, found)


def _inputs(ports: Sequence[RawPort], mapping: MappingFile, nominal: Nominal) -> tuple[Mapped, tuple[str, ...]]:
    def tie(slot: Slot, entry: InputEntry, name: str | None) -> Tie:
        if name is None:
            value = float(entry.constant or 0.0)
            return Tie(f"{value:g}", None, Constant(slot.byte, slot.port.kind, value))
        scale = _scaled(slot, entry, name, mapping.bases, nominal)
        if not _said(slot, mapping) and (words := into_the_inverter(name, slot.port.description)):
            raise DoorError(_direction_of(name, words))
        sign = entry.sign * _direction(entry, name, mapping)
        return Tie(name, Element(SIGNALS.index(name), slot.byte, slot.port.kind, sign * scale.gain, scale.offset))

    def names_of(entry: InputEntry) -> Any:
        return entry.signal

    return tied(Side("inputs", ports, mapping.inputs, guess_input, SIGNALS, InputEntry, names_of, tie), mapping)


def _outputs(ports: Sequence[RawPort], mapping: MappingFile, nominal: Nominal) -> tuple[Mapped, tuple[str, ...]]:
    recorded: list[str] = []

    def tie(slot: Slot, entry: OutputEntry, name: str | None) -> Tie:
        assert name is not None
        if entry.record is not None:
            signal, scale = _new_channel(name, recorded), _scaled_channel(slot, entry, name, mapping.bases, nominal)
        else:
            signal, scale = COMMANDS.index(name), _scaled(slot, entry, name, mapping.bases, nominal)
        if entry.inverted:
            return Tie(
                f"{INVERTED}{name}", Element(signal, slot.byte, slot.port.kind, -1.0, _inverted_from(name, entry))
            )
        return Tie(name, Element(signal, slot.byte, slot.port.kind, entry.sign * scale.gain, scale.offset))

    def names_of(entry: OutputEntry) -> Any:
        return entry.command if entry.record is None else entry.record

    side = Side("outputs", ports, mapping.outputs, _guess_output, COMMANDS, OutputEntry, names_of, tie)
    mapped, problems = tied(side, mapping)
    mapped = mapped._replace(recorded=tuple(recorded))
    try:
        return of_a_kind(mapped, mapping.output_kind), problems
    except DoorError as error:
        undecided = () if mapping.left_out("output_kind") else (str(error),)
        return mapped, (*problems, *undecided)


def _guess_output(name: str, width: int, hints: Hints) -> Guess:
    """The command that an output means; of one that means none, the channel that it is recorded under: its own name."""
    guess = guess_output(name, width, hints)
    if guess.names or guess.note:
        return guess
    if width != 1:
        return Guess(note=f'not recorded: it is {width} numbers; a mapping file names them, {{record = ["...", ...]}}')
    if name.isascii() and name.isidentifier():
        return guess if name in {*TAKEN, *COMMANDS} else Guess((name,))
    return Guess(note=f'{NO_CHANNEL}; a mapping file gives one, {{record = "..."}}')


def _scaled(slot: Slot, entry: InputEntry | OutputEntry, name: str, bases: Bases, nominal: Nominal) -> Scale:
    unit = slot.port.unit if entry.unit is None else entry.unit
    return scale_of(QUANTITIES.get(name, "number"), unit, bases, nominal, entry.base)


def _scaled_channel(slot: Slot, entry: OutputEntry, name: str, bases: Bases, nominal: Nominal) -> Scale:
    """As the port gives it, unless the file says in what unit that is."""
    if entry.unit is None and entry.base is None:
        return Scale(1.0)
    return scale_of_channel(name, slot.port.unit if entry.unit is None else entry.unit, bases, nominal, entry.base)


def _said(slot: Slot, mapping: MappingFile) -> bool:
    """Whether the file says of an element, or of all currents, which direction is positive."""
    keys = {slot.name, slot.port.name}
    return bool(keys & set(mapping.inputs)) or "currents" in mapping.model_fields_set


def _direction_of(name: str, words: str) -> str:
    return (
        f"by its name {name}, but its description speaks of a current {words}, and {name} is positive into the grid;"
        f' write {{signal = "{name}", direction = "into_inverter"}} or "out_of_inverter"'
    )


def _direction(entry: InputEntry, name: str, mapping: MappingFile) -> int:
    """-1 where a positive current flows into the inverter."""
    if QUANTITIES.get(name) != "current":
        if "direction" in entry.model_fields_set:
            raise DoorError("direction is for phase currents; write sign = -1")
        return 1
    direction = entry.direction if "direction" in entry.model_fields_set else mapping.currents
    return -1 if direction == "into_inverter" else 1


def _inverted_from(name: str | None, entry: OutputEntry) -> float:
    """What a switch reads that is off, where 1 is off.

    Raises
    ------
    DoorError
        When what it gives is no switch.
    """
    if entry.record is not None or name not in SWITCHES:
        raise DoorError(f"inverted is for switches ({', '.join(SWITCHES)})")
    return 1.0


def _new_channel(name: str, recorded: list[str]) -> int:
    """Index of a further signal, which is recorded under a name."""
    check_channel(name, recorded, ascii_only=True)
    recorded.append(name)
    return len(COMMANDS) + len(recorded) - 1
