"""Which plant signal each port of a controller is given, and which command it gives: by a mapping file, or by name."""

from collections.abc import Iterable, Sequence
from collections.abc import Set as AbstractSet
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.simulation.doors.base import (
    ITEM_SIZES,
    MODULATING,
    NUMBER_TYPES,
    VOLTAGES,
    DoorError,
    Element,
    Port,
)
from pvlvrt_compliance.simulation.doors.mapping_file import (
    InputEntry,
    MappingFile,
    OutputEntry,
    load_mapping,
    mapping_path,
)
from pvlvrt_compliance.simulation.doors.port_names import QUANTITIES, Guess, guess_input, guess_output
from pvlvrt_compliance.simulation.doors.port_ties import Constant, Mapped, RawPort, Side, Slot, Tie, tied
from pvlvrt_compliance.simulation.doors.port_units import Bases, Scale, scale_of
from pvlvrt_compliance.simulation.exchange import COMMANDS, SIGNALS
from pvlvrt_compliance.simulation.foreign_loop import RECORDED
from pvlvrt_compliance.units import Nominal

__all__ = ["Constant", "Mapped", "MappingFile", "RawPort", "check_commands", "load_mapping", "map_inputs"]
__all__ += ["map_outputs", "mapping_path", "missing_commands", "missing_words", "set_constants"]


def map_inputs(ports: Sequence[RawPort], mapping: MappingFile | None, nominal: Nominal) -> Mapped:
    """Tie inputs to plant signals and constants: as the file says, else by name where that is clear.

    Raises
    ------
    DoorError
        When the file names a port or signal that is not there, or a unit does not fit; all problems at once.
    """
    mapping = mapping or MappingFile()

    def tie(slot: Slot, entry: InputEntry, name: str | None) -> Tie:
        if name is None:
            value = float(entry.constant or 0.0)
            return Tie(f"{value:g}", None, Constant(slot.byte, slot.port.kind, value))
        scale = _scaled(slot, entry, name, mapping.bases, nominal)
        sign = entry.sign * _direction(entry, name, mapping)
        return Tie(name, Element(SIGNALS.index(name), slot.byte, slot.port.kind, sign * scale.gain, scale.offset))

    def names_of(entry: InputEntry) -> Any:
        return entry.signal

    return tied(Side("inputs", ports, mapping.inputs, guess_input, SIGNALS, InputEntry, names_of, tie), mapping)


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

    def tie(slot: Slot, entry: OutputEntry, name: str | None) -> Tie:
        assert name is not None
        if entry.record is not None:
            signal, scale = _new_channel(name, recorded), Scale(1.0)
        else:
            signal, scale = COMMANDS.index(name), _scaled(slot, entry, name, mapping.bases, nominal)
        return Tie(name, Element(signal, slot.byte, slot.port.kind, entry.sign * scale.gain, scale.offset))

    def names_of(entry: OutputEntry) -> Any:
        return entry.command if entry.record is None else entry.record

    known = COMMANDS
    mapped = tied(Side("outputs", ports, mapping.outputs, _guess_output, known, OutputEntry, names_of, tie), mapping)
    return _with_kind(mapped._replace(recorded=tuple(recorded)), mapping)


def check_commands(outputs: Mapped) -> None:
    """Refuse outputs that do not command all three phases.

    Raises
    ------
    DoorError
        With the commands that nothing gives and the outputs that are free.
    """
    if outputs.missing:
        raise DoorError(missing_words(outputs.missing, outputs.unmapped))


def missing_words(missing: Sequence[str], free: Sequence[str]) -> str:
    """That commands are missing, what is free, and what to do."""
    unused = f"; outputs that give nothing yet: {', '.join(free)}" if free else ""
    return (
        f"no output gives {', '.join(missing)}{unused}. Tie them under [outputs] of a mapping file"
        ' (--mapping), for instance ma = "m_a", or to voltages, for instance Ea = "u_a_ref_v"'
    )


def set_constants(memory: NDArray[np.uint8], constants: Iterable[Constant]) -> None:
    """Write constants into a block's memory; whole numbers are rounded, and stay in the range of their type."""
    for constant in constants:
        kind: Any = NUMBER_TYPES[constant.kind]
        place = memory[constant.byte : constant.byte + ITEM_SIZES[constant.kind]].view(kind)
        if np.issubdtype(kind, np.floating):
            place[0] = constant.value
        else:
            limits = np.iinfo(kind)
            place[0] = round(min(max(constant.value, limits.min), limits.max))


def _guess_output(name: str, width: int) -> Guess:
    """The command that an output means; of one that means none, the channel that it is recorded under: its own name."""
    guess = guess_output(name, width)
    free = name.isascii() and name.isidentifier() and name not in (*RECORDED, *COMMANDS, "t_s")
    return Guess((name,)) if free and width == 1 and not guess.names and not guess.note else guess


def _scaled(slot: Slot, entry: InputEntry | OutputEntry, name: str, bases: Bases, nominal: Nominal) -> Scale:
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
    return mapped._replace(in_volts=in_volts, missing=_missing(given, in_volts))


def missing_commands(ports: Iterable[Port]) -> tuple[str, ...]:
    """Commands that outputs do not give, of the kind that they give more of."""
    given = {name for port in ports for name in (port.mapped_to or "").split(", ")}
    return min((_missing(given, in_volts) for in_volts in (False, True)), key=len)


def _missing(given: AbstractSet[str], in_volts: bool) -> tuple[str, ...]:
    return tuple(name for name in (VOLTAGES if in_volts else MODULATING) if name not in given)
