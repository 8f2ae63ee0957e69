"""A bad library costs its own run and no more; one that cannot be used is refused with the reason."""

import platform
import shutil
import struct
import sys

import numpy as np
import pytest

from pvlvrt_compliance.controllers.simulator import ForeignSimulator
from pvlvrt_compliance.errors import SimulationError, UsageError
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.columns import PLANT_CHANNELS
from pvlvrt_compliance.simulation.parameters import parameters_from
from waiting import stopped_in_its_loop

pytestmark = pytest.mark.compiler

SCENARIO = Scenario(sag=Sag(depth=0.0), duration_s=0.1, after_s=0.1)
QUICK = parameters_from(("simulation.settling_s=0.2", "simulation.synchronising_s=0.2"))
WHEN = "0.0999 s"
"""Simulated time of what happens at 0.5 s of the controller's, which begins 2 x 4884 samples before the record."""

(NOTHING, CRASH, LOOP, NAN, TOO_LARGE, ERROR, PRINT, EXIT, MESSAGE, UNDEFINED, ABORT) = range(11)
linux_only = pytest.mark.skipif(sys.platform != "linux", reason="shared libraries of Linux")


@pytest.fixture(scope="module")
def misbehaving(compiled):
    """Open the library that misbehaves in a way."""

    def open_it(how, at_s=0.5):
        return ForeignSimulator(str(compiled("misbehaving.c")), {"how": how, "at_s": at_s})

    return open_it


@pytest.mark.parametrize(
    ("how", "reason"),
    [
        (CRASH, "the controller crashed (SIGSEGV) at"),
        (ABORT, "the controller crashed (SIGABRT) at"),
        (NAN, "a command of the controller is not a finite number at"),
        (TOO_LARGE, "a command of the controller is out of range at"),
        (ERROR, "the current measurement is implausible"),
        (UNDEFINED, "the controller failed at"),
        (EXIT, "the controller ended the process (status 0) at"),
    ],
)
def test_what_is_wrong_is_told_with_its_time(misbehaving, how, reason):
    """The error has the reason and the simulated time, and the next run is fine."""
    with pytest.raises(SimulationError) as error:
        misbehaving(how)(SCENARIO, QUICK)
    assert reason in str(error.value)
    assert WHEN in str(error.value)
    assert misbehaving(NOTHING)(SCENARIO, QUICK).end_s > 0.4


TRIPPED = parameters_from(
    ("simulation.settling_s=0.2", "simulation.synchronising_s=0.2", "protection.overcurrent_pu=0.5")
)
"""The relay trips as soon as it is armed, before anything happens."""


@pytest.mark.parametrize("how", [CRASH, ABORT, NAN, TOO_LARGE, ERROR, UNDEFINED, EXIT])
def test_what_comes_after_a_trip_is_ignored(misbehaving, how):
    """It ends no run but is noted with its time; the plant's record is that of a library that does nothing wrong."""
    simulator = misbehaving(how)
    (segment,) = simulator(SCENARIO, TRIPPED)
    (note,) = simulator.notes
    assert note.startswith("ignored, as it came after a trip: ")
    assert WHEN in note
    (well,) = misbehaving(NOTHING)(SCENARIO, TRIPPED)
    assert segment["connected"].max() == 0
    assert all(np.array_equal(segment[name], well[name]) for name in PLANT_CHANNELS)


def test_endless_loop_is_stopped(misbehaving):
    """A call that does not return is stopped at the limit that is set, and told with the simulated time."""
    assert WHEN in stopped_in_its_loop(misbehaving(LOOP), SCENARIO, QUICK, WHEN)
    assert misbehaving(NOTHING)(SCENARIO, QUICK).end_s > 0.4


def test_no_run_sees_the_globals_of_another(misbehaving):
    """A counter that is a static variable of the library begins anew in every run."""
    simulator = misbehaving(NOTHING)
    first, second = (simulator(SCENARIO, QUICK).segments[0]["calls"] for _ in range(2))
    assert first[0] > 1
    assert first.tolist() == second.tolist()


def test_printing_reaches_nobody(misbehaving, capfd):
    """What a library prints stays out of the command's output; Model_PrintInfo is never called."""
    misbehaving(PRINT)(SCENARIO, QUICK)
    assert capfd.readouterr() == ("", "")


def test_messages_are_shown_once(misbehaving):
    """Return value 1 is no error: what the library says is kept, once, and the run goes on."""
    simulator = misbehaving(MESSAGE)
    for _ in range(2):
        assert simulator(SCENARIO, QUICK).end_s > 0.4
    assert simulator.notes == ["the limiter is active"]
    assert "the limiter is active" in simulator.provenance(QUICK)["controller_notes"]


@pytest.mark.parametrize("name", ["GetInfo", "Initialize", "Outputs", "Terminate"])
def test_missing_function_is_named(compiled, name):
    """A library without a function that the interface demands is refused."""
    with pytest.raises(UsageError, match=f"has no function Model_{name}"):
        ForeignSimulator(str(compiled("misbehaving.c", f"Model_{name}=Another_{name}")))


def test_rms_model_is_refused(compiled):
    """A model of RMS values cannot be run on instantaneous values."""
    with pytest.raises(UsageError, match="for RMS simulation only"):
        ForeignSimulator(str(compiled("misbehaving.c", "RMS_ONLY")))


def test_parameter_out_of_range_is_refused(compiled):
    """The host checks the range before the library sees the value."""
    with pytest.raises(UsageError, match=r"--set controller\.how: 11 is out of range; 0 to 10 is allowed"):
        ForeignSimulator(str(compiled("misbehaving.c")), {"how": 11})


def test_parameters_that_do_not_fit_each_other(bundled_in_c):
    """What Model_CheckParameters refuses is told in its own words."""
    simulator = ForeignSimulator(str(bundled_in_c), {"mppt_voltage_min_v": 900.0, "mppt_voltage_max_v": 800.0})
    with pytest.raises(SimulationError, match="mppt_voltage_min_v must be below mppt_voltage_max_v"):
        simulator(SCENARIO, QUICK)


def elf(bits, machine):
    """Beginning of an ELF file."""
    return b"\x7fELF" + bytes([bits // 32, 1, 1]) + bytes(9) + struct.pack("<HH", 3, machine) + bytes(44)


@linux_only
@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"MZ" + bytes(58) + struct.pack("<I", 64) + b"PE\0\0" + struct.pack("<H", 0x8664), "is a library of Windows"),
        (b"\xcf\xfa\xed\xfe" + struct.pack("<I", 0x0100000C) + bytes(24), "is a library of macOS"),
        (elf(32, 3), "x86, 32 bits; this computer is"),
        (elf(64, 183 if platform.machine() == "x86_64" else 62), "; this computer is"),
        (b"#!/bin/sh\n", "is not a shared library"),
        (b"", "is not a shared library"),
        (elf(64, 62 if platform.machine() == "x86_64" else 183), "cannot be loaded"),
    ],
    ids=["windows", "macos", "32-bit", "another-machine", "script", "empty", "damaged"],
)
def test_foreign_files_are_refused(tmp_path, content, words):
    """A file that is no library of this system and machine is refused with what it is."""
    (tmp_path / "libctrl.dll").write_bytes(content)
    with pytest.raises(UsageError) as error:
        ForeignSimulator(str(tmp_path / "libctrl.dll"))
    assert words in str(error.value)


def test_no_file(tmp_path):
    """A library that is not there is named."""
    with pytest.raises(UsageError, match="there is no file"):
        ForeignSimulator(str(tmp_path / "libnone.so"))


def test_library_may_be_replaced_while_it_runs(compiled, tmp_path):
    """A copy is loaded, so the file is free; but no run is made with another controller than the one described."""
    library = tmp_path / "libctrl.so"
    shutil.copy(compiled("misbehaving.c"), library)
    simulator = ForeignSimulator(str(library))
    library.write_bytes(library.read_bytes())
    assert simulator(SCENARIO, QUICK).end_s > 0.4
    library.write_bytes(library.read_bytes() + b"another build")
    with pytest.raises(SimulationError, match="has changed since the first test"):
        simulator(SCENARIO, QUICK)
