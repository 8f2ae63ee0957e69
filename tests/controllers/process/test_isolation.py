"""A bad controller costs its own run and no more; what went wrong, and when, is told."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from pvlvrt_compliance.errors import SimulationError
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.columns import PLANT_CHANNELS
from pvlvrt_compliance.simulation.parameters import parameters_from
from waiting import PATIENCE_S, stopped_in_its_loop, wait_until

SCENARIO = Scenario(sag=Sag(depth=0.0), duration_s=0.1, after_s=0.1)
QUICK = parameters_from(("simulation.settling_s=0.2",))

WHEN = "0.1000 s"
"""Simulated time of a deed at 0.5 s of the controller's, 0.4 s before the record."""


@pytest.mark.parametrize(
    ("deed", "reason"),
    [
        ("raise", "the controller failed at"),
        ("nan", "a command of the controller is not a finite number at"),
        ("range", "a command of the controller is out of range at"),
        ("two", "step() must return three numbers, not (1.0, 2.0)"),
        ("none", "step() must return three numbers, not None"),
        ("words", "step() must return three numbers"),
        ("exit", "the controller ended the process (status 0) at"),
        ("sys.exit", "SystemExit: 3"),
        ("crash", "the controller crashed (SIGSEGV) at"),
        ("orphan", "the controller ended the process (status 5) at"),
    ],
)
def test_bad_deed_is_told_with_its_time(opened, deed, reason):
    """The message has the reason, the simulated time, and what the controller had printed; the next run is fine."""
    simulator = opened("misbehaving.py:Controller", deed=deed)
    with pytest.raises(SimulationError) as error:
        simulator(SCENARIO, QUICK)
    assert reason in str(error.value)
    assert WHEN in str(error.value)
    assert f"about to {deed}" in str(error.value)
    assert opened("misbehaving.py:Controller")(SCENARIO, QUICK).end_s > 0.4


TRIPPED = parameters_from(("simulation.settling_s=0.2", "protection.overcurrent_pu=0.5"))
"""The relay trips as soon as it is armed, before any deed."""


@pytest.mark.parametrize(
    "deed", ["raise", "nan", "range", "two", "none", "words", "exit", "sys.exit", "crash", "orphan"]
)
def test_bad_deed_after_a_trip_is_ignored(opened, deed):
    """No command counts after a trip, nor what comes in place of one: it is noted, and the plant's record is whole."""
    simulator = opened("misbehaving.py:Controller", deed=deed)
    (segment,) = simulator(SCENARIO, TRIPPED)
    (well,) = opened("misbehaving.py:Controller")(SCENARIO, TRIPPED)
    assert all(np.array_equal(segment[name], well[name]) for name in PLANT_CHANNELS)
    assert segment["connected"].max() == 0
    (note,) = [note for note in simulator.notes if note.startswith("ignored, as it came after a trip: ")]
    assert WHEN in note


def test_controller_that_is_well_is_called_after_a_trip(opened):
    """It sees that it is not connected any more, and what it has to say is recorded to the end."""
    (segment,) = opened("misbehaving.py:Controller")(SCENARIO, TRIPPED)
    assert segment["time_s"][-1] - segment["time_s"][0] == pytest.approx(segment.end_s - segment.t0_s, abs=3e-4)


def test_command_without_a_number_ends_no_calls_after_a_trip(opened):
    """Commands that are none are passed over one by one: further signals are recorded to the end."""
    (segment,) = opened("misbehaving.py:Controller", deed="nan")(SCENARIO, TRIPPED)
    assert segment["time_s"][-1] > 0.4
    assert np.isfinite(segment["m_alpha"]).all()


def test_bad_deed_before_a_trip_is_an_error(opened):
    """A plant that has relays, but has not tripped yet, ends the run as ever."""
    with pytest.raises(SimulationError, match="not a finite number"):
        opened("misbehaving.py:Controller", deed="nan", at_s=0.25)(SCENARIO, TRIPPED)


def test_endless_loop_is_stopped(opened):
    """A step that does not end is stopped at the limit that is set, and told with the simulated time."""
    error = stopped_in_its_loop(opened("misbehaving.py:Controller", deed="loop"), SCENARIO, QUICK, "about to loop")
    assert WHEN in error
    assert opened("misbehaving.py:Controller")(SCENARIO, QUICK).end_s > 0.4


def test_instances_never_share_globals(opened):
    """Every run begins with a module of its own."""
    for _ in range(2):
        (segment,) = opened("misbehaving.py:Controller")(SCENARIO, QUICK)
        assert set(segment["count"]) == {1.0}


def test_printing_reaches_nobody(opened, capfd):
    """What a controller prints stays out of the output of the command."""
    opened("misbehaving.py:Controller", say=True)(SCENARIO, QUICK)
    assert capfd.readouterr() == ("", "")


def test_nothing_is_left_behind(opened, tmp_path, monkeypatch):
    """Files of a run are gone after it, and so is the process that it ran in."""
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    opened("misbehaving.py:Controller")(SCENARIO, QUICK)
    assert list(tmp_path.iterdir()) == []


def test_server_ends_with_its_reader():
    """A process for controllers does not outlive the one that started it, not even in an endless loop."""
    code = (
        "import os\n"
        "from pvlvrt_compliance.controllers.process import isolation\n"
        "from pvlvrt_compliance.controllers.simulator import ForeignSimulator\n"
        f"ForeignSimulator({str(Path(__file__).parents[1] / 'misbehaving.py:Controller')!r})\n"
        "print(isolation._server._process.pid, flush=True)\n"
        "os._exit(0)\n"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=PATIENCE_S, check=True)
    pid = int(run.stdout)
    wait_until(lambda: not Path(f"/proc/{pid}").exists(), "its end")
