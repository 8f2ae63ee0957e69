"""The door for a Python class, ``my_ctrl.py:MyController``: see `pvlvrt_compliance.controllers`."""

import hashlib
import pickle
import reprlib
import struct
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from pvlvrt_compliance.controllers import Measurements
from pvlvrt_compliance.controllers.channels import check_channel
from pvlvrt_compliance.controllers.description import Description, Port, Value
from pvlvrt_compliance.controllers.door import Door, DoorCall, DoorError
from pvlvrt_compliance.controllers.faults import RAISED, Faults
from pvlvrt_compliance.controllers.file import content_of
from pvlvrt_compliance.controllers.given_parameters import checked_parameters
from pvlvrt_compliance.controllers.mapping.bare import FIRST_INPUT
from pvlvrt_compliance.controllers.mapping.file import load_mapping, mapping_path
from pvlvrt_compliance.controllers.mapping.units_of_names import unit_of_name
from pvlvrt_compliance.controllers.notes import of_slow_task
from pvlvrt_compliance.controllers.python.importing import let_pass, tail
from pvlvrt_compliance.controllers.python.making import defaults_of, make, parameters_of, sample_time_s_of
from pvlvrt_compliance.controllers.python.reading import class_or_text
from pvlvrt_compliance.controllers.python.tasks import NUMBERS, every, lack_of, notes_of, put, switches, with_slow_task
from pvlvrt_compliance.controllers.spelling import SUFFIX
from pvlvrt_compliance.simulation.door.blocks import MODULATING, VOLTAGES, real_block
from pvlvrt_compliance.simulation.door.ending import keep
from pvlvrt_compliance.simulation.door.exchange import COMMANDS, SIGNALS
from pvlvrt_compliance.simulation.door.native_call import FAILED, FUNCTION, address_of
from pvlvrt_compliance.units import Nominal

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
    allow_out_of_range : bool
        Of no meaning here: a class states no ranges.

    Raises
    ------
    DoorError
        When there is no such file, module or class, it cannot be made, or it is not a controller.
    """

    written = "FILE.py:CLASS, MODULE:CLASS"
    suffixes = (SUFFIX,)
    keeps_faults = True

    measurements: type[Measurements] = Measurements
    """What `step` is given; another may look at what is read of it."""

    _mapping_file: str | None = None
    _notes: tuple[str, ...] = ()
    _unusable = ""

    def __init__(
        self,
        spec: str,
        given: Mapping[str, Value],
        mapping: str | None = None,
        faults: Faults = RAISED,
        *,
        allow_out_of_range: bool = False,  # noqa: ARG002 - a class states none
    ) -> None:
        place, _, self._class_name = spec.rpartition(":")
        if Path(spec).suffix == SUFFIX:
            raise DoorError(f"name the class, too: {spec}:MyController")
        if not place or not self._class_name.isidentifier():
            raise DoorError(f"write {self.written}")
        found = class_or_text(place, self._class_name, faults)
        self._file, self._notes = found.file, found.notes
        self._begin(found.made, given, faults, "".join(faults.texts))
        self._digest = hashlib.sha256(content_of(self._file)).hexdigest()
        with faults.told():
            self._mapping_file = _list_of_files(str(self._file), mapping)

    def _begin(self, made: Any, given: Mapping[str, Value], faults: Faults = RAISED, unusable: str = "") -> None:
        """Make the controller, and see that it is one. A class that is ``unusable`` is only seen."""
        self._said = ""
        self._alive: tuple[Any, ...] = ()
        self._parameters = parameters_of(made)
        settings: dict[str, Value] = {}
        with faults.told():
            settings = checked_parameters(given, self._parameters)
        known, self._controller = len(faults.texts), made
        if not unusable:
            with faults.told():
                self._controller = make(made, settings, bool(defaults_of(made)))
        if unusable or len(faults.texts) > known:  # what the class says counts, and what it lacks may be made with it
            self._see(made, Faults(kept=True))
        else:
            self._see(self._controller, faults)
        self._unusable = unusable or "".join(faults.texts[known : known + 1])

    def _see(self, controller: Any, faults: Faults) -> None:
        """What a controller, or a class of which none can be made, says by its attributes and methods."""
        self._sample_time_s, self._every = 0.0, 1
        self._switches: tuple[str, ...] = ()
        with faults.told():
            self._sample_time_s = sample_time_s_of(controller)
        with faults.told():
            self._switches = switches(controller)
        with faults.told():
            self._every = every(controller)
        self._idle = notes_of(controller)
        for method in ("reset", "step", *(("step_slow",) if self._every > 1 else ())):
            if lack := lack_of(controller, method):
                faults.tell(lack)

    def describe(self) -> Description:
        """Class, file, what it can be given and what it commands."""
        commands = self._commands
        return Description(
            kind="python",
            name=self._class_name,
            digest=self._digest,
            sample_time_s=self._sample_time_s,
            inputs=tuple(Port(name, unit_of_name(name), mapped_to=name) for name in SIGNALS),
            outputs=tuple(Port(name, unit_of_name(name), mapped_to=name) for name in commands),
            parameters=self._parameters,
            notes=(*self._notes, *self._idle, *of_slow_task(self._every, self._sample_time_s)),
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
        if self._unusable:
            raise DoorError(self._unusable)
        self._reset(nominal)
        return self._opened()

    def _reset(self, nominal: Nominal) -> None:
        try:
            self._controller.reset(nominal)
        except DoorError:
            raise
        except BaseException as error:
            let_pass(error)
            raise DoorError(f"reset() failed: {tail(error)}") from None

    def _opened(self) -> DoorCall:
        try:
            names = self._signal_names()
        except DoorError:
            raise
        except BaseException as error:
            let_pass(error)
            raise DoorError(f"signals() failed: {tail(error)}") from None
        first = FIRST_INPUT if self.bare else 0
        inputs = real_block(range(first, first + len(SIGNALS)))
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

    def snapshot(self) -> bytes:
        """The controller as pickle has it."""
        try:
            return pickle.dumps(self._controller)
        except BaseException as error:
            raise DoorError(f"{self._class_name} cannot be pickled: {error!r}") from None

    def resume(self, nominal: Nominal, snapshot: Any) -> DoorCall:
        """Put a pickled controller in the place of one at rest, which may have set up what stands beside it."""
        self._reset(nominal)
        try:
            self._controller = pickle.loads(snapshot)
        except BaseException as error:
            raise DoorError(f"{self._class_name} cannot be unpickled: {error!r}") from None
        return self._opened()

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
        new, told = tuple.__new__, self.measurements

        def advance(_argument: Any) -> int:
            try:
                # Not `_make`, which checks the length anew: this is the cost of every sample.
                commands = step(new(told, read(inputs)))
            except BaseException as error:
                keep(error)
                self._said = f"step() failed: {tail(error)}"
                return FAILED
            try:
                if due == len(MODULATING):
                    outputs[0], outputs[1], outputs[2] = commands
                else:
                    put(outputs, commands, due)
            except (TypeError, ValueError) as error:
                which = f" ({', '.join(self._commands)})" if due > len(MODULATING) else ""
                self._said = f"step() must return {NUMBERS[due]} numbers{which}, not {reprlib.repr(commands)}: {error}"
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
                keep(error)
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
