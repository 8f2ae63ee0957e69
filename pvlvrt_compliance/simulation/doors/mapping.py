"""Which plant signal each port of a controller is given, and which command it gives: by a mapping file, or by name."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.errors import did_you_mean
from pvlvrt_compliance.simulation.doors.base import ITEM_SIZES, DoorError, Element, Port
from pvlvrt_compliance.simulation.doors.mapping_file import (
    InputEntry,
    MappingFile,
    OutputEntry,
    load_mapping,
    mapping_path,
    refusal,
)
from pvlvrt_compliance.simulation.doors.port_names import QUANTITIES, Guess, guess_input, guess_output
from pvlvrt_compliance.simulation.doors.port_units import Bases, Scale, scale_of
from pvlvrt_compliance.simulation.foreign_loop import COMMANDS, RECORDED, SIGNALS
from pvlvrt_compliance.simulation.ports import REAL64
from pvlvrt_compliance.units import Nominal

__all__ = ["Constant", "Mapped", "MappingFile", "RawPort", "check_commands", "load_mapping", "map_inputs"]
__all__ += ["map_outputs", "mapping_path", "set_constants"]

SHOWN = ("v_fault_pu", "q_ref_var", "p_ref_w")
"""Outputs that are recorded by their names alone: reports show them beside the measurements."""

MODULATING, VOLTAGES = COMMANDS[:3], COMMANDS[3:]


class RawPort(NamedTuple):
    """A port of a controller in its block: element k lies at ``byte`` + k times the size of its kind."""

    name: str
    unit: str
    width: int
    byte: int
    kind: int = REAL64  # code of its type
    description: str = ""


class Constant(NamedTuple):
    """A number that is written into a block once, before the first sample."""

    byte: int
    kind: int
    value: float  # units of the port


class Mapped(NamedTuple):
    """Ports of one side, tied to the plant."""

    elements: tuple[Element, ...]
    ports: tuple[Port, ...]
    unmapped: tuple[str, ...]  # ports, or elements of one, that are tied to nothing
    constants: tuple[Constant, ...] = ()
    recorded: tuple[str, ...] = ()  # channels of the further signals, in their order
    in_volts: bool = False  # whether the outputs command voltages
    missing: tuple[str, ...] = ()  # commands that no output gives


class _Slot(NamedTuple):
    """One element of a port."""

    port: RawPort
    k: int  # which

    @property
    def name(self) -> str:
        """Name, with the index where the port is wide."""
        return f"{self.port.name}[{self.k}]" if self.port.width > 1 else self.port.name

    @property
    def byte(self) -> int:
        """Offset in the block."""
        return self.port.byte + self.k * ITEM_SIZES[self.port.kind]


class _Tie(NamedTuple):
    """What one element is tied to."""

    name: str  # signal, command, channel of the record, or the constant in words
    element: Element | None
    constant: Constant | None = None


_INDEXED = re.compile(r"(.+)\[(\d+)\]")


def map_inputs(ports: Sequence[RawPort], mapping: MappingFile | None, nominal: Nominal) -> Mapped:
    """Tie inputs to plant signals and constants: as the file says, else by name where that is clear.

    Raises
    ------
    DoorError
        When the file names a port or signal that is not there, or a unit does not fit; all problems at once.
    """
    mapping = mapping or MappingFile()

    def tie(slot: _Slot, entry: InputEntry, name: str | None) -> _Tie:
        if name is None:
            value = float(entry.constant or 0.0)
            return _Tie(f"{value:g}", None, Constant(slot.byte, slot.port.kind, value))
        scale = _scaled(slot, entry, name, mapping.bases, nominal)
        sign = entry.sign * _direction(entry, name, mapping)
        return _Tie(name, Element(SIGNALS.index(name), slot.byte, slot.port.kind, sign * scale.gain, scale.offset))

    def names_of(entry: InputEntry) -> Any:
        return entry.signal

    return _mapped(_Side("inputs", ports, mapping.inputs, guess_input, SIGNALS, InputEntry, names_of, tie), mapping)


def map_outputs(ports: Sequence[RawPort], mapping: MappingFile | None, nominal: Nominal) -> Mapped:
    """Tie outputs to commands and to channels of the record: as the file says, else by name where that is clear.

    Whether all commands are given is in ``missing``: see `check_commands`.

    Raises
    ------
    DoorError
        When the file names a port or command that is not there, two outputs give one command, or a unit does not fit.
    """
    mapping = mapping or MappingFile()
    recorded: list[str] = []

    def tie(slot: _Slot, entry: OutputEntry, name: str | None) -> _Tie:
        assert name is not None
        if entry.record is not None:
            signal, scale = _new_channel(name, recorded), Scale(1.0)
        else:
            signal, scale = COMMANDS.index(name), _scaled(slot, entry, name, mapping.bases, nominal)
        return _Tie(name, Element(signal, slot.byte, slot.port.kind, entry.sign * scale.gain, scale.offset))

    def names_of(entry: OutputEntry) -> Any:
        return entry.command if entry.record is None else entry.record

    known = COMMANDS
    mapped = _mapped(
        _Side("outputs", ports, mapping.outputs, _guess_output, known, OutputEntry, names_of, tie), mapping
    )
    return _with_kind(mapped._replace(recorded=tuple(recorded)), mapping)


def check_commands(outputs: Mapped) -> None:
    """Refuse outputs that do not command all three phases.

    Raises
    ------
    DoorError
        With the commands that nothing gives and the outputs that are free.
    """
    if outputs.missing:
        free = f"; outputs that give nothing yet: {', '.join(outputs.unmapped)}" if outputs.unmapped else ""
        raise DoorError(
            f"no output gives {', '.join(outputs.missing)}{free}. Tie them under [outputs] of a mapping file"
            ' (--mapping), for instance ma = "m_a", or to voltages, for instance Ea = "u_a_ref_v"'
        )


def set_constants(memory: NDArray[np.uint8], constants: Iterable[Constant]) -> None:
    """Write constants into a block's memory; whole numbers are rounded, and stay in the range of their type."""
    for constant in constants:
        kind = _TYPES[constant.kind - 1]
        place = memory[constant.byte : constant.byte + ITEM_SIZES[constant.kind]].view(kind)
        if np.issubdtype(kind, np.floating):
            place[0] = constant.value
        else:
            limits = np.iinfo(kind)
            place[0] = round(min(max(constant.value, limits.min), limits.max))


_TYPES: Sequence[Any] = (np.int8, np.int8, np.uint8, np.int16, np.uint16, np.int32, np.uint32, np.float32, np.float64)


class _Side(NamedTuple):
    """What the inputs and the outputs of a controller are mapped by."""

    table: str  # of the mapping file
    ports: Sequence[RawPort]
    entries: Mapping[str, Any]
    guess: Callable[[str, int], Guess]
    known: Sequence[str]
    entry_type: Any
    names_of: Callable[[Any], Any]
    tie: Callable[[_Slot, Any, str | None], _Tie]


def _mapped(side: _Side, mapping: MappingFile) -> Mapped:
    problems = list(_unknown_ports(side, mapping))
    ties: dict[str, _Tie] = {}
    notes: dict[str, str] = {}
    for port in side.ports:
        guess = side.guess(port.name, port.width)
        notes[port.name] = guess.note
        for slot in (_Slot(port, k) for k in range(port.width)):
            key, found = _entry_of(slot, side, guess)
            if found is None:
                continue
            entry, name = found
            try:
                _check_name(entry, name, side)
                ties[slot.name] = side.tie(slot, entry, name)
            except DoorError as error:
                problem = mapping.problem((side.table, key), str(error)) if key else f"{slot.name}: {error}"
                if problem not in problems:
                    problems.append(problem)
    problems += _twice(side, ties)
    if problems:
        raise refusal("the ports of the controller cannot be tied to the plant", problems)
    return _gathered(side, ties, notes)


def _entry_of(slot: _Slot, side: _Side, guess: Guess) -> tuple[str, tuple[Any, str | None] | None]:
    """Key in the file (empty: by name), and the entry with the signal's name for one element."""
    for key in (f"{slot.port.name}[{slot.k}]", slot.port.name):
        if key in side.entries:
            entry = side.entries[key]
            names = side.names_of(entry)
            if names is None or isinstance(names, str):
                return key, (entry, names)
            return key, (entry, names[slot.k] if slot.k < len(names) else "")
    if not guess.names:
        return "", None
    name = guess.names[slot.k]
    if name in side.known:
        return "", (side.entry_type(**{_TARGETS[side.table]: name}, unit=slot.port.unit or guess.unit), name)
    return "", (side.entry_type(record=name), name)


_TARGETS = {"inputs": "signal", "outputs": "command"}


def _guess_output(name: str, width: int) -> Guess:
    return Guess((name,)) if name in SHOWN and width == 1 else guess_output(name, width)


def _unknown_ports(side: _Side, mapping: MappingFile) -> Iterator[str]:
    widths = {port.name: port.width for port in side.ports}
    for key, entry in side.entries.items():
        match = _INDEXED.fullmatch(key)
        name = match[1] if match and key not in widths else key
        names = side.names_of(entry)
        if name not in widths:
            has = f"; it has {', '.join(widths)}" if widths else "; it has none"
            text = f"the controller has no such {side.table[:-1]}{did_you_mean(name, widths)}{has}"
            yield mapping.problem((side.table, key), text)
        elif name != key and match and int(match[2]) >= widths[name]:
            yield mapping.problem((side.table, key), f"{name} has {widths[name]} elements, counted from 0")
        elif isinstance(names, tuple) and len(names) != (1 if name != key else widths[name]):
            yield mapping.problem((side.table, key), f"{len(names)} names for {widths[name]} elements")
        elif isinstance(names, str) and name == key and widths[name] > 1:
            yield mapping.problem((side.table, key), f"one name for {widths[name]} elements; write a list of names")


def _check_name(entry: Any, name: str | None, side: _Side) -> None:
    if name is None or name in side.known or getattr(entry, "record", None) is not None:
        return
    what = "signal" if side.table == "inputs" else "command"
    more = ' (to record it, write {record = "name"})' if side.table == "outputs" else ""
    known = f"known are {', '.join(side.known)}{more}"
    raise DoorError(f"{name!r} is no {what}{did_you_mean(name, side.known)}; {known}")


def _scaled(slot: _Slot, entry: InputEntry | OutputEntry, name: str, bases: Bases, nominal: Nominal) -> Scale:
    unit = slot.port.unit if entry.unit is None else entry.unit
    return scale_of(QUANTITIES.get(name, "number"), unit, bases, nominal, entry.base)


def _direction(entry: InputEntry, name: str, mapping: MappingFile) -> int:
    """-1 where a positive current flows into the inverter."""
    if QUANTITIES.get(name) != "current":
        if "direction" in entry.model_fields_set:
            raise DoorError("direction is for phase currents; write sign = -1")
        return 1
    direction = entry.direction if "direction" in entry.model_fields_set else mapping.currents
    return -1 if direction == "into_inverter" else 1


def _new_channel(name: str, recorded: list[str]) -> int:
    """Index of a further signal, which is recorded under a name."""
    if not (name.isascii() and name.isidentifier()):
        raise DoorError(f"{name!r} is not a name for a channel; write letters, digits and _")
    if name in RECORDED or name == "t_s" or name in recorded:
        raise DoorError(f"the record has a channel {name!r} already")
    recorded.append(name)
    return len(COMMANDS) + len(recorded) - 1


def _twice(side: _Side, ties: Mapping[str, _Tie]) -> Iterator[str]:
    if side.table == "inputs":
        return
    for name in COMMANDS:
        by = [port for port, tie in ties.items() if tie.name == name]
        if len(by) > 1:
            yield f"{' and '.join(by)} both give {name}; tie one of them to something else in a mapping file"


def _gathered(side: _Side, ties: Mapping[str, _Tie], notes: Mapping[str, str]) -> Mapped:
    slots = {port.name: [_Slot(port, k).name for k in range(port.width)] for port in side.ports}
    unmapped = tuple(name for names in slots.values() for name in names if name not in ties)

    def to_port(port: RawPort) -> Port:
        names = [ties[name].name if name in ties else "-" for name in slots[port.name]]
        mapped_to = ", ".join(names) if set(names) != {"-"} else None
        note = notes[port.name] if mapped_to is None else ""
        return Port(port.name, port.unit, port.description, mapped_to, port.width, note)

    return Mapped(
        elements=tuple(tie.element for tie in ties.values() if tie.element is not None),
        ports=tuple(to_port(port) for port in side.ports),
        unmapped=unmapped,
        constants=tuple(tie.constant for tie in ties.values() if tie.constant is not None),
    )


def _with_kind(mapped: Mapped, mapping: MappingFile) -> Mapped:
    """Tell modulating signals from voltage references by what is complete, else by what there is more of."""
    given = {COMMANDS[e.signal] for e in mapped.elements if e.signal < len(COMMANDS)}
    counts = [len(given & set(kind)) for kind in (MODULATING, VOLTAGES)]
    in_volts = counts[1] > counts[0] if mapping.output_kind is None else mapping.output_kind == "voltage"
    if mapping.output_kind is None and counts == [3, 3]:
        raise DoorError(
            "the outputs give modulating signals and voltages; write output_kind ="
            ' "modulating" or "voltage" at the top of a mapping file (--mapping)'
        )
    wanted = VOLTAGES if in_volts else MODULATING
    return mapped._replace(in_volts=in_volts, missing=tuple(name for name in wanted if name not in given))
