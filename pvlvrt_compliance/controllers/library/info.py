"""What a controller in C says of itself, checked, in plain Python: ports, parameters, sample time, states."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple, TypeVar

import numpy as np

from pvlvrt_compliance.controllers.description import ParameterInfo, Value
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.faults import RAISED, Faults
from pvlvrt_compliance.controllers.given_parameters import checked_parameters, code_of, range_of_type
from pvlvrt_compliance.controllers.library.layout import C_STRING, TYPES, Member, ModelInfo
from pvlvrt_compliance.simulation.door import ports
from pvlvrt_compliance.simulation.door.blocks import NUMBER_TYPES
from pvlvrt_compliance.simulation.parameters import SimulationParameters

EMT, RMS = 1, 2
"""What a tool simulates, as bits."""

_INHERITED = -1.0
_MOST_PORTS, _MOST_WIDTH, _MOST_STATES = 10_000, 100_000, 10_000_000


class PortInfo(NamedTuple):
    """An input or output."""

    name: str
    unit: str
    description: str
    member: Member


class LibraryParameter(NamedTuple):
    """A parameter; a number of type char is a whole number."""

    name: str
    unit: str
    description: str
    kind: int  # code of its type
    default: Value
    minimum: float | None  # none: not stated
    maximum: float | None

    def public(self) -> ParameterInfo:
        """As every door describes it."""
        return ParameterInfo(self.name, self.default, self.unit, self.description, self.minimum, self.maximum)


One = TypeVar("One", PortInfo, LibraryParameter)


class LibraryInfo(NamedTuple):
    """A controller in C."""

    name: str  # and version
    sample_time_s: float
    inputs: tuple[PortInfo, ...]
    outputs: tuple[PortInfo, ...]
    parameters: tuple[LibraryParameter, ...]
    int_states: int
    float_states: int
    double_states: int

    @property
    def keeps_states(self) -> bool:
        """Whether it has its states in the arrays of the interface, and so can be snapshot."""
        return self.int_states + self.float_states + self.double_states > 0


def info_of(model: Any, faults: Faults = RAISED) -> LibraryInfo:
    """Read what `Model_GetInfo` points to.

    Raises
    ------
    DoorError
        When it cannot be used here, or makes no sense.
    """
    raw: Any = model
    if raw.EMT_RMS_Mode == RMS:
        faults.tell("the controller is for RMS simulation only (EMT_RMS_Mode 2); instantaneous values are needed")
    states = [raw.NumIntStates, raw.NumFloatStates, raw.NumDoubleStates]
    if not all(0 <= n <= _MOST_STATES for n in states):
        faults.tell(f"the controller announces {', '.join(map(str, states))} states (int, float, double)")
        states = [0, 0, 0]
    return LibraryInfo(
        name=" ".join(part for part in (text_of(raw.ModelName), text_of(raw.ModelVersion)) if part) or "unnamed",
        sample_time_s=_sample_time_s(raw),
        inputs=_ports(raw.NumInputPorts, raw.InputPortsInfo, "input", faults),
        outputs=_ports(raw.NumOutputPorts, raw.OutputPortsInfo, "output", faults),
        parameters=_parameters(raw, faults),
        int_states=states[0],
        float_states=states[1],
        double_states=states[2],
    )


def text_of(found: bytes | None) -> str:
    """Text of a library, which is UTF-8 or Latin-1."""
    try:
        return (found or b"").decode("utf-8").strip()
    except UnicodeDecodeError:
        return (found or b"").decode("latin-1").strip()


def settings_of(
    parameters: Sequence[LibraryParameter], given: Mapping[str, Value], allow_out_of_range: bool = False
) -> dict[str, Value]:
    """Value of every parameter: the one that is given, checked, or the library's default.

    Raises
    ------
    DoorError
        When one is unknown, of another type, or out of range.
    """
    kinds = {p.name: p.kind for p in parameters}
    numbers = {name: code_of(value) if kinds.get(name) == ports.CHAR else value for name, value in given.items()}
    holds = {name: range_of_type(NUMBER_TYPES[kind]) for name, kind in kinds.items() if kind != C_STRING}
    known = (p.public() for p in parameters)
    checked = checked_parameters(numbers, known, holds, allow_out_of_range=allow_out_of_range)
    return {p.name: checked.get(p.name, p.default) for p in parameters}


def _sample_time_s(raw: ModelInfo) -> float:
    found = float(raw.FixedStepBaseSampleTime)
    if found == _INHERITED:
        of = SimulationParameters.model_fields
        return float(1e-6 * of["plant_step_us"].default * of["control_ratio"].default)
    return found


def _ports(count: int, found: Any, what: str, faults: Faults) -> tuple[PortInfo, ...]:
    return _listed(count, found, f"{what} ports", lambda raw, k: _port(raw, f"{what} port {k + 1}"), faults)


def _listed(count: int, found: Any, what: str, read: Callable[[Any, int], One], faults: Faults) -> tuple[One, ...]:
    """A list of the library; where faults are kept, those of its members that make sense."""
    made: list[One] = []
    with faults.told():
        _check_count(count, found, what)
        for k in range(count):
            with faults.told():
                made.append(read(found[k], k))
        _check_names([one.name for one in made], what)
    return tuple(made)


def _port(raw: Any, which: str) -> PortInfo:
    name = text_of(raw.Name)
    if raw.DataType not in TYPES or raw.DataType == C_STRING:
        raise DoorError(f"{which} ({name}) is of type {raw.DataType}; ports are numbers, types 1 to 9")
    if not 1 <= raw.Width <= _MOST_WIDTH:
        raise DoorError(f"{which} ({name}) is {raw.Width} wide")
    return PortInfo(name, text_of(raw.Unit), text_of(raw.Description), Member(raw.DataType, raw.Width))


def _parameters(raw: Any, faults: Faults) -> tuple[LibraryParameter, ...]:
    return _listed(raw.NumParameters, raw.ParametersInfo, "parameters", _parameter, faults)


def _parameter(raw: Any, _k: int) -> LibraryParameter:
    kind = raw.DataType
    if kind not in TYPES:
        raise DoorError(f"parameter {text_of(raw.Name)} is of type {kind}; types 1 to 10 are defined")
    low, high = (None, None) if kind == C_STRING else (_value(raw.MinValue, kind), _value(raw.MaxValue, kind))
    stated = low is not None and high is not None and high > low  # both 0: not filled in
    return LibraryParameter(
        name=text_of(raw.Name),
        unit=text_of(raw.Unit),
        description=text_of(raw.Description),
        kind=kind,
        default=text_of(raw.DefaultValue.v10) if kind == C_STRING else _value(raw.DefaultValue, kind),
        minimum=_bound(low, kind) if low is not None and stated else None,
        maximum=_bound(high, kind) if high is not None and stated else None,
    )


def _value(union: Any, kind: int) -> float | int:
    if kind == ports.CHAR:
        return int(union.v2)
    found: float | int = getattr(union, f"v{kind}")
    return found


def _bound(number: float, kind: int) -> float:
    """A bound as its author wrote it: 0.1, not the number of 32 bits next to it, which is above."""
    return float(str(np.float32(number))) if kind == ports.REAL32 else float(number)


def _check_count(count: int, found: Any, what: str) -> None:
    if not 0 <= count <= _MOST_PORTS or (count and not found):
        raise DoorError(f"the controller announces {count} {what}" + (", and no list of them" if not found else ""))


def _check_names(names: Sequence[str], what: str) -> None:
    for name in names:
        if not name.isidentifier():
            raise DoorError(f"one of the {what} is named {name!r}; names are C identifiers")
        if names.count(name) > 1:
            raise DoorError(f"two of the {what} are named {name!r}")
