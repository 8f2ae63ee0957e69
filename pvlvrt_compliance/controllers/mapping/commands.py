"""Whether outputs command all three phases, and by which of the two kinds: modulating signals, or voltages."""

from collections.abc import Iterable, Sequence
from collections.abc import Set as AbstractSet

from pvlvrt_compliance.controllers.description import Port
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.mapping.file import OutputKind
from pvlvrt_compliance.controllers.mapping.ties import Mapped
from pvlvrt_compliance.simulation.door.blocks import MODULATING, VOLTAGES
from pvlvrt_compliance.simulation.door.exchange import COMMANDS


def of_a_kind(mapped: Mapped, kind: OutputKind | None) -> Mapped:
    """Tell modulating signals from voltages by what is complete, else by what there is more of; and what is missing.

    Raises
    ------
    DoorError
        When both are complete and no kind is named.
    """
    given = {COMMANDS[e.signal] for e in mapped.elements if e.signal < len(COMMANDS)}
    counts = [len(given & set(names)) for names in (MODULATING, VOLTAGES)]
    in_volts = counts[1] > counts[0] if kind is None else kind == "voltage"
    if kind is None and counts == [3, 3]:
        raise DoorError(
            "the outputs give modulating signals and voltages; write output_kind ="
            ' "modulating" or "voltage" at the top of a mapping file (--mapping)'
        )
    return mapped._replace(in_volts=in_volts, missing=_missing(given, in_volts))


def check_commands(outputs: Mapped) -> None:
    """Refuse outputs that do not command all three phases.

    Raises
    ------
    DoorError
        With the commands that nothing gives and the outputs that are free.
    """
    if outputs.missing:
        raise DoorError(missing_words(outputs.missing, outputs.unmapped))


def missing_commands(ports: Iterable[Port]) -> tuple[str, ...]:
    """Commands that outputs do not give, of the kind that they give more of."""
    given = {name for port in ports for name in (port.mapped_to or "").split(", ")}
    return min((_missing(given, in_volts) for in_volts in (False, True)), key=len)


def missing_words(missing: Sequence[str], free: Sequence[str]) -> str:
    """That commands are missing, what is free, and what to do."""
    unused = f"; outputs that give nothing yet: {', '.join(free)}" if free else ""
    return (
        f"no output gives {', '.join(missing)}{unused}. Tie them under [outputs] of a mapping file"
        ' (--mapping), for instance ma = "m_a", or to voltages, for instance Ea = "u_a_ref_v"'
    )


def _missing(given: AbstractSet[str], in_volts: bool) -> tuple[str, ...]:
    return tuple(name for name in (VOLTAGES if in_volts else MODULATING) if name not in given)
