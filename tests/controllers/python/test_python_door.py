"""A class in Python as a controller: what it must have, what it can be given, what is said of its mistakes."""

import hashlib
import shutil
from pathlib import Path

import pytest

from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.python.door import PythonDoor
from pvlvrt_compliance.controllers.simulator import ForeignSimulator
from pvlvrt_compliance.errors import SimulationError, UsageError
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import parameters_from

SMALL = Path(__file__).parents[1] / "small.py"

SCENARIO = Scenario(sag=Sag(depth=0.0), duration_s=0.1, after_s=0.1)
QUICK = parameters_from(("simulation.settling_s=0.2",))


def test_exception_comes_with_the_line(opened):
    """The author finds the line that has failed."""
    with pytest.raises(SimulationError, match=r"KeyError: 'gain'\n .*misbehaving.py, line \d+, in s"):
        opened("misbehaving.py:Controller", deed="raise")(SCENARIO, QUICK)


FILES = {
    "no_class.py": "class Other: pass\n",
    "no_time.py": "class C:\n    def reset(self, n): pass\n    def step(self, y): return (0, 0, 0)\n",
    "bad_time.py": "class C:\n    sample_time_s = 'fast'\n    def reset(self, n): pass\n    def step(self, y): pass\n",
    "no_step.py": "class C:\n    sample_time_s = 1e-4\n    def reset(self, n): pass\n",
    "broken.py": "import nothing_of_that_name\n",
    "leaves.py": "import os\nprint('going')\nos._exit(4)\n",
    "crashes.py": "import ctypes\nctypes.string_at(0)\n",
    "strict.py": "class C:\n    sample_time_s = 1e-4\n    def __init__(self, gain): pass\n",
}


@pytest.mark.parametrize(
    ("spec", "words"),
    [
        ("absent.py:C", "there is no file"),
        ("no_class.py:Othr", "has no class 'Othr'; did you mean \"Other\"?"),
        ("no_class.py", "name the class, too: "),
        ("no_time.py:C", "C has no attribute sample_time_s"),
        ("bad_time.py:C", "C.sample_time_s is 'fast'; it must be a number of seconds above zero"),
        ("no_step.py:C", "C has no method step()"),
        ("broken.py:C", "No module named 'nothing_of_that_name'\n  broken.py, line 1"),
        ("leaves.py:C", "the controller ended the process (status 4)\nit had printed: going"),
        ("crashes.py:C", "the controller crashed (SIGSEGV)"),
        ("strict.py:C", "missing 1 required positional argument: 'gain'"),
        ("what.ever", "not a kind of controller that is known"),
    ],
)
def test_what_cannot_be_opened_is_refused(tmp_path, monkeypatch, spec, words):
    """Before anything runs, with the reason."""
    for name, text in FILES.items():
        (tmp_path / name).write_text(text)
    monkeypatch.chdir(tmp_path)
    with pytest.raises(UsageError) as error:
        ForeignSimulator(spec)
    assert str(error.value).startswith(f"--controller {spec}: ")
    assert words in str(error.value)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"ded": "raise"}, '"deed"?; it has sample_time_s, deed, at_s, say'),
        ({"at_s": "soon"}, "--set controller.at_s: 'soon' is not a number"),
        ({"say": 1}, "--set controller.say: 1 is not true or false"),
    ],
)
def test_parameters_are_checked_by_their_defaults(opened, given, words):
    """A name or a value that does not fit is refused with those that do."""
    with pytest.raises(UsageError) as error:
        opened("misbehaving.py:Controller", **given)
    assert words in str(error.value)


def test_parameters_without_a_constructor_are_attributes(tmp_path):
    """A class without keywords of its own has its public attributes for parameters."""
    (tmp_path / "c.py").write_text(
        "class C:\n    sample_time_s = 1e-4\n    gain = 2\n    def reset(self, n): pass\n    def step(self, y): pass\n"
    )
    simulator = ForeignSimulator(f"{tmp_path / 'c.py'}:C", {"sample_time_s": 2e-4})
    assert simulator.description.sample_time_s == 2e-4
    assert [p.name for p in simulator.description.parameters] == ["gain", "sample_time_s"]


@pytest.mark.parametrize(
    ("names", "words"),
    [
        ("{'a b': 1.0}", "signals(): 'a b' is not a name for a channel; write letters, digits and _"),
        ("{1: 1.0}", "signals(): 1 is not a name for a channel"),
        ("{'u_a_v': 1.0}", "signals(): the record has a channel 'u_a_v' already"),
        ("{'t_s': 1.0}", "signals(): the record has a channel 't_s' already"),
        ("{f's{k}': 0.0 for k in range(201)}", "signals(): 201 are too many; 200 can be recorded"),
    ],
)
def test_names_of_signals_that_cannot_be_recorded(tmp_path, names, words):
    """What a controller says of itself is recorded beside the plant, under a name that nothing else has."""
    text = "class C:\n    sample_time_s = 1e-4\n    def reset(self, n): pass\n    def step(self, y): return 0, 0, 0\n"
    (tmp_path / "c.py").write_text(f"{text}    def signals(self): return {names}\n")
    with pytest.raises(SimulationError) as error:
        ForeignSimulator(f"{tmp_path / 'c.py'}:C")(SCENARIO, QUICK)
    assert words in str(error.value)


def test_a_mapping_can_only_list_files(tmp_path):
    """One that lies beside the class and ties ports is of something else of its name, and not used."""
    shutil.copy(SMALL, tmp_path / "mine.py")
    mapping = tmp_path / "mine.mapping.toml"
    door = PythonDoor(f"{tmp_path / 'mine.py'}:Small", {})
    assert door.describe().mapping is None
    mapping.write_text("[inputs]\nVdc = 'v_dc_v'\n")
    assert PythonDoor(f"{tmp_path / 'mine.py'}:Small", {}).describe().mapping is None
    with pytest.raises(DoorError, match="--mapping does not go with it, but for one that only lists files"):
        PythonDoor(f"{tmp_path / 'mine.py'}:Small", {}, str(mapping))
    mapping.write_text("files = ['mine.py']\n")
    assert PythonDoor(f"{tmp_path / 'mine.py'}:Small", {}).describe().mapping == str(mapping)
    assert PythonDoor(f"{tmp_path / 'mine.py'}:Small", {}, str(mapping)).describe().mapping == str(mapping)


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A package in the working folder, of a class that takes its gain by a relative import."""
    folder = tmp_path / "a_vendors_package" / "control"
    folder.mkdir(parents=True)
    for place in (folder.parent, folder):
        (place / "__init__.py").write_text("")
    (folder.parent / "gains.py").write_text("GAIN = 1.0\n")
    text = SMALL.read_text().replace("gain=1.0", "gain=GAIN")
    (folder / "holding.py").write_text(f"from ..gains import GAIN\n\n{text}")
    monkeypatch.chdir(tmp_path)
    return folder


@pytest.mark.parametrize(
    "spec", ["a_vendors_package.control.holding:Small", "a_vendors_package/control/holding.py:Small"]
)
def test_a_module_and_a_file_of_a_package_with_relative_imports(package, spec):
    """Either is imported as part of its package, and runs; digest and name are those of the file that it lies in."""
    controller = ForeignSimulator(spec)
    assert controller.description.name == "Small"
    by_file = hashlib.sha256((package / "holding.py").read_bytes()).hexdigest()
    assert controller.description.digest == by_file
    assert controller(SCENARIO, QUICK).end_s == pytest.approx(SCENARIO.end_s, abs=1e-3)


def test_an_installed_module():
    """What Python finds by its name is taken as it is; a class that is no controller is told what it lacks."""
    with pytest.raises(UsageError, match=r"wave:Error: Error has no attribute sample_time_s"):
        ForeignSimulator("wave:Error")


@pytest.mark.parametrize(
    ("spec", "words"),
    [
        ("a_vendors_package.controls.holding:Small", "there is no module a_vendors_package.controls, installed or in"),
        ("no_such_module_at_all:Small", "there is no module no_such_module_at_all, installed or in "),
        ("a_vendors_package.control.holding:Smal", "has no class 'Smal'; did you mean \"Small\"?"),
        ("math:Small", "math is no module that is written in Python"),
        ("a_vendors_package.broken:Small", "a_vendors_package.broken cannot be imported: RuntimeError: not today"),
    ],
)
def test_modules_that_cannot_be_used(package, spec, words):
    """Each mistake is told with what was looked for."""
    (package.parent / "broken.py").write_text("raise RuntimeError('not today')\n")
    with pytest.raises(UsageError) as error:
        ForeignSimulator(spec)
    assert words in str(error.value)
