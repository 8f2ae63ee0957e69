"""An FMU that is loaded and stepped: FMI 2 and FMI 3 made alike."""

import ctypes
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from pvlvrt_compliance.controllers.description import Value
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.fmu.binary import why_not
from pvlvrt_compliance.controllers.fmu.model import FmuModel, FmuParameter, fmi_library
from pvlvrt_compliance.controllers.fmu.ports import Ports
from pvlvrt_compliance.controllers.notes import note_once
from pvlvrt_compliance.simulation.door.ending import keep
from pvlvrt_compliance.simulation.door.native_call import address_of

OK, WARNING, DISCARD, ERROR, FATAL, PENDING, TERMINATED = range(7)
"""What a function of FMI gives; the last is none of FMI's: a step was done, and is to be the last."""

_STATUS = ("ok", "warning", "discard", "error", "fatal error", "pending (it computes asynchronously)")
_NUMBERS: Mapping[str, Any] = {
    "Real": ctypes.c_double,
    "Integer": ctypes.c_int,
    "Float64": ctypes.c_double,
    "Float32": ctypes.c_float,
    "Int8": ctypes.c_int8,
    "UInt8": ctypes.c_uint8,
    "Int16": ctypes.c_int16,
    "UInt16": ctypes.c_uint16,
    "Int32": ctypes.c_int32,
    "UInt32": ctypes.c_uint32,
}
_OF_FMI_3 = ("InstantiateCoSimulation", "instantiationToken")
_LOG_LINES = 6
_TERMINATED_KIND = 3  # fmi2Terminated

Call = tuple[Callable[..., int], tuple[Any, ...]]


class Fmu:
    """A loaded FMU at rest.

    Parameters
    ----------
    model : FmuModel
        What it says of itself.
    folder : Path
        Where it is unpacked.
    """

    def __init__(self, model: FmuModel, folder: Path) -> None:
        self._log: deque[str] = deque(maxlen=_LOG_LINES)
        self.notes: list[str] = []
        self.steps = 0  # that have been asked of it
        self._status, self._why = OK, ""
        self.version = model.version
        self._prefix, self._token = f"fmi{model.version}", model.token
        library = fmi_library()
        self._fmi = library.fmi2 if model.version == "2" else library.fmi3
        kind = library.fmi2.FMU2Slave if model.version == "2" else library.fmi3.FMU3Slave
        try:
            self._fmu = kind(
                instanceName=model.identifier,
                guid=model.token,
                modelIdentifier=model.identifier,
                unzipDirectory=str(folder),
            )
        except Exception as error:
            raise DoorError(f"its binary cannot be loaded: {why_not(error, folder / model.binary, kind)}") from None
        self._boolean = ctypes.c_int if model.version == "2" else ctypes.c_bool
        self._alive: list[Any] = []
        self._names: dict[int, str] = {}

    def start(self, parameters: Iterable[tuple[FmuParameter, Value]], inputs: Ports) -> None:
        """Instantiate and initialise it at time 0; its inputs in the block become those that it starts from.

        Raises
        ------
        DoorError
            When it does not let that happen, with what it logs.
        """
        try:
            self._instantiate()
            for parameter, value in parameters:
                self._set(parameter, value)
            if self.version == "2":
                self._fmu.setupExperiment(startTime=0.0)
            self._fmu.enterInitializationMode()
            self._run(self.getting(inputs))
            self._fmu.exitInitializationMode()
        except Exception as error:
            raise DoorError(self._with_log(f"it does not start: {error}")) from None

    def stepping(self, sample_time_s: float, inputs: Ports, outputs: Ports) -> Callable[[Any], int]:
        """Function that takes it from one sample to the next: inputs in, a step, outputs out; 0 when all is well."""
        time = ctypes.c_double()
        calls = (*self.setting(inputs), (self._do_step(time, sample_time_s), ()), *self.getting(outputs))

        def advance(_argument: Any) -> int:
            time.value = self.steps * sample_time_s
            self.steps += 1
            try:
                for function, arguments in calls:
                    if status := function(*arguments):
                        if status != WARNING:
                            self._ended(function, status)
                            return 1
                        self._warned(function)
            except BaseException as error:  # a signal, where this is the process of the command
                keep(error)
                self._why = repr(error)
                return 1
            return 0

        return advance

    def setting(self, ports: Ports) -> tuple[Call, ...]:
        """Calls that give an FMU the numbers in a block."""
        return self._calls("Set", ports)

    def getting(self, ports: Ports) -> tuple[Call, ...]:
        """Calls that take the numbers of a block from an FMU."""
        return self._calls("Get", ports)

    def call(self, name: str, *arguments: tuple[Any, int | None]) -> None:
        """Call a function of FMI with the instance and numbers, each with its type of C.

        Raises
        ------
        DoorError
            When it gives more than a warning, with what the FMU has logged; nothing is asked of it after that.
        """
        if self._status not in (OK, WARNING):
            raise DoorError(f"{self._prefix}{name} may not be called any more: {self._why}")
        function = self._bare(name, *(kind for kind, _ in arguments))
        status = function(self._fmu.component, *(value for _, value in arguments))
        if status not in (OK, WARNING):
            self._status, self._why = status, self._gave(function, status)
            raise DoorError(self.message())

    @property
    def log(self) -> tuple[str, ...]:
        """What it has logged last."""
        return tuple(self._log)

    def go_on(self, steps: int, log: Iterable[str]) -> None:
        """Count and tell on as one that has done so many steps, and has logged this."""
        self.steps = steps
        self._log.clear()
        self._log.extend(log)

    def message(self) -> str:
        """Why its last step was not done, with what it has logged."""
        return self._with_log(self._why)

    def end(self) -> None:
        """Let go of the instance; an FMU that has failed is not asked for anything more than FMI allows."""
        component, self._fmu.component = self._fmu.component, None
        if not component or self._status == FATAL:
            return
        if self._status in (OK, WARNING, TERMINATED):
            getattr(self._fmu.dll, f"{self._prefix}Terminate")(component)
        getattr(self._fmu.dll, f"{self._prefix}FreeInstance")(component)

    def _instantiate(self) -> None:
        try:
            self._make_instance()
        except Exception as error:
            if not str(error).startswith("Failed to instantiate"):
                raise
            raise DoorError(self._no_instance) from None

    @property
    def _no_instance(self) -> str:
        """What a binary that gives no instance most often means by it."""
        called, attribute = ("Instantiate", "guid") if self.version == "2" else _OF_FMI_3
        return (
            f"{self._prefix}{called} gave no instance: most often the {attribute} of its modelDescription.xml,"
            f" {self._token!r}, is not the one that its binary was built with"
        )

    def _make_instance(self) -> None:
        if self.version == "3":
            self._fmu.instantiate(logMessage=self._noted_3)
            return
        callbacks = self._fmi.fmi2CallbackFunctions()
        callbacks.logger = self._fmi.fmi2CallbackLoggerTYPE(self._noted_2)
        callbacks.allocateMemory = self._fmi.defaultCallbacks.allocateMemory
        callbacks.freeMemory = self._fmi.defaultCallbacks.freeMemory
        if (proxy := getattr(self._fmi, "addLoggerProxy", None)) is not None:
            proxy(ctypes.byref(callbacks))  # puts the arguments of C into the text
        self._fmu.instantiate(callbacks=callbacks)

    def _noted_2(self, _environment: Any, _name: Any, status: int, _category: Any, message: bytes) -> None:
        self._noted_3(None, status, None, message)

    def _noted_3(self, _environment: Any, status: int, _category: Any, message: bytes | None) -> None:
        text = (message or b"").decode("utf-8", "replace").strip()
        if text:
            self._log.append(f"[{_STATUS[status]}] {text}" if 0 < status < len(_STATUS) else text)

    def _set(self, parameter: FmuParameter, value: Value) -> None:
        calls = parameter.type
        if calls == "Enumeration":
            calls = "Integer" if self.version == "2" else "Int64"
        getattr(self._fmu, f"set{calls}")([parameter.reference], [value])

    def _calls(self, verb: str, ports: Ports) -> tuple[Call, ...]:
        """Make one call a type, with everything that it is called with."""
        calls = []
        for name in dict.fromkeys(v.type.calls for v in ports.variables):
            places = [(v, raw) for v, raw in zip(ports.variables, ports.raw, strict=True) if v.type.calls == name]
            references = (ctypes.c_uint * len(places))(*(v.reference for v, _ in places))
            width = sum(v.width for v, _ in places)
            number = _NUMBERS.get(name, self._boolean)
            values = (number * width).from_buffer(ports.memory, places[0][1].byte)
            counted = (ctypes.c_size_t,) if self.version == "3" else ()
            self._alive += [references, values]
            function = self._bare(f"{verb}{name}", ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p, *counted)
            addresses = (ctypes.addressof(references), len(places), ctypes.addressof(values))
            calls.append((function, (self._fmu.component, *addresses, *(len(values) for _ in counted))))
        return tuple(calls)

    def _run(self, calls: Iterable[Call]) -> None:
        for function, arguments in calls:
            if (status := function(*arguments)) > WARNING:
                raise DoorError(f"{self._name(function)} gave {_STATUS[status]}")

    def _bare(self, name: str, *arguments: Any) -> Any:
        """Give a function of the binary that takes the instance and plain numbers: fewer conversions at every call."""
        found = getattr(self._fmu.dll, f"{self._prefix}{name}")
        function = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, *arguments)(address_of(found))
        self._names[id(function)] = f"{self._prefix}{name}"
        self._alive.append(function)
        return function

    def _do_step(self, time: ctypes.c_double, step_s: float) -> Callable[[], int]:
        component, double = self._fmu.component, ctypes.c_double
        if self.version == "2":
            function = self._bare("DoStep", double, double, ctypes.c_int)
            return lambda: function(component, time, step_s, 1)
        function = self._bare("DoStep", double, double, ctypes.c_bool, *4 * [ctypes.c_void_p])
        event, terminate, early = ctypes.c_bool(), ctypes.c_bool(), ctypes.c_bool()
        results = (event, terminate, early, double())
        self._alive.append(results)
        addresses = tuple(ctypes.addressof(result) for result in results)

        def do_step() -> int:
            status: int = function(component, time, step_s, True, *addresses)
            if status == OK and (terminate.value or early.value):
                return TERMINATED if terminate.value else DISCARD
            return status

        return do_step

    def _name(self, function: Any) -> str:
        """Name of a function of FMI; the step is wrapped in one of Python."""
        return self._names.get(id(function), f"{self._prefix}DoStep")

    def _warned(self, function: Any) -> None:
        said = self._log[-1] if self._log else f"{self._name(function)} gave a warning"
        note_once(self.notes, said)

    def _ended(self, function: Any, status: int) -> None:
        self._status = status
        if status == TERMINATED or (status == DISCARD and self.version == "2" and self._asks_for_the_end()):
            self._why = "the FMU asks for the end of the simulation"
        else:
            self._why = self._gave(function, status)

    def _gave(self, function: Any, status: int) -> str:
        known = 0 <= status < len(_STATUS)
        return f"{self._name(function)} gave {_STATUS[status] if known else f'{status}, which FMI does not have'}"

    def _asks_for_the_end(self) -> bool:
        value = ctypes.c_int()
        status = self._fmu.dll.fmi2GetBooleanStatus(self._fmu.component, _TERMINATED_KIND, ctypes.byref(value))
        return bool(status == OK and value.value)

    def _with_log(self, text: str) -> str:
        return "\n".join([text, *(f"  {line}" for line in self._log)])
