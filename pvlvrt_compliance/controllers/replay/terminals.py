"""The numbers that a controller takes and gives, one after another, and the quantity that each is tied to."""

from collections.abc import Sequence
from typing import NamedTuple

from pvlvrt_compliance.controllers.description import Description, Port
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.mapping.bare import slots_of
from pvlvrt_compliance.controllers.mapping.file import MappingFile
from pvlvrt_compliance.controllers.mapping.port_units import Scale, spelled
from pvlvrt_compliance.controllers.mapping.sides import map_inputs, map_outputs
from pvlvrt_compliance.controllers.mapping.ties import Mapped, RawPort
from pvlvrt_compliance.simulation.door.exchange import COMMANDS, SIGNALS
from pvlvrt_compliance.texts import one_line
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Samples

PYTHON = "python"
"""Kind of a class, whose ports are quantities."""

MOST = 10_000
"""Numbers of either side: as many as a record has channels."""

_BYTES = 8  # of each number: here they only tell one from another


class Terminal(NamedTuple):
    """A number of a port."""

    name: str  # of the port, of a wide one with the index: ``V[2]``
    unit: str
    quantity: str = ""  # that it is tied to, a channel of the record among them; empty: none
    scale: Scale = Scale(1.0)  # number = gain * quantity + offset
    constant: float | None = None  # what a mapping file holds it at, in its unit

    def of_quantity(self, column: Samples) -> Samples:
        """The numbers for a column of its quantity (SI)."""
        return self.scale.gain * column + self.scale.offset


class Terminals(NamedTuple):
    """All of a controller."""

    inputs: tuple[Terminal, ...]
    outputs: tuple[Terminal, ...]
    note: str = ""  # why none is tied to a quantity, where that is so


def terminals_of(description: Description, mapping: MappingFile | None, nominal: Nominal) -> Terminals:
    """The numbers of all ports, tied as for a run where they can be: what a run needs besides is not asked for.

    Raises
    ------
    DoorError
        When the mapping file does not fit the ports, or these hold more numbers than can be replayed.
    """
    for side, ports in (("inputs", description.inputs), ("outputs", description.outputs)):
        if (count := sum(port.width for port in ports)) > MOST:
            raise DoorError(f"the {side} of the controller are {count} numbers; {MOST} can be replayed")
    if description.kind == PYTHON:
        return Terminals(tuple(map(_own, description.inputs)), tuple(map(_own, description.outputs)))
    inputs, outputs = _raw(description.inputs), _raw(description.outputs)
    try:
        taken, given = map_inputs(inputs, mapping, nominal), map_outputs(outputs, mapping, nominal)
    except DoorError as error:
        if mapping is not None:
            raise
        taken = given = Mapped((), (), ())
        note = f"columns go by the names of the ports alone, which cannot be tied to quantities: {error}"
    else:
        note = ""
    return Terminals(_tied(inputs, taken, SIGNALS), _tied(outputs, given, (*COMMANDS, *given.recorded)), note)


def _own(port: Port) -> Terminal:
    return Terminal(port.name, port.unit, port.name)


def _shown(unit: str) -> str:
    """A unit as it is written here; none of a number."""
    found = spelled(one_line(unit))
    return "" if found == "1" else found


def _raw(ports: Sequence[Port]) -> list[RawPort]:
    """Ports one after another."""
    found, byte = [], 0
    for port in ports:
        found.append(RawPort(port.name, port.unit, port.width, byte, description=port.description))
        byte += _BYTES * port.width
    return found


def _tied(ports: Sequence[RawPort], mapped: Mapped, names: Sequence[str]) -> tuple[Terminal, ...]:
    elements = {element.byte: element for element in mapped.elements}
    constants = {constant.byte: constant.value for constant in mapped.constants}

    def terminal(name: str, unit: str, byte: int) -> Terminal:
        element = elements.get(byte)
        quantity, scale = "", Scale(1.0)
        if element is not None:
            quantity, scale = names[element.signal], Scale(element.gain, element.offset)
        return Terminal(one_line(name), _shown(unit), quantity, scale, constants.get(byte))

    return tuple(terminal(slot.name, slot.port.unit, slot.byte) for slot in slots_of(ports))
