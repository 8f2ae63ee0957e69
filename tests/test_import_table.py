"""Who may import whom: the table of the design, checked on the source of every module."""

import ast
import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

import pvlvrt_compliance

PACKAGE = Path(pvlvrt_compliance.__file__).parent
NAME = pvlvrt_compliance.__name__

COMMON = {"errors", "units", "space_vectors", "resources", "texts"}
KERNELS = {"kernel", "vectors", "sogi"}
# By folder, or module at the root: what of the package it may import besides itself. "*" is everything.
ALLOWED = {
    "__init__": set(),
    "errors": set(),
    "units": {"errors"},
    "space_vectors": set(),
    "resources": {"errors"},
    "processes": set(),
    "locks": set(),
    "texts": set(),
    "compiled": {"errors", "texts"},
    "kernel": {"compiled"},
    "controllers": {"units"},  # what a user's own file imports
    "vectors": {"kernel", "space_vectors"},
    "sogi": {"kernel", "vectors"},
    "waveforms": COMMON,
    "data": {"errors", "resources"},  # what every file that people write shares
    "scenario": COMMON | {"data"},
    "profile": COMMON | {"data", "scenario"},
    "measure": COMMON | {"waveforms"},
    # What the grid did is made from a scenario or from a record; its plain data is read with a result.
    "disturbance": COMMON | {"measure", "scenario", "waveforms"},
    "evidence": COMMON | {"disturbance", "measure", "profile", "waveforms"},
    "results": {"errors", "texts", "measure.quantities", "disturbance.model"},
    "checks": COMMON | {"data", "disturbance", "evidence", "measure", "profile", "results", "waveforms"},
    "control": COMMON | KERNELS,
    "plant": COMMON | KERNELS,
    "simulation": COMMON
    | KERNELS
    | {"compiled", "processes", "locks", "data", "controllers", "plant", "control", "scenario", "waveforms"},
    # The kernel's digest is part of the provenance of a run.
    "study": COMMON | {"kernel", "locks", "profile", "scenario", "simulation", "checks", "results", "waveforms"},
    "report": COMMON | {"data", "disturbance", "results", "waveforms", "profile", "measure"},
    "cli": {"*"},
    "templates": set(),  # projects of users, which stand alone
}
NUMBA = {"compiled", "kernel", "plant", "control", "simulation"}


def modules() -> list[Path]:
    """Every module of the package."""
    return sorted(PACKAGE.rglob("*.py"))


def part_of(path: Path) -> str:
    """Folder of a module, or its own name at the root."""
    parts = path.relative_to(PACKAGE).with_suffix("").parts
    return parts[0]


def imported(path: Path) -> set[str]:
    """Dotted names of all modules that a file imports anywhere, in functions too."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path.name}: relative import"
            names.add(node.module or "")
            names |= {f"{node.module}.{alias.name}" for alias in node.names if is_module(f"{node.module}.{alias.name}")}
    return names


def is_module(name: str) -> bool:
    """Whether a dotted name of this package is a module rather than something in one."""
    if not name.startswith(NAME + "."):
        return False
    path = PACKAGE.joinpath(*name.split(".")[1:])
    return path.is_dir() or path.with_suffix(".py").is_file()


def own(names: set[str]) -> set[str]:
    """Names within the package, without the package's own."""
    return {name.removeprefix(NAME + ".") for name in names if name.startswith(NAME + ".")}


@pytest.mark.parametrize("path", modules(), ids=lambda path: path.relative_to(PACKAGE).as_posix())
def test_a_module_imports_only_what_its_folder_may(path):
    """Imports follow the table; whoever needs more changes the table first."""
    part = part_of(path)
    assert part in ALLOWED, f"{part} is missing from the table"
    allowed = ALLOWED[part] | {part}
    for name in own(imported(path)):
        # An entry with a dot allows that module only, not its folder.
        entries = {name.split(".")[0], ".".join(name.split(".")[:2])}
        package_of_an_entry = name in {entry.split(".")[0] for entry in allowed}
        assert "*" in allowed or entries & allowed or package_of_an_entry, f"{part} must not import {name}"


@pytest.mark.parametrize("path", modules(), ids=lambda path: path.relative_to(PACKAGE).as_posix())
def test_numba_stays_with_the_kernels(path):
    """Only compiled code knows numba, so that reading a profile or a record never pays for it."""
    if part_of(path) not in NUMBA:
        assert not {name for name in imported(path) if name.split(".")[0] == "numba"}


def test_one_room_reads_toml():
    """Files that people write are read by data/ alone, so that all of them are read with the same care."""
    readers = {part_of(path) for path in modules() if "tomllib" in imported(path)}
    assert readers == {"data"}


def test_checks_never_see_the_simulator():
    """What is judged is a record, simulated or recorded: no check reaches simulation, plant or control."""
    for folder in ("checks", "disturbance", "evidence", "measure", "profile", "results", "waveforms", "report"):
        for path in (PACKAGE / folder).rglob("*.py"):
            assert not {name.split(".")[0] for name in own(imported(path))} & {"simulation", "plant", "control"}, path


def test_no_check_sees_a_scenario():
    """What the grid did reaches checks as a disturbance, made from a scenario or found in a record."""
    for path in (PACKAGE / "checks").rglob("*.py"):
        assert not {name.split(".")[0] for name in own(imported(path))} & {"scenario", "simulation"}, path
        names = {node.id for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Name)}
        assert "Scenario" not in names, path


def test_reading_results_stays_light():
    """Whoever reads a result of a run needs neither numpy nor a simulator."""
    code = f"import sys, {NAME}.results; print(*sorted(m.split('.')[0] for m in sys.modules))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not {"numpy", "numba", "scipy", "plotly"} & set(run.stdout.split())


@pytest.mark.parametrize("part", sorted(ALLOWED))
def test_the_table_allows_nothing_that_nobody_needs(part):
    """A part that stops using another gives up the right to, so that the table says how the rooms lie."""
    used = {name for path in modules() if part_of(path) == part for name in own(imported(path))}
    heads = {".".join(name.split(".")[:depth]) for name in used for depth in (1, 2)}
    everyone_may = COMMON | (KERNELS if part in NUMBA else set()) | {"*"}
    assert not ALLOWED[part] - everyone_may - heads


def test_the_table_has_no_entry_for_what_is_gone():
    """Each name of the table is a part of the package."""
    parts = {part_of(path) for path in modules()}
    assert set(ALLOWED) <= parts


@pytest.mark.skipif(importlib.util.find_spec(f"{NAME}.cli.main") is None, reason="there is no command line yet")
def test_the_command_line_starts_light():
    """The application is there for --help before numba, scipy or plotly are imported."""
    code = f"import sys, {NAME}.cli.main; print(*sorted(m.split('.')[0] for m in sys.modules))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not {"numba", "scipy", "plotly", "pandas"} & set(run.stdout.split())
