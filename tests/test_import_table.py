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

COMMON = {"errors", "units", "space_vectors", "resources", "positions", "problems", "texts"}
KERNELS = {"kernel", "vectors", "sogi"}
# By folder, or module at the root: what of the package it may import besides itself. "*" is everything.
ALLOWED = {
    "__init__": set(),
    "errors": set(),
    "units": {"errors"},
    "space_vectors": set(),
    "resources": {"errors"},
    "positions": set(),
    "problems": {"errors"},
    "processes": set(),
    "locks": set(),
    "texts": set(),
    "compiled": {"errors", "texts"},
    "kernel": {"compiled"},
    "controllers": {"units"},  # what a user's own file imports
    "vectors": {"kernel", "space_vectors"},
    "sogi": {"kernel", "vectors"},
    "waveforms": COMMON,
    "scenario": COMMON,
    "profile": COMMON | {"scenario"},
    "measure": COMMON | {"waveforms"},
    "checks": COMMON | {"profile", "scenario", "measure", "waveforms"},
    "control": COMMON | KERNELS,
    "plant": COMMON | KERNELS,
    "simulation": COMMON
    | KERNELS
    | {"compiled", "processes", "locks", "controllers", "plant", "control", "scenario", "waveforms"},
    # The kernel's digest is part of the provenance of a run.
    "study": COMMON | {"kernel", "processes", "locks", "profile", "scenario", "simulation", "checks", "waveforms"},
    "report": COMMON | {"checks.results", "waveforms", "profile", "measure"},
    "cli": {"*"},
    "templates": set(),  # projects of users, which stand alone
    "__main__": {"cli"},
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


def test_checks_never_see_the_simulator():
    """What is judged is a record, simulated or recorded: no check reaches simulation, plant or control."""
    for folder in ("checks", "measure", "profile", "waveforms", "report"):
        for path in (PACKAGE / folder).glob("*.py"):
            assert not {name.split(".")[0] for name in own(imported(path))} & {"simulation", "plant", "control"}, path


def test_the_table_has_no_entry_for_what_is_gone():
    """Each name of the table is a part of the package."""
    parts = {part_of(path) for path in modules()} | {"__main__"}
    assert set(ALLOWED) <= parts


@pytest.mark.skipif(importlib.util.find_spec(f"{NAME}.cli.main") is None, reason="there is no command line yet")
def test_the_command_line_starts_light():
    """The application is there for --help before numba, scipy or plotly are imported."""
    code = f"import sys, {NAME}.cli.main; print(*sorted(m.split('.')[0] for m in sys.modules))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not {"numba", "scipy", "plotly", "pandas"} & set(run.stdout.split())
