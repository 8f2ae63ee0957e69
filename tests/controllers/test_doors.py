"""Which door a specification of a controller leads to."""

from pathlib import Path

import pytest

import pvlvrt_compliance
from pvlvrt_compliance.controllers import doors
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.doors import DOORS, door_to


@pytest.fixture
def door_of(monkeypatch):
    """Name of the room whose door is opened: ``door_of(spec)``."""

    def standing_in_for(door):
        class Door:
            written, schemes, suffixes = door.written, door.schemes, door.suffixes

            def __init__(self, *_arguments, **_named):
                self.room = door.__module__.split(".")[-2]

        return Door

    monkeypatch.setattr(doors, "DOORS", tuple(map(standing_in_for, DOORS)))
    return lambda spec: door_to(spec, {}).room


def test_every_folder_with_a_door_is_listed():
    """A kind of controller is known by its folder alone."""
    rooms = Path(pvlvrt_compliance.__file__).parent / "controllers"
    assert [door.__module__.split(".")[-2] for door in DOORS] == sorted(p.parent.name for p in rooms.glob("*/door.py"))


@pytest.mark.parametrize(
    ("spec", "room"),
    [
        ("c.py:C", "python"),
        ("c.py", "python"),
        (r"C:\\here\\c.py:C", "python"),
        ("lib.so.py:C", "python"),
        ("libc.so", "library"),
        ("./a.b/libc.so.1.2", "library"),
        (r"C:\\here\\c.dll", "library"),
        ("c.so.fmu", "fmu"),
        ("c.fmu", "fmu"),
        ("stdio:python3 c.py", "program"),
        ("stdio:./c.fmu", "program"),
        ("tcp://127.0.0.1:5000", "program"),
    ],
)
def test_where_a_specification_leads(door_of, spec, room):
    """By how it begins, else by how the file's name ends, with a class after it or not; the last suffix counts."""
    assert door_of(spec) == room


@pytest.mark.parametrize("spec", ["what.ever", "c", "", "file-1.txt:C", "http://example.org/c", "c.so/d"])
def test_what_leads_nowhere(spec):
    """What can be written is named, by every door for itself."""
    with pytest.raises(DoorError) as error:
        door_to(spec, {})
    assert "not a kind of controller that is known" in str(error.value)
    assert all(door.written in str(error.value) for door in DOORS)
