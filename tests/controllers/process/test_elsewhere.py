"""What one system has alone stands in one place, and keeps the package from no other system."""

import ast
import json
import re
from pathlib import Path

import pytest

import pvlvrt_compliance
from elsewhere import LINUX_ALONE, MISSING, POSIX_ALONE, POSIX_MODULES, on, run

PACKAGE = Path(pvlvrt_compliance.__file__).parent
ROOT = Path(__file__).parents[3]
PROGRAM = ("-m", "pvlvrt_compliance.cli.main")
MODULES = [path for path in sorted(PACKAGE.rglob("*.py")) if "templates" not in path.parts]

PROCESSES = "controllers/process/"
"""The room that knows copies of a process, groups and signals."""

LOCKS = "locks.py"
"""The file that knows how a process holds a file, and whose a file is."""

OF_LOCKS = {"fcntl", "msvcrt", "os.geteuid", "os.getuid", "os.O_NOFOLLOW"}
OF_PROCESSES = {name for name in (*LINUX_ALONE, *POSIX_ALONE, *POSIX_MODULES) if name not in OF_LOCKS}


def owner_of(path: Path) -> set[str]:
    """What a module may use that one system has alone."""
    place = path.relative_to(PACKAGE).as_posix()
    return OF_LOCKS if place == LOCKS else OF_PROCESSES if place.startswith(PROCESSES) else set()


def used_by(tree: ast.Module) -> set[str]:
    """What of it a module names: as a module that it imports, as an attribute, or as a keyword of a process."""
    known = OF_LOCKS | OF_PROCESSES
    found: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names} & known
        elif isinstance(node, ast.ImportFrom):
            found |= ({node.module} | {f"{node.module}.{alias.name}" for alias in node.names}) & known
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            found |= {f"{node.value.id}.{node.attr}"} & known
        elif isinstance(node, ast.keyword):
            found |= {node.arg} & {"preexec_fn", "start_new_session", "process_group", "pass_fds"}
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            found |= {"/proc"} & {node.value}
    return found


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.relative_to(PACKAGE).as_posix())
def test_one_place_knows_what_one_system_has(path):
    """Processes and signals are the business of one room, locks of one file; all others run anywhere."""
    mine = owner_of(path)
    more = {"start_new_session", "/proc"} if mine is OF_PROCESSES else set()
    assert used_by(ast.parse(path.read_text("utf-8"))) <= mine | more


@pytest.mark.parametrize(
    "text",
    [
        "import fcntl",
        "from pwd import getpwuid",
        "from os import fork",
        "import os\nos.killpg(1, 9)",
        "import signal\nsignal.SIGKILL",
        "subprocess.Popen([], start_new_session=True)",
        "Path('/proc')",
    ],
)
def test_it_is_found_however_it_is_written(text):
    """Each way to reach what one system has alone is looked for by what does so."""
    assert len(used_by(ast.parse(text))) == 1


@pytest.fixture(params=sorted(MISSING))
def elsewhere(request, tmp_path):
    """Run Python on another system: ``elsewhere(*arguments) -> its end``, which is to be well."""
    environment = on(request.param, tmp_path)

    def elsewhere(*arguments, status=0):
        done = run(environment, *arguments, cwd=ROOT)
        assert done.returncode == status, done.stderr
        return done

    elsewhere.platform = request.param
    return elsewhere


def _dotted(path):
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def test_every_module_is_imported(elsewhere):
    """Nothing that is missing is asked for before it is needed."""
    names = [_dotted(path) for path in MODULES]
    code = f"import importlib, os, sys\nfor name in {names!r}: importlib.import_module(name)\n"
    code += f"print(sys.platform, any(hasattr(os, n[3:]) for n in {MISSING[elsewhere.platform]!r} if n[:3] == 'os.'))"
    assert elsewhere("-c", code).stdout == f"{elsewhere.platform} False\n"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--help",), "Judge a PV inverter's controller"),
        (("profiles", "list"), "iec61400-21"),
        (("profiles", "show", "dk-rfg"), "dk-rfg"),
        (("profiles", "check", "profiles/iec61400-21.toml"), "ok: 27 tests"),
        (("schema",), "schema_version"),
        (("controllers", "header"), "Model_Outputs"),
    ],
)
def test_commands_run(elsewhere, arguments, words):
    """Reading and showing grid codes needs nothing that one system has alone."""
    assert words in elsewhere(*PROGRAM, *arguments).stdout


def test_a_record_is_judged(elsewhere):
    """The example of a check that is tried alone comes to its verdict, and its record to those of a whole profile."""
    page = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    (example,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    whole = (
        "from pvlvrt_compliance import evaluate\n"
        "found = evaluate('iec61400-21', Waveforms((Segment(0.0, 1e-4, channels),)), test=scenario)\n"
        "print(verdict.status, found.tests[0].disturbance.start_s, len(found.tests[0].checks))\n"
    )
    assert elsewhere("-c", f"{example}\n{whole}").stdout == "pass 0.3 7\n"


@pytest.mark.slow
@pytest.mark.parametrize("elsewhere", ["win32"], indirect=True)  # which lacks what the other does, and more
def test_a_run_writes_its_files(elsewhere, tmp_path):
    """The main job, with the lock of its folder, comes to the same verdicts."""
    out = tmp_path / "out"
    elsewhere(*PROGRAM, "--profile", "iec61400-21", "--sag", "50%", "--output", out)
    assert json.loads((out / "results.json").read_text("utf-8"))["status"] == "pass"
    assert {path.name for path in out.iterdir()} == {"report.html", "junit.xml", "results.json", "waveforms"}


BAD_DEEDS = """
import sys
sys.path.insert(0, sys.argv[2])
from waiting import stopped_in_its_loop
from pvlvrt_compliance.controllers.simulator import ForeignSimulator
from pvlvrt_compliance.errors import SimulationError
from pvlvrt_compliance.simulation.parameters import parameters_from
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario

scenario = Scenario(sag=Sag(depth=0.0), duration_s=0.1, after_s=0.1)
quick = parameters_from(("simulation.settling_s=0.2",))
for deed in ("exit", "crash"):
    try:
        ForeignSimulator(sys.argv[1], {"deed": deed})(scenario, quick)
    except SimulationError as error:
        print(str(error).splitlines()[0])
print(stopped_in_its_loop(ForeignSimulator(sys.argv[1], {"deed": "loop"}), scenario, quick, "about to loop")[:27])
print(ForeignSimulator(sys.argv[1])(scenario, quick).end_s)
"""


@pytest.mark.slow
@pytest.mark.parametrize("elsewhere", ["win32"], indirect=True)  # which lacks what the other does, and more
def test_a_bad_controller_costs_its_own_run(elsewhere):
    """With a copy of the process or without: what went wrong is told, and the next controller is well."""
    spec = f"{Path(__file__).parents[1] / 'misbehaving.py'}:Controller"
    said = elsewhere("-c", BAD_DEEDS, spec, ROOT / "tests" / "support").stdout.splitlines()
    left, crashed, stopped, end_s = said
    assert left == "the controller ended the process (status 0) at 0.1000 s"
    assert crashed == "the controller crashed (SIGSEGV) at 0.1000 s"
    assert stopped == "the controller was stopped "
    assert float(end_s) > 0.4
