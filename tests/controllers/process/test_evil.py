"""Controllers that do harm cost their own test, within their limits; no process and no file of theirs is left."""

import os
import shutil
from contextlib import suppress
from pathlib import Path

import pytest

from evil import EVIL, LOW
from pvlvrt_compliance.controllers.process import family, isolation
from pvlvrt_compliance.controllers.simulator import ForeignSimulator
from pvlvrt_compliance.errors import SimulationError, UsageError
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import own_parameters, parameters_from
from waiting import wait_until

pytestmark = pytest.mark.skipif(not family.FORKS, reason="only Linux holds a controller to all of its limits")

DEEP = Scenario(sag=Sag(depth=0.6), duration_s=0.1, after_s=0.1)
SHALLOW = Scenario(sag=Sag(depth=0.1), duration_s=0.1, after_s=0.1)
LIMITS = parameters_from(LOW)


def cases(*doors):
    """Those of these doors; what needs gcc is marked so, and programs, which start an interpreter a run, as slow."""
    found = []
    for name, evil in EVIL.items():
        marks = [pytest.mark.compiler] * evil.needs_compiler + [pytest.mark.slow] * (evil.door == "program")
        if evil.door in doors:
            found.append(pytest.param(evil, id=name, marks=marks))
    return found


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Folder of the controller, where it runs, too; temporary files lie in one beside it."""
    (temporary := tmp_path / "tmp").mkdir()
    monkeypatch.setenv("TMPDIR", str(temporary))
    monkeypatch.setattr("tempfile.tempdir", None)
    (own := tmp_path / "own").mkdir()
    return own


def build(evil, folder):
    """Its specification."""
    if evil.needs_compiler and shutil.which("gcc") is None:
        pytest.skip("gcc is missing")
    return evil.build(folder)


def at_work_in(folder):
    """Processes whose working folder it is."""
    found = []
    for process in Path("/proc").iterdir():
        with suppress(OSError):
            if process.name.isdecimal() and (process / "cwd").readlink() == folder:
                found.append(process.name)
    return found


def error_of(simulator, scenario, parameters):
    """Why a run has failed; nothing where it has not."""
    try:
        simulator(scenario, parameters)
    except SimulationError as error:
        return str(error)
    return ""


def nothing_is_left(folder):
    """No file of a run, no process in the controller's folder."""
    assert list((folder.parent / "tmp").iterdir()) == []
    wait_until(lambda: not at_work_in(folder), "the end of all that was started")


@pytest.mark.parametrize("evil", cases("python", "library", "program"))
def test_it_costs_its_own_run(evil, folder):
    """The run is an error that says why, or whole where nothing was done to it; the next one is well."""
    given, settings = own_parameters(evil.settings)
    parameters = parameters_from(settings)
    simulator = ForeignSimulator(build(evil, folder), given, beside=str(folder), parameters=LIMITS)
    before = {path.name for path in folder.iterdir()}
    said = error_of(simulator, DEEP, parameters)
    assert evil.expected in said
    assert len(said) < 10_000
    nothing_is_left(folder)
    assert simulator(SHALLOW, LIMITS).end_s > 0.4
    nothing_is_left(folder)
    assert {path.name for path in folder.iterdir()} <= {*before, "__pycache__"}


@pytest.mark.parametrize("evil", cases("fmu"))
def test_what_unpacks_to_no_good_is_refused(evil, folder):
    """Before anything of it is unpacked."""
    spec = build(evil, folder)
    with pytest.raises(UsageError) as error:
        ForeignSimulator(spec, beside=str(folder), parameters=LIMITS)
    assert evil.expected in str(error.value)
    nothing_is_left(folder)
    assert [path.name for path in folder.iterdir()] == ["evil.fmu"]


LIMITED = {
    "loops, python": "simulation.time_limit_s=2",
    "eats memory, python": "simulation.memory_limit_mb=400",
    "prints without end, python": "simulation.output_limit_mb=1",
    "writes a big file, python": "simulation.files_limit_mb=10",
    "writes many files, python": "simulation.files_limit=50",
    "starts processes, python": "simulation.processes_limit=10",
}


@pytest.mark.parametrize("name", LIMITED)
def test_each_limit_is_named(name, folder):
    """With its value, and how it is raised."""
    parameter, _, value = LIMITED[name].partition("=")
    others = [other for other in LOW if not other.startswith(f"{parameter}=")]
    simulator = ForeignSimulator(EVIL[name].build(folder), beside=str(folder))
    with pytest.raises(SimulationError) as error:
        simulator(DEEP, parameters_from((*others, LIMITED[name])))
    said = str(error.value)
    assert f"({parameter})" in said
    assert f" {value} " in said
    assert f"; --set {parameter}= allows more" in said


@pytest.mark.parametrize(
    ("text", "assignment", "words"),
    [
        ("while True: pass", "opening_limit_s=1", "was stopped after 1 s of computing (simulation.opening_limit_s)"),
        ("x = bytearray(b'x') * 800_000_000", "memory_limit_mb=400", "(simulation.memory_limit_mb)"),
        ("print('x' * 3_000_000)", "output_limit_mb=1", "printed more than 1 MB (simulation.output_limit_mb)"),
    ],
)
def test_limits_hold_while_it_is_opened(folder, text, assignment, words):
    """Its file is code that is run then."""
    (folder / "evil.py").write_text(text)
    with pytest.raises(UsageError) as error:
        ForeignSimulator(
            f"{folder / 'evil.py'}:C", beside=str(folder), parameters=parameters_from((f"simulation.{assignment}",))
        )
    assert words in str(error.value)
    assert f"--set simulation.{assignment.partition('=')[0]}= allows more" in str(error.value)
    nothing_is_left(folder)


def test_a_server_that_cannot_start_is_told(folder, monkeypatch):
    """It is no fault of a test that hangs."""
    isolation.stop_apart()
    monkeypatch.setattr("sys.path", [])
    with pytest.raises(isolation.LostServerError, match="did not start"):
        ForeignSimulator(EVIL["exits, python"].build(folder), beside=str(folder))


def test_a_server_that_was_stopped_between_two_runs(folder):
    """The next run sees it, and the one after that has another."""
    simulator = ForeignSimulator(EVIL["exits, python"].build(folder), beside=str(folder))
    os.kill(isolation._server._process.pid, family.signal.SIGSTOP)
    with pytest.raises(SimulationError, match=r"was stopped \(SIGSTOP\)"):
        simulator(SHALLOW, LIMITS)
    assert simulator(SHALLOW, LIMITS).end_s > 0.4
