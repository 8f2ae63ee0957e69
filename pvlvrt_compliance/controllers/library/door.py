"""The door for a controller in C or C++ by the IEEE/CIGRE DLL interface (CIGRE TB 958): ``libctrl.so``."""

import ctypes
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from pvlvrt_compliance.controllers.description import Description, Value
from pvlvrt_compliance.controllers.door import Door, DoorCall, DoorError
from pvlvrt_compliance.controllers.faults import RAISED, Faults
from pvlvrt_compliance.controllers.library.file import SUFFIXES, Library
from pvlvrt_compliance.controllers.library.info import LibraryInfo, PortInfo, info_of, settings_of
from pvlvrt_compliance.controllers.library.instance import LibraryInstance, Snapshot
from pvlvrt_compliance.controllers.library.layout import Layout, ModelInfo, layout_of
from pvlvrt_compliance.controllers.mapping.as_far import both_sides, loaded
from pvlvrt_compliance.controllers.mapping.bare import both_bare
from pvlvrt_compliance.controllers.mapping.commands import check_commands
from pvlvrt_compliance.controllers.mapping.constants import set_constants
from pvlvrt_compliance.controllers.mapping.file import mapping_path
from pvlvrt_compliance.controllers.mapping.ties import Mapped, RawPort
from pvlvrt_compliance.simulation.door.blocks import Block, Element
from pvlvrt_compliance.simulation.door.exchange import SIGNALS
from pvlvrt_compliance.simulation.door.native_call import FUNCTION, address_of, guarded
from pvlvrt_compliance.units import Nominal

_DEMANDED = ("Model_CheckParameters", "Model_Initialize", "Model_Outputs", "Model_Terminate")
_NO_STATES = "keeps no state in the arrays of the interface: no snapshot of it can be made"


class _Functions(NamedTuple):
    """What a library exports and this host calls; never Model_PrintInfo, and Model_Iterate is of RMS tools."""

    check_parameters: Any
    initialize: Any
    outputs: Any
    terminate: Any
    first_call: Any  # None: not there


class LibraryDoor(Door):
    """Door for a shared library.

    Parameters
    ----------
    spec : str
        Its file.
    given : mapping
        Parameters that the user has set.
    mapping : str, optional
        Mapping file; by default ``<stem>.mapping.toml`` beside the library, if there is one.
    allow_out_of_range : bool
        Whether a parameter may be out of the range that it states for it.

    Raises
    ------
    DoorError
        When it cannot be loaded here, is no controller by the interface, or a parameter does not fit.
    """

    written = "libctrl.so (a shared library)"
    suffixes = SUFFIXES
    keeps_faults = True

    def __init__(
        self,
        spec: str,
        given: Mapping[str, Value],
        mapping: str | None = None,
        faults: Faults = RAISED,
        *,
        allow_out_of_range: bool = False,
    ) -> None:
        file = Path(spec)
        self._faults = faults
        self._library = Library(file, faults)
        self._info = _info(self._library, file, faults)
        self._functions = _functions(self._library, file, faults)
        self._unusable = tuple(faults.texts)
        self._settings = _settings(self._info, given, faults, allow_out_of_range)
        self._mapping_file = mapping_path(spec, mapping)
        self._mapping = loaded(self._mapping_file, faults)
        self._instance: LibraryInstance | None = None
        self._has_begun = False
        self._said = ""
        self._alive: tuple[Any, ...] = ()

    def describe(self) -> Description:
        """What the library announces, and how its ports are mapped."""
        inputs, outputs = self._mapped(0, 0, Nominal())
        return Description(
            kind="ieee-cigre",
            name=self._info.name,
            digest=self._library.digest,
            sample_time_s=self._info.sample_time_s,
            inputs=inputs.ports,
            outputs=outputs.ports,
            parameters=tuple(p.public() for p in self._info.parameters),
            notes=() if self._info.keeps_states else (_NO_STATES,),
            mapping=self._mapping_file,
        )

    def besides(self) -> str:
        """What the library takes from elsewhere, as far as its file says."""
        return self._library.besides()

    def may_be_listed(self) -> bool:
        """Files may be listed."""
        return True

    def open(self, nominal: Nominal) -> DoorCall:
        """Allocate an instance; the library's own first calls follow when its inputs are there."""
        if self._unusable:
            raise DoorError(self._unusable[0])
        instance = LibraryInstance(self._info, self._settings)
        self._has_begun = False
        self._instance = instance
        inputs, outputs = self._mapped(instance.inputs_at, instance.outputs_at, nominal)
        if not self._faults.kept:
            check_commands(outputs)
        set_constants(instance.memory, inputs.constants)
        time = Element(SIGNALS.index("time_s"), instance.time_at)
        first, note = (FUNCTION(guarded(do, self._say)) for do in (self._begin, instance.note))
        self._alive = (first, note)
        return DoorCall(
            address=address_of(self._functions.outputs),
            argument=instance.address,
            inputs=Block(instance.memory, (time, *inputs.elements)),
            outputs=Block(instance.memory, outputs.elements),
            first_address=address_of(first),
            hold_address=address_of(self._functions.initialize),
            note_address=address_of(note),
            in_volts=outputs.in_volts,
            in_a_frame=outputs.in_a_frame,
            recorded=outputs.recorded,
            notes=instance.notes,
        )

    def message(self) -> str:
        """Why the library failed."""
        if self._said or self._instance is None:
            return self._said
        return self._instance.error() or "it gave no reason (LastErrorMessage)"

    def close(self) -> None:
        """End the instance and let go of the library."""
        if self._instance is not None:
            self._functions.terminate(self._instance.address)
        self._instance = None
        self._library.close()

    def snapshot(self) -> Snapshot:
        """What the open controller remembers.

        Raises
        ------
        DoorError
            When it keeps no state in the arrays of the interface.
        """
        return self._open_instance().snapshot()

    def restore(self, snapshot: Snapshot) -> None:
        """Put the open controller back to where it was; see `LibraryInstance.restore`.

        Raises
        ------
        DoorError
            When the snapshot is of another controller, or the library fails.
        """
        instance = self._open_instance()
        instance.restore(snapshot)
        if not self._has_begun:  # what it sets up besides its states
            self._begin()
            instance.call(self._functions.initialize, "Model_Initialize")
            instance.restore(snapshot)
        if self._functions.first_call is not None:
            instance.call(self._functions.first_call, "Model_FirstCall")

    def resume(self, nominal: Nominal, snapshot: Any) -> DoorCall:
        """Allocate an instance, have it begin, and put the snapshot in its place."""
        opened = self.open(nominal)
        self.restore(snapshot)
        return opened

    def _open_instance(self) -> LibraryInstance:
        if self._instance is None:
            raise DoorError("the controller is not open")
        return self._instance

    def _mapped(self, inputs_at: int, outputs_at: int, nominal: Nominal) -> tuple[Mapped, Mapped]:
        inputs, outputs = _raw_ports(self._info.inputs, inputs_at), _raw_ports(self._info.outputs, outputs_at)
        if self.bare:
            return both_bare(inputs, outputs)
        return both_sides(inputs, outputs, self._mapping, nominal, self._faults)

    def _begin(self) -> None:
        """First calls of an instance: Model_FirstCall, if it is there, and Model_CheckParameters."""
        instance = self._open_instance()
        self._has_begun = True
        if self._functions.first_call is not None:
            instance.call(self._functions.first_call, "Model_FirstCall")
        before = instance.parameters()
        instance.call(self._functions.check_parameters, "Model_CheckParameters")
        for name, value in instance.parameters().items():
            if value != before[name]:
                instance.notes.append(f"the controller has changed its parameter {name} from {before[name]} to {value}")

    def _say(self, reason: str) -> None:
        self._said = reason


DOOR = LibraryDoor


def _info(library: Library, file: Path, faults: Faults) -> LibraryInfo:
    get_info = library.function("Model_GetInfo", ctypes.POINTER(ModelInfo))
    if get_info is None:
        raise DoorError(f"{file.name} has no function Model_GetInfo: it is not made for the IEEE/CIGRE DLL interface")
    found = get_info()
    if not found:
        raise DoorError(f"Model_GetInfo of {file.name} gives nothing")
    return info_of(found.contents, faults)


def _settings(
    info: LibraryInfo, given: Mapping[str, Value], faults: Faults, allow_out_of_range: bool
) -> dict[str, Value]:
    with faults.told():
        return settings_of(info.parameters, given, allow_out_of_range)
    return settings_of(info.parameters, {})


def _functions(library: Library, file: Path, faults: Faults) -> _Functions:
    names = (*_DEMANDED, "Model_FirstCall")
    found = [library.function(name, arguments=(ctypes.c_void_p,)) for name in names]
    missing = [name for name, function in zip(_DEMANDED, found, strict=False) if function is None]
    if missing:
        faults.tell(f"{file.name} has no function {' and '.join(missing)}")
    return _Functions(*found)


def _raw_ports(ports: Sequence[PortInfo], at: int) -> list[RawPort]:
    layout: Layout = layout_of([port.member for port in ports])
    return [
        RawPort(port.name, port.unit, port.member.width, at + offset, port.member.kind, port.description)
        for port, offset in zip(ports, layout.offsets, strict=True)
    ]
