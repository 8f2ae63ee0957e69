"""Which door a specification of a controller leads to."""

from collections.abc import Mapping
from pathlib import Path

from pvlvrt_compliance.simulation.doors.base import Door, DoorError, Value
from pvlvrt_compliance.simulation.doors.fmu_door import FmuDoor
from pvlvrt_compliance.simulation.doors.library_door import LibraryDoor
from pvlvrt_compliance.simulation.doors.library_file import SUFFIXES
from pvlvrt_compliance.simulation.doors.program_door import SCHEMES, ProgramDoor
from pvlvrt_compliance.simulation.doors.python_door import PythonDoor


def door_to(spec: str, given: Mapping[str, Value], mapping: str | None = None) -> Door:
    """Door to a controller; ``given`` are the parameters that the user has set, ``mapping`` names a mapping file.

    Raises
    ------
    DoorError
        When no door fits, or there is nothing behind it.
    """
    if spec.startswith(SCHEMES):
        return ProgramDoor(spec, given, mapping)
    file, _, name = spec.rpartition(":")
    if Path(file).suffix == ".py" or Path(spec).suffix == ".py":
        if not name or Path(spec).suffix == ".py":
            raise DoorError(f"name the class, too: {spec}:MyController")
        if mapping is not None:
            raise DoorError("a Python class takes its measurements by their names; --mapping does not go with it")
        return PythonDoor(spec, given)
    if Path(spec).suffix == ".fmu":
        return FmuDoor(spec, given, mapping)
    if set(Path(spec).suffixes) & set(SUFFIXES):
        return LibraryDoor(spec, given, mapping)
    raise DoorError(
        "not a kind of controller that is known; write FILE.py:CLASS, a shared library (libctrl.so) or FILE.fmu"
    )
