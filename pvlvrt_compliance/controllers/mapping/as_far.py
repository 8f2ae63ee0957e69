"""Ports tied to the plant as far as a mapping file and their names allow it, where a mistake is to be looked at."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any

from pvlvrt_compliance.controllers.description import Port
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.faults import Faults
from pvlvrt_compliance.controllers.mapping.file import MappingFile, read_mapping
from pvlvrt_compliance.controllers.mapping.sides import map_inputs, map_outputs, map_ports
from pvlvrt_compliance.controllers.mapping.ties import Mapped, RawPort
from pvlvrt_compliance.units import Nominal

Side = Callable[[Sequence[RawPort], MappingFile | None, Nominal], Mapped]


def loaded(path: str | None, faults: Faults) -> MappingFile | None:
    """A mapping file; none where it cannot be read and that is kept.

    Raises
    ------
    DoorError
        As of `read_mapping`, unless faults are kept.
    """
    with faults.told():
        return read_mapping(path)
    return None


def both_sides(
    inputs: Sequence[RawPort],
    outputs: Sequence[RawPort],
    mapping: MappingFile | None,
    nominal: Nominal,
    faults: Faults,
) -> tuple[Mapped, Mapped]:
    """Inputs and outputs, tied; where faults are kept, with those entries of the file that fit.

    Raises
    ------
    DoorError
        As of `map_ports`, unless faults are kept.
    """
    try:
        return map_ports(inputs, outputs, mapping, nominal)
    except DoorError as error:
        faults.tell(str(error))
    return (
        _side(map_inputs, "inputs", inputs, mapping, nominal),
        _side(map_outputs, "outputs", outputs, mapping, nominal),
    )


def _side(tie: Side, table: str, ports: Sequence[RawPort], mapping: MappingFile | None, nominal: Nominal) -> Mapped:
    with suppress(DoorError):
        return tie(ports, mapping, nominal)
    whole = mapping or MappingFile()

    def with_entries(entries: dict[str, Any], some: Sequence[RawPort] = ports) -> Mapped | None:
        with suppress(DoorError):
            return tie(some, whole.model_copy(update={table: entries}), nominal)
        return None

    fitting = {key: entry for key, entry in getattr(whole, table).items() if with_entries({key: entry})}
    # Ports may contradict each other whatever the file says: then each is shown as it is alone.
    return with_entries(fitting) or with_entries({}) or _gathered(ports, [with_entries({}, [port]) for port in ports])


def _gathered(ports: Sequence[RawPort], alone: Sequence[Mapped | None]) -> Mapped:
    shown = [
        found.ports[0] if found else Port(port.name, port.unit, port.description, None, port.width)
        for port, found in zip(ports, alone, strict=True)
    ]
    return Mapped(elements=(), ports=tuple(shown), unmapped=tuple(port.name for port in shown if port.is_loose))
