"""Elements of ports tied to signals, commands and channels: by the entries of a mapping file, else by name."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from pvlvrt_compliance.controllers.description import Port
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.mapping.constants import Constant
from pvlvrt_compliance.controllers.mapping.file import MappingFile
from pvlvrt_compliance.controllers.mapping.names import Guess, Hints, key_of
from pvlvrt_compliance.controllers.mapping.telling import shared
from pvlvrt_compliance.errors import did_you_mean
from pvlvrt_compliance.simulation.door.blocks import ITEM_SIZES, Element
from pvlvrt_compliance.simulation.door.exchange import COMMANDS
from pvlvrt_compliance.simulation.door.ports import REAL64

_INDEXED = re.compile(r"(.+)\[(\d{1,9})\]")
INVERTED = "not "
"""Before the name of a switch whose output says the opposite."""

_TARGETS = {"inputs": "signal", "outputs": "command"}


class RawPort(NamedTuple):
    """A port of a controller in its block: element k lies at ``byte`` + k times the size of its kind."""

    name: str
    unit: str
    width: int
    byte: int
    kind: int = REAL64  # code of its type
    description: str = ""


class Mapped(NamedTuple):
    """Ports of one side, tied to the plant."""

    elements: tuple[Element, ...]
    ports: tuple[Port, ...]
    unmapped: tuple[str, ...]  # ports, or elements of one, that are tied to nothing
    constants: tuple[Constant, ...] = ()
    recorded: tuple[str, ...] = ()  # channels of the further signals, in their order
    in_volts: bool = False  # whether the outputs command voltages
    in_a_frame: bool = False  # whether they do so in a frame that turns
    missing: tuple[str, ...] = ()  # commands that no output gives


class Slot(NamedTuple):
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


class Tie(NamedTuple):
    """What one element is tied to."""

    name: str  # signal, command, channel of the record, or the constant in words
    element: Element | None
    constant: Constant | None = None


class Side(NamedTuple):
    """What the inputs and the outputs of a controller are mapped by."""

    table: str  # of the mapping file
    ports: Sequence[RawPort]
    entries: Mapping[str, Any]
    guess: Callable[[str, int, Hints], Guess]
    known: Sequence[str]
    entry_type: Any
    names_of: Callable[[Any], Any]
    tie: Callable[[Slot, Any, str | None], Tie]


def tied(side: Side, mapping: MappingFile) -> tuple[Mapped, tuple[str, ...]]:
    """Tie every element of the ports of one side; and all problems of the file, by line and key.

    What a name alone means but cannot be, because of its unit for instance, is left untied with a note.
    """
    wrong = dict(_wrong_entries(side))
    problems = {mapping.problem((side.table, key), text): None for key, text in wrong.items()}
    ties: dict[str, Tie] = {}
    keys: dict[str, str] = {}  # of the file, by the element that they tie
    notes: dict[str, str] = {}
    beside = _beside(side)
    for port in side.ports:
        guess = side.guess(port.name, port.width, Hints(port.unit, port.description, beside))
        notes[port.name] = guess.note
        for slot in (Slot(port, k) for k in range(port.width)):
            key, entry, name = _entry_of(slot, side, guess)
            if entry is None or key in wrong or _left_out(slot, side, mapping):
                continue
            try:
                _check_name(entry, name, side)
                ties[slot.name] = side.tie(slot, entry, name)
                keys[slot.name] = key
            except DoorError as error:
                if key:
                    problems[mapping.problem((side.table, key), str(error))] = None
                else:
                    notes[port.name] = str(error)
    problems.update(dict.fromkeys(_twice(side, ties, keys, mapping)))
    return _gathered(side, ties, notes), tuple(problems)


def _beside(side: Side) -> frozenset[str]:
    """Keys of the names of all ports, and of what the file ties already."""
    found = (key_of(name) for name in (*(port.name for port in side.ports), *_named(side)))
    return frozenset(key for key in found if key)


def _left_out(slot: Slot, side: Side, mapping: MappingFile) -> bool:
    """Whether the file says something of an element that is a mistake."""
    return any(mapping.left_out(side.table, key) for key in (f"{slot.port.name}[{slot.k}]", slot.port.name))


def _entry_of(slot: Slot, side: Side, guess: Guess) -> tuple[str, Any, str | None]:
    """Key in the file (empty: by name), the entry (None: nothing is known), and the signal's name for one element."""
    for key in (f"{slot.port.name}[{slot.k}]", slot.port.name):
        if key in side.entries:
            entry = side.entries[key]
            names = side.names_of(entry)
            return key, entry, names[min(slot.k, len(names) - 1)] if names else None
    if not guess.names or (side.table == "outputs" and guess.names[slot.k] in _named(side)):
        return "", None, None
    name = guess.names[slot.k]
    if name in side.known:
        more = {"inverted": True} if guess.inverted else {}
        return "", side.entry_type(**{_TARGETS[side.table]: (name,)}, unit=slot.port.unit or guess.unit, **more), name
    return "", side.entry_type(record=(name,)), name


def _named(side: Side) -> set[str]:
    """Names that the file has: they are not given away by a port's name."""
    found = [side.names_of(entry) for entry in side.entries.values()]
    return {name for names in found if names for name in names}


def _wrong_entries(side: Side) -> Iterator[tuple[str, str]]:
    """Keys of entries that fit no port, and why."""
    widths = {port.name: port.width for port in side.ports}
    for key, entry in side.entries.items():
        match = _INDEXED.fullmatch(key)
        name = match[1] if match and key not in widths else key
        names = side.names_of(entry)
        if name not in widths:
            has = f"; it has {', '.join(widths)}" if widths else "; it has none"
            text = f"the controller has no such {side.table[:-1]}{did_you_mean(name, widths)}{has}"
            yield key, text
        elif name != key and match and int(match[2]) >= widths[name]:
            yield key, f"{name} has {widths[name]} elements, counted from 0"
        elif names is not None and len(names) != (wanted := 1 if name != key else widths[name]):
            yield key, f"{len(names)} name{'s' * (len(names) != 1)} for {wanted} element{'s' * (wanted != 1)}"


def _check_name(entry: Any, name: str | None, side: Side) -> None:
    if name is None or name in side.known or getattr(entry, "record", None) is not None:
        return
    what = "signal" if side.table == "inputs" else "command"
    more = ' (to record it, write {record = "name"})' if side.table == "outputs" else ""
    known = f"known are {', '.join(side.known)}{more}"
    raise DoorError(f"{name!r} is no {what}{did_you_mean(name, side.known)}; {known}")


def _twice(side: Side, ties: Mapping[str, Tie], keys: Mapping[str, str], mapping: MappingFile) -> Iterator[str]:
    if side.table == "inputs":
        return
    for name in COMMANDS:
        by = [port for port, tie in ties.items() if tie.name.removeprefix(INVERTED) == name]
        if len(by) > 1:
            text = f"{' and '.join(by)} both give {name}; tie one of them to something else in a mapping file"
            key = next((keys[port] for port in reversed(by) if keys[port]), "")
            yield mapping.problem((side.table, key), text) if key else text


def _gathered(side: Side, ties: Mapping[str, Tie], notes: Mapping[str, str]) -> Mapped:
    slots = {port.name: [Slot(port, k).name for k in range(port.width)] for port in side.ports}
    unmapped = tuple(name for names in slots.values() for name in names if name not in ties)

    def to_port(port: RawPort) -> Port:
        names = [ties[name].name if name in ties else "-" for name in slots[port.name]]
        mapped_to = ", ".join(names) if set(names) != {"-"} else None
        note = notes[port.name] if mapped_to is None else ""
        return Port(port.name, port.unit, port.description, mapped_to, port.width, note)

    ports = [to_port(port) for port in side.ports]
    together = shared(ports) if side.table == "inputs" else {}
    return Mapped(
        elements=tuple(tie.element for tie in ties.values() if tie.element is not None),
        ports=tuple(replace(port, note=together.get(port.name, port.note)) for port in ports),
        unmapped=unmapped,
        constants=tuple(tie.constant for tie in ties.values() if tie.constant is not None),
    )
