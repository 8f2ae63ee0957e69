"""Ports that are named like what they stand for."""

from collections.abc import Sequence
from typing import NamedTuple

from pvlvrt_compliance.simulation.doors.base import DoorError, Element, Port
from pvlvrt_compliance.simulation.foreign_loop import COMMANDS, RECORDED, SIGNALS


class RawPort(NamedTuple):
    """A controller's port in its block; element k of it at byte + k * size of a number."""

    name: str
    unit: str
    width: int
    byte: int
    kind: int
    description: str = ""


class Mapped(NamedTuple):
    """Ports that are tied to signals or commands."""

    elements: tuple[Element, ...]
    ports: tuple[Port, ...]
    in_volts: bool = False
    recorded: tuple[str, ...] = ()


def inputs_by_name(ports: Sequence[RawPort]) -> Mapped:
    """Tie inputs to the signals of their names."""
    elements = [Element(SIGNALS.index(p.name), p.byte, p.kind) for p in ports if _named(p, SIGNALS)]
    return Mapped(tuple(elements), tuple(_port(p, p.name if _named(p, SIGNALS) else None) for p in ports))


def outputs_by_name(ports: Sequence[RawPort]) -> Mapped:
    """Tie outputs to the commands of their names; others are recorded under their own.

    Raises
    ------
    DoorError
        When they are not all three of one kind.
    """
    names = {p.name for p in ports if p.width == 1}
    in_volts = set(COMMANDS[3:]) <= names
    wanted = COMMANDS[3:] if in_volts else COMMANDS[:3]
    if not set(wanted) <= names:
        raise DoorError(
            f"it must have the outputs {', '.join(COMMANDS[:3])}, or {', '.join(COMMANDS[3:])};"
            f" it has {', '.join(p.name for p in ports) or 'none'}"
        )
    further = [
        p for p in ports if p.width == 1 and p.name not in (*COMMANDS, *RECORDED, "t_s") and p.name.isidentifier()
    ]
    index = {name: k for k, name in enumerate((*COMMANDS, *(p.name for p in further)))}
    used = {*wanted, *(p.name for p in further)}
    elements = [Element(index[p.name], p.byte, p.kind) for p in ports if p.name in used]
    tied = tuple(_port(p, p.name if p.name in used else None) for p in ports)
    return Mapped(tuple(elements), tied, in_volts, tuple(p.name for p in further))


def _named(port: RawPort, names: Sequence[str]) -> bool:
    return port.width == 1 and port.name in names


def _port(port: RawPort, mapped_to: str | None) -> Port:
    return Port(port.name, port.unit, port.description, mapped_to, port.width)
