"""Structures of the IEEE/CIGRE DLL interface (CIGRE TB 958): the fixed ones, and those that a library announces.

The same as `ieee_cigre.h`. On 64 bits with natural alignment, as every C compiler lays them out.
"""

import ctypes
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from pvlvrt_compliance.simulation.door import ports

C_STRING = 10
"""Code of a text, beside the codes of numbers in `simulation.door.ports`; of parameters only."""

TYPES: Mapping[int, Any] = {
    ports.CHAR: ctypes.c_char,
    ports.INT8: ctypes.c_int8,
    ports.UINT8: ctypes.c_uint8,
    ports.INT16: ctypes.c_int16,
    ports.UINT16: ctypes.c_uint16,
    ports.INT32: ctypes.c_int32,
    ports.UINT32: ctypes.c_uint32,
    ports.REAL32: ctypes.c_float,
    ports.REAL64: ctypes.c_double,
    C_STRING: ctypes.c_char_p,
}
"""Type of a member by the code of its type."""

BOUNDARY = 16
"""Every part of an instance's memory begins at a multiple of so many bytes."""


class SignalInfo(ctypes.Structure):
    """A port, as the library announces it."""

    _fields_ = (
        ("Name", ctypes.c_char_p),
        ("Description", ctypes.c_char_p),
        ("Unit", ctypes.c_char_p),
        ("DataType", ctypes.c_int32),
        ("Width", ctypes.c_int32),
    )


class ValueUnion(ctypes.Union):
    """A parameter's value: the member that its type names, here by the code of the type (``v9``: real64)."""

    _fields_ = tuple((f"v{code}", kind) for code, kind in TYPES.items())


class ParameterStructure(ctypes.Structure):
    """A parameter, as the library announces it."""

    _fields_ = (
        ("Name", ctypes.c_char_p),
        ("GroupName", ctypes.c_char_p),
        ("Description", ctypes.c_char_p),
        ("Unit", ctypes.c_char_p),
        ("DataType", ctypes.c_int32),
        ("FixedValue", ctypes.c_int32),
        ("DefaultValue", ValueUnion),
        ("MinValue", ValueUnion),
        ("MaxValue", ValueUnion),
    )


class ModelInfo(ctypes.Structure):
    """What a library says of itself."""

    _fields_ = (
        ("DLLInterfaceVersion", ctypes.c_uint8 * 4),
        ("ModelName", ctypes.c_char_p),
        ("ModelVersion", ctypes.c_char_p),
        ("ModelDescription", ctypes.c_char_p),
        ("GeneralInformation", ctypes.c_char_p),
        ("ModelCreated", ctypes.c_char_p),
        ("ModelCreator", ctypes.c_char_p),
        ("ModelLastModifiedDate", ctypes.c_char_p),
        ("ModelLastModifiedBy", ctypes.c_char_p),
        ("ModelModifiedComment", ctypes.c_char_p),
        ("ModelModifiedHistory", ctypes.c_char_p),
        ("FixedStepBaseSampleTime", ctypes.c_double),
        ("EMT_RMS_Mode", ctypes.c_uint8),
        ("NumInputPorts", ctypes.c_int32),
        ("InputPortsInfo", ctypes.POINTER(SignalInfo)),
        ("NumOutputPorts", ctypes.c_int32),
        ("OutputPortsInfo", ctypes.POINTER(SignalInfo)),
        ("NumParameters", ctypes.c_int32),
        ("ParametersInfo", ctypes.POINTER(ParameterStructure)),
        ("NumIntStates", ctypes.c_int32),
        ("NumFloatStates", ctypes.c_int32),
        ("NumDoubleStates", ctypes.c_int32),
    )


class Instance(ctypes.Structure):
    """A controller at work. Addresses are whole numbers here."""

    _fields_ = (
        ("ExternalInputs", ctypes.c_void_p),
        ("ExternalOutputs", ctypes.c_void_p),
        ("Parameters", ctypes.c_void_p),
        ("Time", ctypes.c_double),
        ("SimTool_EMT_RMS_Mode", ctypes.c_uint8),
        ("LastErrorMessage", ctypes.c_void_p),
        ("LastGeneralMessage", ctypes.c_void_p),
        ("IntStates", ctypes.c_void_p),
        ("FloatStates", ctypes.c_void_p),
        ("DoubleStates", ctypes.c_void_p),
    )


class Member(NamedTuple):
    """Member of a structure: so many numbers of a type."""

    kind: int  # code of the type
    width: int = 1


class Layout(NamedTuple):
    """Where the members of a structure lie."""

    offsets: tuple[int, ...]  # of each member (bytes)
    size: int  # of the structure (bytes)


def layout_of(members: Sequence[Member]) -> Layout:
    """Layout of the structure with these members in this order, as a C compiler makes it."""
    fields = [(f"m{k}", TYPES[kind] if width == 1 else TYPES[kind] * width) for k, (kind, width) in enumerate(members)]
    structure: Any = type("Members", (ctypes.Structure,), {"_fields_": fields})
    return Layout(tuple(getattr(structure, name).offset for name, _ in fields), ctypes.sizeof(structure))


def one_after_another(sizes: Sequence[int]) -> Layout:
    """Layout of parts of these sizes (bytes) in one memory."""
    offsets, end = [], 0
    for size in sizes:
        offsets.append(end)
        end += -(-size // BOUNDARY) * BOUNDARY
    return Layout(tuple(offsets), end)
