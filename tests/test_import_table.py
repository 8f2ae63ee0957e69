"""Who may import whom: the table of the design, checked on the source of every module."""

import ast
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

import pvlvrt_compliance

PACKAGE = Path(pvlvrt_compliance.__file__).parent
NAME = pvlvrt_compliance.__name__

COMMON = {"errors", "ordinary_file", "units", "space_vectors", "resources", "texts"}
KERNELS = {"kernel", "vectors", "sogi"}
# By folder, or module at the root: what of the package it may import besides itself. "*" is everything; an entry with a
# dot is one module of a folder.
ALLOWED = {
    # Parse, call, print, exit: everything, inside the command that needs it; see COMMANDS.
    "cli": {"*"},
    # The public API.
    "__init__": {"api", "errors", "profile", "results", "scenario", "units", "waveforms"},  # each when first used
    # Another way in, beside the command line: the same settings, the same words.
    "pytest_plugin": {"api", "cli.options", "errors", "report", "results", "settings", "study", "texts", "trust"},
    # The public functions; they hand reports to the run, which knows none.
    "api": {"checks", "output", "profile", "results", "scenario", "study", "units", "waveforms"},
    # What there is to say of every grid code that can be named.
    "profile_list": {"cache", "checks", "data", "errors", "profile"},
    # What a run writes.
    "output": {"errors", "report", "results", "study", "texts"},
    "__main__": {"cli"},
    # One file a format, and how a figure is drawn.
    "report": COMMON | {"cache", "data", "disturbance", "evidence", "results", "waveforms", "profile"},
    # The run: a job in, judged tests out. The kernel's digest is part of the provenance of a run.
    "study": COMMON
    | {"checks", "controllers", "data", "disturbance", "evidence", "kernel", "locks", "profile", "results", "scenario"}
    | {"simulation", "trust", "waveforms"},
    # Judging: by what evidence says, never by the simulator.
    "checks": COMMON | {"data", "disturbance", "evidence", "measure", "profile", "results", "waveforms"},
    # The one result: plain data, so that reading it stays light.
    "results": {"data.problems", "errors", "ordinary_file", "texts", "units"}
    | {"measure.quantities", "disturbance.model"},
    # What a check sees of one record.
    "evidence": COMMON | {"disturbance", "measure", "profile", "waveforms"},
    # What standards measure.
    "measure": COMMON | {"waveforms"},
    # What the grid did, made from a scenario or from a record.
    "disturbance": COMMON | {"measure", "scenario", "waveforms"},
    # The record and its files.
    "waveforms": COMMON,
    # The data model of a grid code.
    "profile": COMMON | {"data", "scenario"},
    # What every file that people write shares.
    "data": {"cache", "errors", "ordinary_file", "resources", "texts"},
    # What was written down instead of typed; which settings there are, whoever asks says.
    "settings": {"controllers.bundled", "controllers.spelling", "data", "errors", "ordinary_file", "texts", "trust"},
    # What is asked of grid, weather and set-points.
    "scenario": COMMON | {"data"},
    # Controllers of users: whatever a door needs of the loop lies in simulation/door.
    "controllers": COMMON | {"compiled", "data", "locks", "scenario", "simulation", "waveforms"},
    # The loop over time, which joins plant, hardware and a controller.
    "simulation": COMMON
    | KERNELS
    | {"plant", "control", "data", "hardware", "measured", "parameter_group", "places", "scenario", "waveforms"},
    # The block diagram; control and hardware know nothing of each other.
    "control": COMMON | KERNELS | {"measured", "parameter_group"},
    "hardware": COMMON | KERNELS | {"measured", "parameter_group", "places"},
    "plant": COMMON | KERNELS | {"parameter_group"},
    # At the root.
    "measured": set(),
    "parameter_group": set(),
    "places": set(),
    "errors": {"texts"},
    "ordinary_file": set(),
    "units": {"errors"},
    "space_vectors": set(),
    "resources": {"errors"},
    "locks": set(),
    "texts": set(),
    "trust": set(),
    "compiled": {"errors", "texts"},
    # The folder of what is made anew when it is lost: compiled code, and what reports keep there.
    "cache": {"compiled"},
    "kernel": {"cache", "compiled"},
    "vectors": {"kernel", "space_vectors"},
    "sogi": {"kernel", "vectors"},
}

COMPILED = {"compiled", "kernel", "plant", "control", "hardware", "simulation"}
"""The five rooms of compiled code; the kernel's has two names."""

NUMBA = {"compiled", "simulation"}
"""Those that know numba, which has no part in running what is kept: what compiles, and how a door is called."""

WAYS_IN = ("cli", "__main__", "pytest_plugin")
"""Where a program comes in: the table of options is there for all of them."""

NEVER = (
    ("simulation", "controllers", "the loop takes whatever is behind a door"),
    ("study", "report", "a run gives results; what is made of them is another's affair"),
    ("checks", "simulation", "what is judged is a record, simulated or not"),
    *((room, "cli", "only what starts a run calls") for room in ALLOWED if room not in WAYS_IN),
    *(
        (room, part, "records by others are read, measured, judged and shown in the same way")
        for room in ("checks", "disturbance", "evidence", "measure", "profile", "results", "waveforms", "report")
        for part in ("simulation", "plant", "control", "hardware", "controllers", "study")
    ),
)
"""Who never imports whom, directly or by what it imports, and why, whatever the table says."""

COMMANDS = {
    "main": {"controllers"},  # what signals and the end of the command are
    "running": {"controllers"},  # likewise
    "typed": {"controllers"},  # how one is written
    "completion/values": {"controllers", "simulation"},  # names of what there is, which load no kernel
    "controllers/header": {"controllers"},
    "controllers/inspect": {"controllers", "simulation"},  # parameters, which load no kernel
    "controllers/new": {"controllers"},
    "controllers/replay": {"controllers", "simulation"},  # likewise
}
"""Files of `cli/` that may touch simulation or controllers; all others are of grid codes and of files."""

PRINT_OR_EXIT = ("cli", "controllers/process")
"""Where something is printed, or a process ended; a process of a controller answers by a pipe."""


def modules() -> list[Path]:
    """Every module of the package; projects that users begin with are none."""
    return [path for path in sorted(PACKAGE.rglob("*.py")) if "templates" not in path.parts]


def place_of(path: Path) -> str:
    """Path within the package, without its suffix."""
    return path.relative_to(PACKAGE).with_suffix("").as_posix()


def part_of(path: Path) -> str:
    """Folder of a module, or its own name at the root."""
    return place_of(path).split("/")[0]


@cache
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


def rooms(path: Path) -> set[str]:
    """Folders, and modules at the root, that a module imports."""
    return {name.split(".")[0] for name in own(imported(path))}


every_module = pytest.mark.parametrize("path", modules(), ids=place_of)


@every_module
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


@every_module
def test_numba_stays_with_the_kernels(path):
    """Only what compiles knows numba, so that nothing else ever pays for it."""
    if part_of(path) not in NUMBA:
        assert not {name.split(".")[0] for name in imported(path)} & {"numba", "llvmlite"}


@every_module
def test_only_the_command_line_prints_or_exits(path):
    """All others return and raise, so that a notebook, a test or another program can use them."""
    if place_of(path).startswith(tuple(f"{place}/" for place in PRINT_OR_EXIT)):
        return
    tree = ast.parse(path.read_text("utf-8"))
    used = {ast.unparse(node) for node in ast.walk(tree) if isinstance(node, ast.Name | ast.Attribute)}
    assert not used & {"print", "exit", "quit", "SystemExit", "sys.exit", "os._exit", "os.abort"}
    assert not used & {"sys.stdout", "sys.stderr", "Console", "rich.print", "typer.echo", "typer.Exit"}


@pytest.mark.parametrize("path", [path for path in modules() if part_of(path) == "cli"], ids=place_of)
def test_a_command_touches_what_it_needs(path):
    """Commands that neither simulate nor open a controller cannot come to depend on either."""
    allowed = COMMANDS.get(place_of(path).removeprefix("cli/"), set())
    found = rooms(path) & {"simulation", "controllers", "plant", "control", "hardware", "kernel"}
    assert found <= allowed


def test_commands_that_may_touch_it_do():
    """A command that no longer needs the simulator, or a controller, leaves the list."""
    for name, allowed in COMMANDS.items():
        assert allowed <= rooms(PACKAGE / "cli" / f"{name}.py"), name


@pytest.mark.parametrize(("room", "other", "why"), NEVER, ids=[f"{room} {other}" for room, other, _ in NEVER])
def test_never(room, other, why):
    """Some rooms have nothing to do with each other, not even by way of a third."""
    found, new = set(), {room}
    while new:
        found |= new
        new = {name for path in modules() if part_of(path) in new for name in rooms(path)} - found
        # A result has plain data of these two alone.
        new -= {"measure", "disturbance"} if room == "results" else set()
    assert other not in found, why


def test_reports_measure_nothing():
    """What is drawn and told is what was judged: no report measures it again."""
    for path in (PACKAGE / "report").rglob("*.py"):
        assert "measure" not in rooms(path), path


def test_imports_flow_one_way():
    """No two rooms need each other: the rooms have an order, which is that of the data."""
    parts = sorted({part_of(path) for path in modules()} - {"__init__"})
    needs = {part: {n for p in modules() if part_of(p) == part for n in rooms(p)} - {part} for part in parts}
    needs["results"] -= {"measure", "disturbance"}  # two modules of plain data, which import nothing but numbers
    order = list(TopologicalSorter(needs).static_order())
    assert order.index("simulation") < order.index("controllers") < order.index("cli")


def test_one_room_reads_toml():
    """Files that people write are read by data/ alone, so that all of them are read with the same care."""
    readers = {part_of(path) for path in modules() if "tomllib" in imported(path)}
    assert readers == {"data"}


def test_no_check_sees_a_scenario():
    """What the grid did reaches checks as a disturbance, made from a scenario or found in a record."""
    for path in (PACKAGE / "checks").rglob("*.py"):
        assert "scenario" not in rooms(path), path
        names = {node.id for node in ast.walk(ast.parse(path.read_text("utf-8"))) if isinstance(node, ast.Name)}
        assert "Scenario" not in names, path


@pytest.mark.parametrize("part", sorted(ALLOWED))
def test_the_table_allows_nothing_that_nobody_needs(part):
    """A part that stops using another gives up the right to, so that the table says how the rooms lie."""
    used = {name for path in modules() if part_of(path) == part for name in own(imported(path))}
    heads = {".".join(name.split(".")[:depth]) for name in used for depth in (1, 2)}
    everyone_may = COMMON | (KERNELS if part in COMPILED else set()) | {"*"}
    assert not ALLOWED[part] - everyone_may - heads


def test_the_table_has_no_entry_for_what_is_gone():
    """Each name of the table is a part of the package."""
    assert set(ALLOWED) <= {part_of(path) for path in modules()}
