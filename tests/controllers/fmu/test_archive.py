"""An archive that is damaged, or unpacks to what no FMU is, is refused in one line before it is unpacked."""

import random
import zipfile
from contextlib import suppress

import fmpy
import pytest
from fmu_sources import description

from pvlvrt_compliance.controllers.door import DoorError, described
from pvlvrt_compliance.controllers.fmu.archive import check_archive, unpack
from pvlvrt_compliance.controllers.fmu.door import FmuDoor
from pvlvrt_compliance.controllers.limits import Limits, hold_to


@pytest.fixture
def archive(tmp_path):
    """An FMU whose binary is none."""
    file = tmp_path / "small.fmu"
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as made:
        made.writestr("modelDescription.xml", description(3))
        made.writestr(f"binaries/{fmpy.platform_tuple}/small{fmpy.sharedLibraryExtension}", bytes(range(256)) * 9)
    return file


@pytest.fixture
def limited():
    """Hold this process to limits for a while: ``limited(files=3)``."""
    yield lambda **limits: hold_to(Limits(**limits))
    hold_to(Limits())


def use(file):
    """What is done with an FMU before it is run."""
    door = FmuDoor(str(file), {})
    described(door)
    unpack(file, file.with_suffix(""))


@pytest.mark.parametrize("seed", range(40))
def test_damage_is_told_in_words(archive, seed):
    """Whichever bytes are changed, lost or doubled: it can be used all the same, or is refused with a reason."""
    draw, data = random.Random(seed), archive.read_bytes()
    for _ in range(10):
        damaged, at = bytearray(data), draw.randrange(len(data))
        match draw.randrange(4):
            case 0:
                damaged[at] ^= 1 << draw.randrange(8)
            case 1:
                damaged[at:] = b""
            case 2:
                damaged[at : at + draw.randrange(1, 40)] = b""
            case _:
                damaged[at : at + 4] = draw.randbytes(4)
        archive.write_bytes(damaged)
        with suppress(DoorError):
            use(archive)


def test_a_whole_one_is_let_through(archive):
    """Its limits hold it just so."""
    use(archive)
    assert len(list(archive.with_suffix("").rglob("*.*"))) == 2


@pytest.mark.parametrize(
    ("limits", "words"),
    [
        ({"files": 1}, "it holds 2 files, more than 1 (simulation.files_limit)"),
        ({"files_mb": 0.001}, "more than 0.001 MB"),
    ],
)
def test_limits_are_those_of_the_run(archive, limited, limits, words):
    """They are named, with how they are raised."""
    limited(**limits)
    with pytest.raises(DoorError) as error:
        check_archive(archive)
    assert words in str(error.value)
    assert "allows more" in str(error.value)


@pytest.mark.parametrize(
    "name", ["../x", "/x", "a/../../x", "..\\x", "C:/x", "C:\\x", "resources/../../x", "//host/x", "\\\\host\\x"]
)
def test_places_outside_of_its_folder(archive, name):
    """By any system's way to write them."""
    with zipfile.ZipFile(archive, "a") as made:
        made.writestr(name, b"")
    with pytest.raises(DoorError, match="lies outside of its folder"):
        check_archive(archive)


@pytest.mark.parametrize("mode", [0o120777, 0o010666, 0o020666, 0o060666, 0o140666])
def test_what_is_no_file(archive, mode):
    """A link, a pipe, a device, a socket."""
    entry = zipfile.ZipInfo("resources/x")
    entry.external_attr = mode << 16
    with zipfile.ZipFile(archive, "a") as made:
        made.writestr(entry, b"/etc/passwd")
    with pytest.raises(DoorError, match="is a link, or no ordinary file"):
        check_archive(archive)


@pytest.mark.parametrize("name", ["resources/a b.csv", "resources/..x", "resources/ä", "a:b/c"[2:], "documentation/"])
def test_names_that_are_well(archive, name):
    """Whatever else is written in them."""
    with zipfile.ZipFile(archive, "a") as made:
        made.writestr(name, b"")
    check_archive(archive)
