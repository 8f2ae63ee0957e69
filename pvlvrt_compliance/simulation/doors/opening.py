"""Which door a specification of a controller leads to."""

from collections.abc import Mapping
from pathlib import Path

from pvlvrt_compliance.simulation.doors.base import Door, DoorError, Value
from pvlvrt_compliance.simulation.doors.fmu_door import FmuDoor
from pvlvrt_compliance.simulation.doors.python_door import PythonDoor


def door_to(spec: str, given: Mapping[str, Value]) -> Door:
    """Door to a controller; ``given`` are the parameters that the user has set.

    Raises
    ------
    DoorError
        When no door fits, or there is nothing behind it.
    """
    if Path(spec).suffix == ".fmu":
        return FmuDoor(spec, given)
    file, _, name = spec.rpartition(":")
    if Path(file).suffix == ".py" or Path(spec).suffix == ".py":
        if not name or Path(spec).suffix == ".py":
            raise DoorError(f"name the class, too: {spec}:MyController")
        return PythonDoor(spec, given)
    raise DoorError("not a kind of controller that is known; write FILE.py:CLASS or FILE.fmu")
