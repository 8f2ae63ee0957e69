"""What a controller in C says of itself, checked, in plain Python: ports, parameters, sample time, states."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from pvlvrt_compliance.errors import did_you_mean
from pvlvrt_compliance.scenario.parameters import SimulationParameters
from pvlvrt_compliance.simulation import ports
from pvlvrt_compliance.simulation.doors.base import DoorError, ParameterInfo, Value
from pvlvrt_compliance.simulation.doors.library_layout import C_STRING, TYPES, Member, ModelInfo

EMT, RMS = 1, 2
"""What a tool simulates, as bits."""

_INHERITED = -1.0
_MOST_PORTS, _MOST_WIDTH, _MOST_STATES = 10_000, 100_000, 10_000_000
_FRACTIONAL = (ports.REAL32, ports.REAL64)
_WHOLE_RANGES = {
    ports.CHAR: (-128, 127),
    ports.INT8: (-128, 127),
    ports.UINT8: (0, 255),
    ports.INT16: (-32768, 32767),
    ports.UINT16: (0, 65535),
    ports.INT32: (-2147483648, 2147483647),
    ports.UINT32: (0, 4294967295),
}


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
    fixed: bool  # does not change after the first sample
    default: Value
    minimum: float | None  # none: not stated
    maximum: float | None

    def public(self) -> ParameterInfo:
        """As every door describes it."""
        return ParameterInfo(self.name, self.default, self.unit, self.description, self.minimum, self.maximum)


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


def info_of(model: Any) -> LibraryInfo:
    """Read what `Model_GetInfo` points to.

    Raises
    ------
    DoorError
        When it cannot be used here, or makes no sense.
    """
    raw: Any = model
    if raw.EMT_RMS_Mode == RMS:
        raise DoorError("the controller is for RMS simulation only (EMT_RMS_Mode 2); instantaneous values are needed")
    states = [raw.NumIntStates, raw.NumFloatStates, raw.NumDoubleStates]
    if not all(0 <= n <= _MOST_STATES for n in states):
        raise DoorError(f"the controller announces {', '.join(map(str, states))} states (int, float, double)")
    return LibraryInfo(
        name=" ".join(part for part in (text_of(raw.ModelName), text_of(raw.ModelVersion)) if part) or "unnamed",
        sample_time_s=_sample_time_s(raw),
        inputs=_ports(raw.NumInputPorts, raw.InputPortsInfo, "input"),
        outputs=_ports(raw.NumOutputPorts, raw.OutputPortsInfo, "output"),
        parameters=_parameters(raw),
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


def settings_of(parameters: Sequence[LibraryParameter], given: dict[str, Value]) -> dict[str, Value]:
    """Value of every parameter: the one that is given, checked, or the library's default.

    Raises
    ------
    DoorError
        When one is unknown, of another type, or out of range.
    """
    known = {p.name: p for p in parameters}
    for name in given:
        if name not in known:
            has = f"; it has {', '.join(known)}" if known else "; it has none"
            raise DoorError(
                f"--set controller.{name}: the controller has no such parameter{did_you_mean(name, known)}{has}"
            )
    return {name: _checked(p, given[name]) if name in given else p.default for name, p in known.items()}


def _checked(p: LibraryParameter, value: Value) -> Value:
    if p.kind == C_STRING:
        if "\0" in str(value):
            raise DoorError(f"--set controller.{p.name}: a text cannot hold a NUL character")
        return str(value)
    number = _number(p, value)
    low, high = _WHOLE_RANGES.get(p.kind, (-math.inf, math.inf))
    low = low if p.minimum is None else max(low, p.minimum)
    high = high if p.maximum is None else min(high, p.maximum)
    if not low <= number <= high:
        unit = f" {p.unit}" if p.unit else ""
        raise DoorError(f"--set controller.{p.name}: {value}{unit} is out of range; {low:g} to {high:g} is allowed")
    return number


def _number(p: LibraryParameter, value: Value) -> float | int:
    if p.kind == ports.CHAR and isinstance(value, str) and len(value.encode()) == 1:
        return ord(value)
    if isinstance(value, str) or (isinstance(value, float) and not math.isfinite(value)):
        raise DoorError(f"--set controller.{p.name}: {value!r} is not a number")
    if p.kind in _FRACTIONAL:
        return float(value)
    if int(value) != value:
        raise DoorError(f"--set controller.{p.name}: {value!r} is not a whole number")
    return int(value)


def _sample_time_s(raw: ModelInfo) -> float:
    found = float(raw.FixedStepBaseSampleTime)
    if found == _INHERITED:
        of = SimulationParameters.model_fields
        return float(1e-6 * of["plant_step_us"].default * of["control_ratio"].default)
    return found


def _ports(count: int, found: Any, what: str) -> tuple[PortInfo, ...]:
    _check_count(count, found, f"{what} ports")
    made = tuple(_port(found[k], f"{what} port {k + 1}") for k in range(count))
    _check_names([port.name for port in made], f"{what} ports")
    return made


def _port(raw: Any, which: str) -> PortInfo:
    name = text_of(raw.Name)
    if raw.DataType not in TYPES or raw.DataType == C_STRING:
        raise DoorError(f"{which} ({name}) is of type {raw.DataType}; ports are numbers, types 1 to 9")
    if not 1 <= raw.Width <= _MOST_WIDTH:
        raise DoorError(f"{which} ({name}) is {raw.Width} wide")
    return PortInfo(name, text_of(raw.Unit), text_of(raw.Description), Member(raw.DataType, raw.Width))


def _parameters(raw: Any) -> tuple[LibraryParameter, ...]:
    _check_count(raw.NumParameters, raw.ParametersInfo, "parameters")
    made = tuple(_parameter(raw.ParametersInfo[k]) for k in range(raw.NumParameters))
    _check_names([p.name for p in made], "parameters")
    return made


def _parameter(raw: Any) -> LibraryParameter:
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
        fixed=bool(raw.FixedValue),
        default=text_of(raw.DefaultValue.v10) if kind == C_STRING else _value(raw.DefaultValue, kind),
        minimum=float(low) if low is not None and stated else None,
        maximum=float(high) if high is not None and stated else None,
    )


def _value(union: Any, kind: int) -> float | int:
    if kind == ports.CHAR:
        return int(union.v2)
    found: float | int = getattr(union, f"v{kind}")
    return found


def _check_count(count: int, found: Any, what: str) -> None:
    if not 0 <= count <= _MOST_PORTS or (count and not found):
        raise DoorError(f"the controller announces {count} {what}" + (", and no list of them" if not found else ""))


def _check_names(names: Sequence[str], what: str) -> None:
    for name in names:
        if not name.isidentifier():
            raise DoorError(f"one of the {what} is named {name!r}; names are C identifiers")
        if names.count(name) > 1:
            raise DoorError(f"two of the {what} are named {name!r}")
