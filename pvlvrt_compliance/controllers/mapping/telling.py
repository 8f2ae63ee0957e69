"""What is to be told of ports beyond what they are tied to: two on one quantity, and why one is tied to nothing."""

from collections.abc import Iterable, Iterator, Sequence

from pvlvrt_compliance.controllers.description import Port
from pvlvrt_compliance.controllers.mapping.quantities import QUANTITIES
from pvlvrt_compliance.simulation.door.exchange import SIGNALS

NO_CHANNEL = "not recorded: its name cannot be that of a channel"
"""Begin of what is told of an output that is no command, and has a name that the record cannot have."""

_WHY = {
    "current": "the filter has one",
    "voltage": "the voltage at the PCC",
    "v_dc_v": "the array lies on the link",
}
_WORDS = {"current": "current", "voltage": "voltage", "dc_voltage": "DC voltage", "dc_current": "DC current"}


def shared(inputs: Sequence[Port]) -> dict[str, str]:
    """Notes for inputs that are given the same signals as others, by the port's name."""
    notes = {}
    for signals, names in _groups(inputs).items():
        notes.update(dict.fromkeys(names, f"{_and(names)} are {_the_same(signals)}"))
    return notes


def told_of(inputs: Sequence[Port], outputs: Sequence[Port] = ()) -> Iterator[str]:
    """What every run says of how ports are tied: why some are to nothing, and which inputs are given the same."""
    for side, ports in (("input", inputs), ("output", outputs)):
        told = [port for port in ports if port.is_loose and port.note and not port.note.startswith(NO_CHANNEL)]
        yield from (f"{side} {port.name}: {port.note}" for port in told)
    if unnamed := [port.name for port in outputs if port.is_loose and port.note.startswith(NO_CHANNEL)]:
        yield f"not recorded, as a channel cannot be called so: outputs {_and(unnamed)}; a mapping file can name them"
    said: dict[str, list[str]] = {}
    for signals, names in _groups(inputs).items():
        said.setdefault(_the_same(signals), []).append(_and(names))
    for words, groups in said.items():
        yield f"{', '.join(groups)} are {'each ' if len(groups) > 1 else ''}{words}"


def reasons(ports: Iterable[Port]) -> tuple[str, ...]:
    """Ports that are tied to nothing, each with why, where that is known."""
    return tuple(f"{port.name} ({port.note})" if port.note else port.name for port in ports if port.is_loose)


def _groups(inputs: Sequence[Port]) -> dict[str, list[str]]:
    """Names of inputs that are tied to the same, by the signals that they are given."""
    found: dict[str, list[str]] = {}
    for port in inputs:
        if port.mapped_to and set(port.mapped_to.split(", ")) <= set(SIGNALS):
            found.setdefault(port.mapped_to, []).append(port.name)
    return {signals: names for signals, names in found.items() if len(names) > 1}


def _the_same(signals: str) -> str:
    first = signals.partition(",")[0]
    quantity = QUANTITIES.get(first, "")
    why = _WHY.get(first) or _WHY.get(quantity)
    return f"the same {_WORDS.get(quantity, 'signal')} here{f': {why}' if why else ''}"


def _and(names: Sequence[str]) -> str:
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last
