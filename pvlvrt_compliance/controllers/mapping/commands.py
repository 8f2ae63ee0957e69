"""Whether outputs command all three phases, and how: by modulating signals, by voltages, or by these in a frame."""

from collections.abc import Iterable, Mapping, Sequence
from collections.abc import Set as AbstractSet

from pvlvrt_compliance.controllers.description import Port
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.mapping.file import OutputKind
from pvlvrt_compliance.controllers.mapping.ties import Mapped
from pvlvrt_compliance.simulation.door.blocks import IN_A_FRAME, MODULATING, VOLTAGES
from pvlvrt_compliance.simulation.door.exchange import COMMANDS

KINDS: Mapping[OutputKind, tuple[str, ...]] = {
    "modulating": MODULATING,
    "voltage": VOLTAGES,
    "dq": IN_A_FRAME,
}
"""Commands of a kind, all of which are needed."""
_WORDS = {"modulating": "modulating signals", "voltage": "voltages", "dq": "voltages in a frame"}


def of_a_kind(mapped: Mapped, kind: OutputKind | None) -> Mapped:
    """Tell modulating signals from voltages by what is complete, else by what there is more of; and what is missing.

    Raises
    ------
    DoorError
        When both are complete and no kind is named.
    """
    given = {COMMANDS[e.signal] for e in mapped.elements if e.signal < len(COMMANDS)}
    complete = [name for name in KINDS if not _missing(given, name)]
    if kind is None and len(complete) > 1:
        *others, last = (f'"{name}"' for name in complete)
        raise DoorError(
            f"the outputs give {' and '.join(_WORDS[name] for name in complete)}; write output_kind ="
            f" {', '.join(others)} or {last} at the top of a mapping file (--mapping)"
        )
    chosen = kind or _nearest(given)
    return mapped._replace(in_volts=chosen != "modulating", in_a_frame=chosen == "dq", missing=_missing(given, chosen))


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
    return _missing(given, _nearest(given))


def missing_words(missing: Sequence[str], free: Sequence[str]) -> str:
    """That commands are missing, what is free, and what to do."""
    unused = f"; outputs that give nothing yet: {', '.join(free)}" if free else ""
    return (
        f"no output gives {', '.join(missing)}{unused}. Tie them under [outputs] of a mapping file"
        ' (--mapping), for instance ma = "m_a", or to voltages, for instance Ea = "u_a_ref_v", or Ed = "u_d_ref_v"'
    )


def _missing(given: AbstractSet[str], kind: OutputKind) -> tuple[str, ...]:
    return tuple(name for name in KINDS[kind] if name not in given)


def _nearest(given: AbstractSet[str]) -> OutputKind:
    """Kind that lacks least; of those that lack the same, the first."""
    return min(KINDS, key=lambda kind: len(_missing(given, kind)))
