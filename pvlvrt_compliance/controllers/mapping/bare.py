"""Ports that are tied to nothing of a plant: each number of them is a signal of its own, in their order."""

from collections.abc import Iterator, Sequence

from pvlvrt_compliance.controllers.description import Port
from pvlvrt_compliance.controllers.mapping.ties import Mapped, RawPort, Slot
from pvlvrt_compliance.simulation.door.blocks import Element
from pvlvrt_compliance.simulation.door.exchange import SIGNALS

FIRST_INPUT = len(SIGNALS)
"""Signal of the first number of the inputs: those before it are the host's own, of which it tells some its time."""


def both_bare(inputs: Sequence[RawPort], outputs: Sequence[RawPort]) -> tuple[Mapped, Mapped]:
    """Inputs and outputs that are tied to nothing; outputs are signals from 0 on."""
    return _bare(inputs, FIRST_INPUT), _bare(outputs, 0)


def slots_of(ports: Sequence[RawPort]) -> Iterator[Slot]:
    """All numbers of ports, in their order."""
    return (Slot(port, k) for port in ports for k in range(port.width))


def _bare(ports: Sequence[RawPort], first: int) -> Mapped:
    slots = enumerate(slots_of(ports), start=first)
    return Mapped(
        elements=tuple(Element(number, slot.byte, slot.port.kind) for number, slot in slots),
        ports=tuple(Port(port.name, port.unit, port.description, width=port.width) for port in ports),
        unmapped=(),
    )
