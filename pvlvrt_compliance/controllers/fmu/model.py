"""What an FMU says of itself: the part of its modelDescription.xml that a controller is run by."""

import math
import zipfile
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from pvlvrt_compliance.controllers.description import ParameterInfo, Value
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.faults import RAISED, Faults
from pvlvrt_compliance.controllers.fmu.archive import opened
from pvlvrt_compliance.controllers.given_parameters import UNLIMITED, Range, range_of_type
from pvlvrt_compliance.simulation.door.blocks import NUMBER_TYPES
from pvlvrt_compliance.simulation.door.ports import INT8, INT16, INT32, REAL32, REAL64, UINT8, UINT16, UINT32


class NumberType(NamedTuple):
    """How numbers of a type of FMI go in and out."""

    calls: str  # of the functions that set and get it: fmi2Set<calls>
    kind: int  # code in the block


_TYPES: Mapping[str, Mapping[str, NumberType]] = {
    "2": {
        "Real": NumberType("Real", REAL64),
        "Integer": NumberType("Integer", INT32),
        "Enumeration": NumberType("Integer", INT32),
        "Boolean": NumberType("Boolean", INT32),
    },
    "3": {
        "Float64": NumberType("Float64", REAL64),
        "Float32": NumberType("Float32", REAL32),
        "Int8": NumberType("Int8", INT8),
        "UInt8": NumberType("UInt8", UINT8),
        "Int16": NumberType("Int16", INT16),
        "UInt16": NumberType("UInt16", UINT16),
        "Int32": NumberType("Int32", INT32),
        "UInt32": NumberType("UInt32", UINT32),
        "Boolean": NumberType("Boolean", UINT8),
    },
}
"""Types that can be ports, by the first figure of FMI's version."""

_OLDEST = "2"
"""Of an older one the types are alike, where it is only shown."""

_CAN: Mapping[str, tuple[str, str]] = {
    "2": ("canGetAndSetFMUstate", "canSerializeFMUstate"),
    "3": ("canGetAndSetFMUState", "canSerializeFMUState"),
}
"""How an FMU says that its state can be had, and taken elsewhere, by the first figure of FMI's version."""

_NO_PORTS: Mapping[str, type[np.number]] = {"Int64": np.int64, "UInt64": np.uint64, "Enumeration": np.int64}
"""Further types of numbers of FMI 3, of parameters only."""

_WORDS: Mapping[str, type] = {"Real": float, "Float64": float, "Float32": float, "Boolean": bool, "String": str}


class Variable(NamedTuple):
    """An input or output of an FMU."""

    name: str
    reference: int  # FMI's value reference
    type: NumberType
    width: int = 1
    unit: str = ""
    description: str = ""


class FmuParameter(NamedTuple):
    """A parameter of an FMU that is set before it is initialised."""

    info: ParameterInfo
    reference: int
    type: str  # name in FMI
    holds: Range  # smallest and largest number of that type


class FmuModel(NamedTuple):
    """An FMU for co-simulation with a binary for this platform, unless it has been read in spite of faults."""

    version: str  # first figure of FMI's version
    name: str
    identifier: str  # stem of its binary
    binary: str  # its place in the archive; empty: there is none for this platform
    token: str  # by which the binary knows that the description is its own
    sample_time_s: float | None  # by its description (s)
    inputs: tuple[Variable, ...]
    outputs: tuple[Variable, ...]
    parameters: tuple[FmuParameter, ...]
    notes: tuple[str, ...] = ()  # what is wrong with its description
    stays: tuple[str, ...] = ()  # attributes that it lacks for its state to be taken elsewhere


def read_model(file: Path, faults: Faults = RAISED) -> FmuModel:
    """Read the description of an FMU.

    Raises
    ------
    DoorError
        When it is none, is not for co-simulation, or has no binary for this platform.
    """
    model, notes = _description(file)
    version = str(model.fmiVersion)[0]
    with faults.told():
        _refuse_other_kinds(model)
    kind = model.coSimulation or model.modelExchange or model.scheduledExecution
    identifier, binary = kind.modelIdentifier if kind is not None else "", ""
    with faults.told():
        binary = _binary(file, identifier, version)
    variables = [v for v in model.modelVariables if v.alias is None]
    types = _TYPES.get(version, _TYPES[_OLDEST])
    return FmuModel(
        version=version,
        name=" ".join(filter(None, (model.modelName, model.version))),
        identifier=identifier,
        binary=binary,
        token=model.guid or "",
        sample_time_s=_sample_time_s(model, _clock_intervals(file)),
        inputs=_ports(variables, "input", types),
        outputs=_ports(variables, "output", types),
        parameters=tuple(_parameter(v, version) for v in variables if v.causality == "parameter" and _is_settable(v)),
        notes=notes,
        stays=_stays(kind, version),
    )


def fmi_library() -> Any:
    """Give the library for FMUs.

    Raises
    ------
    DoorError
        When it is not installed.
    """
    try:
        import fmpy
        import fmpy.fmi2
        import fmpy.fmi3
        import fmpy.model_description
    except ModuleNotFoundError as error:
        raise DoorError(
            f"an FMU needs the extra fmi ({error.name} is missing): pip install 'pvlvrt-compliance[fmi]'"
        ) from None
    return fmpy


def _description(file: Path) -> tuple[Any, tuple[str, ...]]:
    """Description of an FMU, and what the standard forbids in it: tools write much that only a validator minds."""
    library = fmi_library().model_description
    try:
        try:
            return library.read_model_description(str(file)), ()
        except library.ValidationError as error:
            return library.read_model_description(str(file), validate=False), (f"modelDescription.xml: {error}",)
    except (zipfile.BadZipFile, KeyError) as error:
        raise DoorError(f"{file.name} is not an FMU: {str(error).strip(chr(34))}") from None
    except Exception as error:
        _refuse_other_versions(_version_in(file))
        raise DoorError(f"its modelDescription.xml cannot be used: {error}") from None


def _version_in(file: Path) -> str:
    """FMI's version by a description that cannot be used otherwise; empty where not even that can be read."""
    from lxml import etree

    try:
        with opened(file) as archive, archive.open("modelDescription.xml") as stream:
            return str(etree.parse(stream).getroot().get("fmiVersion") or "")
    except (etree.XMLSyntaxError, DoorError):
        return ""


def _refuse_other_versions(version: str) -> None:
    if version and version[0] not in _TYPES:
        raise DoorError(f"it is an FMU of FMI {version}; FMI 2 and FMI 3 can be used")


def _refuse_other_kinds(model: Any) -> None:
    _refuse_other_versions(str(model.fmiVersion))
    if model.coSimulation is not None:
        return
    reasons = {
        "model exchange": (model.modelExchange, "it brings no solver of its own, and this host has none for it"),
        "scheduled execution": (model.scheduledExecution, "its parts are run by clocks, which this host does not have"),
    }
    found = [f"{kind} ({reason})" for kind, (has, reason) in reasons.items() if has is not None]
    raise DoorError(f"it is an FMU for {' and '.join(found) or 'nothing'} only; export it for co-simulation")


def _binary(file: Path, identifier: str, version: str) -> str:
    """Place of the binary for this platform in the archive.

    Raises
    ------
    DoorError
        When there is none, with those that there are.
    """
    library = fmi_library()
    here = library.platform_tuple if version == "3" else library.platform
    with opened(file) as archive:
        names = [name for name in archive.namelist() if not name.endswith("/")]
    own = f"binaries/{here}/{identifier}{library.sharedLibraryExtension}"
    if own in names:
        return own
    platforms = sorted({name.split("/")[1] for name in names if name.startswith("binaries/") and name.count("/") > 1})
    if any(name.startswith("sources/") for name in names):
        platforms.append("source code, to be compiled by its tool")
    raise DoorError(f"it has no binary for {here}; it has: {', '.join(platforms) or 'none at all'}")


def _stays(kind: Any, version: str) -> tuple[str, ...]:
    """Attributes by which a state could be taken elsewhere that are not true; the library spells them as FMI 2."""
    own = zip(_CAN.get(version, ()), _CAN["2"], strict=False)
    return tuple(name for name, of_library in own if not getattr(kind, of_library, False))


def _clock_intervals(file: Path) -> list[float]:
    """Intervals (s) of FMI 3's clocks, which the library does not read."""
    from lxml import etree

    with opened(file) as archive, archive.open("modelDescription.xml") as stream:
        clocks = etree.parse(stream).getroot().findall("ModelVariables/Clock")
    return [float(clock.get("intervalDecimal")) for clock in clocks if clock.get("intervalDecimal")]


def _sample_time_s(model: Any, clocks: Sequence[float]) -> float | None:
    """Of its one clock, else the step size that its author proposes, else the step that it takes inside."""
    if len(set(clocks)) == 1:
        return clocks[0]
    proposed = model.defaultExperiment.stepSize if model.defaultExperiment is not None else None
    found = proposed if proposed is not None else getattr(model.coSimulation, "fixedInternalStepSize", None)
    return None if found is None else float(found)


def _ports(variables: Iterable[Any], causality: str, types: Mapping[str, NumberType]) -> tuple[Variable, ...]:
    """Inputs or outputs that hold numbers, those of one type together."""
    found = [
        Variable(
            name=v.name,
            reference=v.valueReference,
            type=types[v.type],
            width=math.prod(v.shape or ()),
            unit=_declared(v, "unit") or "",
            description=v.description or "",
        )
        for v in variables
        if v.causality == causality and v.type in types and not v.clocks
    ]
    return tuple(sorted(found, key=lambda variable: (-variable.type.kind, variable.type.calls)))


def _declared(variable: Any, attribute: str) -> Any:
    """Attribute of a variable, or of the type that it is declared to have."""
    own = getattr(variable, attribute)
    return getattr(variable.declaredType, attribute) if own is None and variable.declaredType is not None else own


def _is_settable(variable: Any) -> bool:
    return not variable.shape and variable.type != "Binary"


def _parameter(variable: Any, version: str) -> FmuParameter:
    low, high = _declared(variable, "min"), _declared(variable, "max")
    info = ParameterInfo(
        name=variable.name,
        value=_start(variable),
        unit=_declared(variable, "unit") or "",
        description=variable.description or "",
        minimum=None if low is None else float(low),
        maximum=None if high is None else float(high),
    )
    return FmuParameter(info, variable.valueReference, variable.type, _range_of(variable.type, version))


def _range_of(kind: str, version: str) -> Range:
    types = _TYPES.get(version, _TYPES[_OLDEST])
    if kind in types:
        return range_of_type(NUMBER_TYPES[types[kind].kind])
    return range_of_type(_NO_PORTS[kind]) if kind in _NO_PORTS else UNLIMITED


def _start(variable: Any) -> Value:
    kind, text = _WORDS.get(variable.type, int), variable.start
    if kind is bool:
        return text in {"true", "1"}
    found: Value = kind() if text is None else kind(text)
    return found
