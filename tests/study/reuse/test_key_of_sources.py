"""Of the key of a record: the sources, and what runs them; edited, it is simulated anew."""

import ast
import shutil
from pathlib import Path

import llvmlite.binding
import pytest

import pvlvrt_compliance
from pvlvrt_compliance.study.sources import ROOMS, of_records

PACKAGE = Path(pvlvrt_compliance.__file__).parent

NAME = pvlvrt_compliance.__name__


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
