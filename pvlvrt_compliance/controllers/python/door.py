"""The door for a Python class, ``my_ctrl.py:MyController``: see `pvlvrt_compliance.controllers`."""

import hashlib
import inspect
import math
import reprlib
import struct
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from pvlvrt_compliance.controllers import Measurements
from pvlvrt_compliance.controllers.channels import check_channel
from pvlvrt_compliance.controllers.description import Description, ParameterInfo, Port, Value
from pvlvrt_compliance.controllers.door import Door, DoorCall, DoorError
from pvlvrt_compliance.controllers.given_parameters import checked_parameters
from pvlvrt_compliance.controllers.mapping.file import load_mapping, mapping_path
from pvlvrt_compliance.controllers.python.importing import class_in, tail
from pvlvrt_compliance.controllers.python.tasks import NUMBERS, every, put, switches, with_slow_task
from pvlvrt_compliance.controllers.spelling import SUFFIX
from pvlvrt_compliance.simulation.door.blocks import MODULATING, VOLTAGES, real_block
from pvlvrt_compliance.simulation.door.exchange import COMMANDS, SIGNALS
from pvlvrt_compliance.simulation.door.native_call import FAILED, FUNCTION, address_of
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import unit_of

_MOST_SIGNALS = 200


class PythonDoor(Door):
    """Door for a Python class.

    Parameters
    ----------
    spec : str
        File and class, ``my_ctrl.py:MyController``, or module and class, ``pkg.module:MyController``: one that is
        installed, or lies in the working folder.
    given : mapping
        Parameters that the user has set.
    mapping : str, optional
        Mapping file, which can only list files: it takes its measurements by their names. By default one beside its
        file that does.

    Raises
    ------
    DoorError
        When there is no such file, module or class, it cannot be made, or it is not a controller.
    """

    written = "FILE.py:CLASS, MODULE:CLASS"
    suffixes = (SUFFIX,)

    _mapping_file: str | None = None

    def __init__(self, spec: str, given: Mapping[str, Value], mapping: str | None = None) -> None:
        place, _, self._class_name = spec.rpartition(":")
        if Path(spec).suffix == SUFFIX:
            raise DoorError(f"name the class, too: {spec}:MyController")
        if not place or not self._class_name.isidentifier():
            raise DoorError(f"write {self.written}")
        found = class_in(place, self._class_name)
        self._file = found.file
        self._begin(found.made, given)
        self._digest = hashlib.sha256(self._file.read_bytes()).hexdigest()
        self._mapping_file = _list_of_files(str(self._file), mapping)

    def _begin(self, made: Any, given: Mapping[str, Value]) -> None:
        """Make the controller, and see that it is one."""
        self._parameters = _parameters(made)
        self._controller = _make(made, checked_parameters(given, self._parameters), bool(_defaults(made)))
        self._said = ""
        self._alive: tuple[Any, ...] = ()
        self._sample_time_s = _sample_time_s(self._controller)
        self._switches = switches(self._controller)
        self._every = every(self._controller)
        for method in ("reset", "step"):
            if not callable(getattr(self._controller, method, None)):
                raise DoorError(f"{self._class_name} has no method {method}()")

    def describe(self) -> Description:
        """Class, file, what it can be given and what it commands."""
        commands = self._commands
        return Description(
            kind="python",
            name=self._class_name,
            digest=self._digest,
            sample_time_s=self._sample_time_s,
            inputs=tuple(Port(name, unit_of(name), mapped_to=name) for name in SIGNALS),
            outputs=tuple(Port(name, unit_of(name), mapped_to=name) for name in commands),
            parameters=self._parameters,
            mapping=self._mapping_file,
        )

    def besides(self) -> str:
        """What a class imports and reads is not known."""
        return "a Python class may import and read anything"

    def may_be_listed(self) -> bool:
        """Files may be listed."""
        return True

    @property
    def _in_volts(self) -> bool:
        return bool(getattr(self._controller, "commands_voltages", False))

    @property
    def _commands(self) -> tuple[str, ...]:
        """What `step` returns, in its order."""
        return (*(VOLTAGES if self._in_volts else MODULATING), *self._switches)

    def open(self, nominal: Nominal) -> DoorCall:
        """Reset the controller and make the function that the loop calls."""
        try:
            self._controller.reset(nominal)
            names = self._signal_names()
        except DoorError:
            raise
        except BaseException as error:
            raise DoorError(f"reset() failed: {tail(error)}") from None
        inputs = real_block(range(len(SIGNALS)))
        commands = self._commands
        further = range(len(COMMANDS), len(COMMANDS) + len(names))
        outputs = real_block([*(COMMANDS.index(name) for name in commands), *further])
        function = FUNCTION(self._caller(inputs.memory.data, outputs.memory.data.cast("d"), names))
        self._alive = (function, inputs, outputs)
        return DoorCall(
            address=address_of(function),
            argument=0,
            inputs=inputs,
            outputs=outputs,
            in_volts=self._in_volts,
            every=self._every,
            recorded=names,
        )

    def message(self) -> str:
        """The exception that ended the last step."""
        return self._said

    def close(self) -> None:
        """Let go of the controller."""
        self._alive = ()

    def _signal_names(self) -> tuple[str, ...]:
        if not callable(getattr(self._controller, "signals", None)):
            return ()
        names = tuple(self._controller.signals())
        try:
            for name in names:
                check_channel(name)
        except DoorError as error:
            raise DoorError(f"signals(): {error}") from None
        if len(names) > _MOST_SIGNALS:
            raise DoorError(f"signals(): {len(names)} are too many; {_MOST_SIGNALS} can be recorded")
        return names

    def _caller(self, inputs: Any, outputs: Any, names: tuple[str, ...]) -> Callable[[Any], int]:
        """Function that advances the controller by one sample; it gives 1 when that fails."""
        controller = self._controller
        step = with_slow_task(controller) if self._every > 1 else controller.step
        signals = controller.signals if names else None
        due = len(self._commands)
        read = struct.Struct(f"{len(SIGNALS)}d").unpack_from
        new: Any = tuple.__new__

        def advance(_argument: Any) -> int:
            try:
                # Not `_make`, which checks the length anew: this is the cost of every sample.
                commands = step(new(Measurements, read(inputs)))
            except BaseException as error:
                self._said = f"step() failed: {tail(error)}"
                return FAILED
            try:
                if due == len(MODULATING):
                    outputs[0], outputs[1], outputs[2] = commands
                else:
                    put(outputs, commands, due)
            except (TypeError, ValueError) as error:
                self._said = f"step() must return {NUMBERS[due]} numbers, not {reprlib.repr(commands)}: {error}"
                return FAILED
            return 0

        def advance_and_ask(argument: Any) -> int:
            if advance(argument) or signals is None:
                return FAILED
            try:
                said = signals()
                for k, name in enumerate(names, start=due):
                    outputs[k] = said[name]
                return 0
            except BaseException as error:
                self._said = f"signals() failed: {tail(error)}"
                return FAILED

        return advance_and_ask if names else advance


DOOR = PythonDoor


def _list_of_files(file: str, named: str | None) -> str | None:
    """The mapping file, where it lists files.

    Raises
    ------
    DoorError
        When one is named that ties ports; one that lies there may be of a library of the same name.
    """
    path = mapping_path(file, named)
    mapping = load_mapping(path)
    if named is not None and mapping is not None and mapping.model_fields_set - {"files"}:
        said = "a Python class takes its measurements by their names"
        raise DoorError(f"{said}; --mapping does not go with it, but for one that only lists files (files = [...])")
    return path if mapping is not None and mapping.files else None


def _defaults(made: Any) -> dict[str, Value]:
    """Arguments of the constructor that have a default which can be set."""
    try:
        arguments = inspect.signature(made).parameters.values()
    except (TypeError, ValueError):
        return {}
    return {a.name: a.default for a in arguments if isinstance(a.default, (bool, int, float, str))}


def _parameters(made: Any) -> tuple[ParameterInfo, ...]:
    """Parameters of a class, with their defaults."""
    return tuple(ParameterInfo(name, value) for name, value in (_defaults(made) or _attributes(made)).items())


def _attributes(made: Any) -> dict[str, Value]:
    """Public attributes of a class that can be set."""
    names = [name for name in dir(made) if not name.startswith("_") and name != "commands_voltages"]
    found = {name: getattr(made, name) for name in names}
    return {name: value for name, value in found.items() if isinstance(value, (bool, int, float, str))}


def _make(made: Any, given: Mapping[str, Value], keywords: bool) -> Any:
    try:
        if keywords:
            return made(**given)
        controller = made()
        for name, value in given.items():
            setattr(controller, name, value)
        return controller
    except BaseException as error:
        raise DoorError(f"{getattr(made, '__name__', made)} cannot be made: {tail(error)}") from None


def _sample_time_s(controller: Any) -> float:
    name = type(controller).__name__
    given = getattr(controller, "sample_time_s", None)
    if given is None:
        raise DoorError(f"{name} has no attribute sample_time_s")
    if isinstance(given, (int, float)) and math.isfinite(given) and given > 0:
        return float(given)
    raise DoorError(f"{name}.sample_time_s is {reprlib.repr(given)}; it must be a number of seconds above zero")
