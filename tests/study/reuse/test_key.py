"""Everything that decides a record is part of its key: edited, it is simulated anew."""

import ast
import json
import shutil
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import llvmlite.binding
import numpy as np
import pytest

import pvlvrt_compliance
from pvlvrt_compliance.controllers.description import Description
from pvlvrt_compliance.controllers.run import IGNORED_WORDS
from pvlvrt_compliance.errors import SimulationError, UsageError
from pvlvrt_compliance.scenario.events import PhaseJump, Recording
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters, parameter_names, parameters_from
from pvlvrt_compliance.study.reuse.key import key_of, surroundings_digest
from pvlvrt_compliance.study.reuse.simulator import ReusingSimulator
from pvlvrt_compliance.study.sources import ROOMS, of_records
from pvlvrt_compliance.waveforms import Segment, Waveforms
from pvlvrt_compliance.waveforms.comtrade import write_comtrade

PACKAGE = Path(pvlvrt_compliance.__file__).parent
NAME = pvlvrt_compliance.__name__
SCENARIO = Scenario(sag=Sag(depth=0.5), duration_s=0.2)
DEFAULTS = Parameters()
RECORD = Waveforms((Segment(0.0, 1e-3, {"x": np.arange(4.0)}),))

OTHER_SCENARIO: dict[str, Any] = {
    "sag": Sag(depth=0.5, phases="c"),
    "duration_s": 0.25,
    "point_on_wave_deg": 1e-9,
    "frequency_hz": 50.1,
    "irradiance_w_m2": 999.0,
    "cell_temperature_c": 26.0,
    "scr": 10.0,
    "xr": 9.0,
    "vector_group": "Dyn11",
    "reactive_power_pu": 0.1,
    "before_s": 0.31,
    "after_s": 1.2,
    "events": (PhaseJump(t_s=0.1, angle_deg=10.0),),
}

OTHER_WORDS = {
    "controller.precision": "single",
    "protection.undervoltage_curve": [[0, 0], [0.05, 0], [0.4, 0.85]],
}
"""Values of parameters that are no numbers, where the type does not say which there are."""


@dataclass
class Controller:
    """What the key is told of a user's own controller, without one."""

    description: Description = field(
        default_factory=lambda: Description("ieee-cigre", "mine 1.0", "d" * 64, 1e-4, parameters=())
    )
    spec: str = "libctrl.so"
    given: dict[str, Any] = field(default_factory=lambda: {"gain": 1.0})
    said: tuple[str, ...] = ()

    def mapping(self):
        """Its mapping file."""
        return self.description.mapping

    def parameter_values(self):
        """Its parameters."""
        return {"gain": 1.0, "limit": 2.0} | self.given

    @property
    def last_notes(self):
        """What it has said in the last run."""
        return self.said

    def note(self, said):
        """Hear what it said in an earlier run."""
        self.heard = tuple(said)


@pytest.fixture
def simulated(store):
    """How many simulations a run needs: ``simulated(scenario, parameters, controller) -> 0 or 1``."""

    def simulated(scenario=SCENARIO, parameters=DEFAULTS, controller=None, during=lambda: None):
        calls = []
        surroundings_digest.cache_clear()  # another process

        def simulate(*of):
            calls.append(of)
            during()
            return RECORD

        found = ReusingSimulator(simulate, controller, store)(scenario, parameters)
        assert [x.tolist() for x in found.segments[0].channels.values()] == [[0.0, 1.0, 2.0, 3.0]]
        return len(calls)

    return simulated


def test_what_has_not_changed_is_simulated_once(simulated):
    """The next run takes what the first one has stored."""
    assert (simulated(), simulated(), simulated()) == (1, 0, 0)


@pytest.mark.parametrize("name", Scenario.model_fields)
def test_every_field_of_a_scenario_counts(name):
    """There is another value for each of them here, so that none can be added unnoticed."""
    other = Scenario(**{**{n: getattr(SCENARIO, n) for n in SCENARIO.model_fields_set}, name: OTHER_SCENARIO[name]})
    assert key_of(other, DEFAULTS, None, None) != key_of(SCENARIO, DEFAULTS, None, None)


def test_another_scenario_and_other_parameters_are_simulated(simulated):
    """Each is stored beside the others."""
    longer, weaker = (
        SCENARIO.model_copy(update={"duration_s": 0.3}),
        parameters_from(["controller.pr_integral_gain=0.2"]),
    )
    asked = [{}, {"scenario": longer}, {"parameters": weaker}]
    assert [simulated(**each) for each in (*asked, *asked)] == [1, 1, 1, 0, 0, 0]


def others_of(name, value):
    """Values that a parameter may have instead, those of its type first."""
    group, _, key = name.partition(".")
    annotation = str(type(getattr(DEFAULTS, group)).model_fields[key].annotation)
    words = [word.strip("' \"") for word in annotation.partition("Literal[")[2].partition("]")[0].split(",")]
    numbers = (
        [] if isinstance(value, bool) or not isinstance(value, int | float) else [value + 1, 1.01 * value, value / 2]
    )
    flags = [not value] if isinstance(value, bool) or "bool" in annotation else []
    return [*flags, *numbers, *filter(None, words), OTHER_WORDS.get(name), [1.0, 1.1, 1.0], 0.5, 5.0]


def with_another(name):
    """Parameters of which one has another value."""
    group, _, key = name.partition(".")
    for other in others_of(name, getattr(getattr(DEFAULTS, group), key)):
        try:
            found = parameters_from([f"{name}={json.dumps(other)}"])
        except UsageError:
            continue
        if found != DEFAULTS:
            return found
    raise AssertionError(f"{name}: no other value is known here")


@pytest.mark.parametrize("name", parameter_names())
def test_every_parameter_counts(name):
    """Those of plant, controller, hardware, protection and simulation."""
    assert key_of(SCENARIO, with_another(name), None, None) != key_of(SCENARIO, DEFAULTS, None, None)


def test_a_parameter_that_is_given_counts_even_at_its_default(simulated):
    """A controller from outside settles for another time unless it is set."""
    given = parameters_from([f"simulation.settling_s={DEFAULTS.simulation.settling_s}"])
    assert given == DEFAULTS
    assert (simulated(), simulated(parameters=given)) == (1, 1)


def csv_recording(folder):
    """A scenario with a recording in CSV, and the file that decides it."""
    (folder / "grid.csv").write_text("t_s,u_a_v,u_b_v,u_c_v\n0,1,2,3\n1,1,2,3\n")
    return folder / "grid.csv", folder / "grid.csv"


def comtrade_recording(folder):
    """The same of COMTRADE, whose samples are in a file beside it."""
    channels = {f"u_{phase}_v": np.arange(4.0) for phase in "abc"}
    waveforms = Waveforms((Segment(0.0, 1e-3, channels),))
    write_comtrade(waveforms, folder / "grid", station="s", device="d", frequency_hz=50.0, start=None)
    return folder / "grid.cfg", folder / "grid.dat"


@pytest.mark.parametrize("recording", [csv_recording, comtrade_recording])
def test_what_is_in_a_recording_counts(simulated, tmp_path, recording):
    """Not its time and place: the same file, written anew, is the same recording."""
    named, deciding = recording(tmp_path)
    scenario = SCENARIO.model_copy(update={"events": (Recording(file=str(named), t_s=0.1),)})
    assert (simulated(scenario), simulated(scenario)) == (1, 0)
    content = deciding.read_bytes()
    deciding.write_bytes(content)
    moved = shutil.copytree(tmp_path, tmp_path / "elsewhere")
    assert simulated(SCENARIO.model_copy(update={"events": (Recording(file=str(moved / named.name), t_s=0.1),)})) == 0
    assert simulated(SCENARIO.model_copy(update={"events": (Recording(file=str(named), t_s=0.2),)})) == 1
    deciding.write_bytes(content[:-2] + bytes([content[-2] ^ 1]) + content[-1:])
    assert (simulated(scenario), simulated(scenario)) == (1, 0)


@pytest.fixture
def own(tmp_path):
    """A controller of the user's own, with a mapping that lists files."""
    (tmp_path / "lib").mkdir()
    for name in ("gains.csv", "lib/a.py", "lib/b.py"):
        (tmp_path / name).write_text("1")
    mapping = tmp_path / "ctrl.mapping.toml"
    mapping.write_text('files = ["gains.csv", "lib/*.py"]\n')
    controller = Controller()
    return replace(controller, description=replace(controller.description, mapping=str(mapping)))


def edited(**changes):
    """Change something that the controller says of itself."""
    return lambda own, _: replace(own, description=replace(own.description, **changes))


def written(name, text):
    """Write a file beside the mapping."""

    def write(own, folder):
        (folder / name).write_text(text)
        return own

    return write


OF_THE_CONTROLLER = {
    "its file": edited(digest="e" * 64),
    "its kind": edited(kind="fmi2"),
    "its name": edited(name="mine 1.1"),
    "its sample time": edited(sample_time_s=2e-4),
    "its specification": lambda own, _: replace(own, spec="my.py:Other"),
    "its parameters": lambda own, _: replace(own, given={"gain": 1.5}),
    "a parameter that is given as it is": lambda own, _: replace(own, given={"gain": 1.0, "limit": 2.0}),
    "its mapping": written("ctrl.mapping.toml", 'files = ["gains.csv", "lib/*.py"]\n# edited'),
    "no mapping": edited(mapping=None),
    "a file that the mapping lists": written("gains.csv", "2"),
    "a file of a pattern": written("lib/b.py", "2"),
    "a file that a pattern finds besides": written("lib/c.py", "1"),
    "the bundled one": lambda *_: None,
}


@pytest.mark.parametrize("what", OF_THE_CONTROLLER)
def test_what_a_controller_is_made_of_counts(simulated, own, tmp_path, what):
    """Its file, its parameters, its mapping and what that lists."""
    assert (simulated(controller=own), simulated(controller=own)) == (1, 0)
    other = OF_THE_CONTROLLER[what](own, tmp_path)
    assert (simulated(controller=other), simulated(controller=other)) == (1, 0)


def test_what_nothing_lists_does_not_count(simulated, own, tmp_path):
    """A file that happens to lie beside it is none of the controller's."""
    assert simulated(controller=own) == 1
    (tmp_path / "notes.txt").write_text("x")
    assert simulated(controller=own) == 0


@pytest.fixture(scope="module")
def copied(tmp_path_factory):
    """A copy of the package's sources, that a test may edit."""
    copy = tmp_path_factory.mktemp("sources") / NAME
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__", "checks", "report", "cli", "api"))
    return copy


SOURCES = (
    *("control/current_regulator.py", "plant/grid.py", "hardware/sensors.py", "simulation/loop.py", "kernel.py"),
    *("simulation/door/call.py", "controllers/library/door.py", "controllers/run.py", "scenario/timeline.py"),
    *("waveforms/recording.py", "space_vectors.py", "units.py", "compiled/sources.py", "data/reader.py"),
)


@pytest.mark.parametrize("file", SOURCES)
def test_every_source_counts(simulated, copied, monkeypatch, file):
    """Kernels and plain Python, of the doors, too: a comment is enough."""
    monkeypatch.setattr(pvlvrt_compliance, "__file__", str(copied / "__init__.py"))
    assert (simulated(), simulated()) == (1, 0)
    with (copied / file).open("a") as source:
        source.write("\n# edited")
    assert (simulated(), simulated()) == (1, 0)


@pytest.mark.parametrize(
    "file", ["study/session.py", "results/verdict.py", "profile/profile.py", "disturbance/model.py"]
)
def test_what_only_judges_does_not_count(simulated, copied, monkeypatch, file):
    """A record that is judged in another way is the same record."""
    monkeypatch.setattr(pvlvrt_compliance, "__file__", str(copied / "__init__.py"))
    simulated()
    with (copied / file).open("a") as source:
        source.write("\n# edited")
    assert simulated() == 0


def imports_of(module):
    """Modules of the package that one of them imports, in functions, too, with the packages that these are in."""
    file = PACKAGE.parent.joinpath(*module.split("."))
    file = file / "__init__.py" if file.is_dir() else file.with_suffix(".py")
    names = set()
    for node in ast.walk(ast.parse(file.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    return {name for name in names if name.startswith(f"{NAME}.") and is_module(name)}


def is_module(name):
    """Whether there is a file of it."""
    place = PACKAGE.parent.joinpath(*name.split("."))
    return place.with_suffix(".py").is_file() or (place / "__init__.py").is_file()


def test_all_that_a_simulation_imports_is_among_the_sources():
    """Found from the simulator, the process of a controller and every door, whatever the table of rooms says."""
    doors = [f"{NAME}.controllers.{folder.parent.name}.door" for folder in PACKAGE.glob("controllers/*/door.py")]
    met, ends = set(), [f"{NAME}.{name}" for name in ("simulation.simulate", "controllers.simulator")]
    ends += [f"{NAME}.controllers.{name}" for name in ("here", "process.worker")] + doors
    while ends:
        end = ends.pop()
        if end not in met:
            met.add(end)
            ends += imports_of(end)
    counted = {file.removesuffix(".py").removesuffix("/__init__").replace("/", ".") for file in of_records()}
    assert len(doors) >= 4
    assert {name.removeprefix(f"{NAME}.") for name in met} <= counted
    assert {name.partition(".")[0] for name in counted if "." in name} == set(ROOMS) - {""}


OF_THE_MACHINE = {
    "version of the package": ("pvlvrt_compliance.__version__", "0.0.0"),
    "version of Python": ("platform.python_version", lambda: "3.99.0"),
    "version of numpy": ("numpy.__version__", "0.0"),
    "version of numba": ("pvlvrt_compliance.compiled.sources.numbas_release", lambda: "0.0"),
    "version of llvmlite": ("llvmlite.__version__", "0.0"),
    "other libraries": ("pvlvrt_compliance.study.reuse.key.version", lambda _: "0.0"),
    "version of the system's libraries": ("platform.libc_ver", lambda: ("glibc", "9.99")),
    "processor": ("llvmlite.binding.get_host_cpu_name", lambda: "other"),
    "its features": (
        "llvmlite.binding.get_host_cpu_features",
        llvmlite.binding.FeatureMap,
    ),
}


@pytest.mark.parametrize("what", OF_THE_MACHINE)
def test_what_runs_it_counts(simulated, monkeypatch, what):
    """Versions, and the processor: a folder may be carried to another machine."""
    assert (simulated(), simulated()) == (1, 0)
    name, other = OF_THE_MACHINE[what]
    monkeypatch.setattr(name, other)
    assert (simulated(), simulated()) == (1, 0)


def test_how_the_compiler_compiles_counts(simulated, monkeypatch, tmp_path):
    """Where it keeps what it has compiled does not."""
    assert simulated() == 1
    monkeypatch.setenv("NUMBA_CACHE_DIR", "elsewhere")
    assert simulated() == 0
    monkeypatch.setenv("NUMBA_OPT", "1")
    assert (simulated(), simulated()) == (1, 0)
    monkeypatch.chdir(tmp_path)
    (tmp_path / ".numba_config.yaml").write_text("opt: 2")
    assert simulated() == 1


def test_what_fails_is_not_stored(store):
    """It is simulated, and fails, each time."""
    calls = []

    def simulate(*of):
        calls.append(of)
        raise SimulationError("a number stopped being finite")

    for _ in range(2):
        with pytest.raises(SimulationError):
            ReusingSimulator(simulate, None, store)(SCENARIO, DEFAULTS)
    assert (len(calls), store.folder.exists()) == (2, False)


def test_what_time_may_have_decided_is_not_stored(simulated, own):
    """After a trip a controller may be left alone because it did not come back."""
    own.said = (f"{IGNORED_WORDS}: no answer within 60 s",)
    assert (simulated(controller=own), simulated(controller=own)) == (1, 1)


def test_what_a_controller_said_comes_with_its_record(simulated, own):
    """Its notes are those of the run that is not made again."""
    own.said = ("the gain was limited",)
    assert simulated(controller=own) == 1
    own.said = ()
    assert simulated(controller=own) == 0
    assert own.heard == ("the gain was limited",)


def test_a_record_is_not_stored_where_something_changed_meanwhile(simulated, own, tmp_path):
    """It is of neither the old files nor the new ones."""
    change = iter("23")
    during = lambda: (tmp_path / "gains.csv").write_text(next(change))  # noqa: E731
    assert simulated(controller=own, during=during) == 1
    assert simulated(controller=own) == 1
    (tmp_path / "gains.csv").write_text("1")
    assert simulated(controller=own) == 1


def test_a_mapping_that_breaks_meanwhile_ends_no_run(simulated, own):
    """The record is given, and not stored; whoever opens the controller next is told."""
    broken = lambda: Path(own.mapping()).write_text("files = 1")  # noqa: E731
    assert simulated(controller=own, during=broken) == 1
    Path(own.mapping()).write_text('files = ["gains.csv", "lib/*.py"]\n')
    assert simulated(controller=own) == 1
