"""Wheel, sdist and editable install: each finds its profiles and reports."""

import json
import os
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

from pvlvrt_compliance.resources import resource_folder
from waiting import PATIENCE_S

pytestmark = pytest.mark.slow

_NAME = "pvlvrt_compliance"
_BUILT = {".so", ".o"}
_LEFT_BY_TOOLS = {"__pycache__", "build", ".pytest_cache", ".hypothesis"}


def _is_left(path):
    """Whether a tool has left this file behind."""
    return path.suffix in _BUILT or bool(_LEFT_BY_TOOLS & set(path.parts))


def _call(*command, cwd):
    """Run a program in an environment that does not lead back to this one."""
    inherited = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "VIRTUAL_ENV"))}
    return subprocess.run(
        list(map(str, command)), cwd=cwd, env=inherited, capture_output=True, text=True, check=False, timeout=PATIENCE_S
    )


def _done(*command, cwd):
    done = _call(*command, cwd=cwd)
    assert done.returncode == 0, done.stdout + done.stderr
    return done


@pytest.fixture(scope="module")
def root(request):
    """The checkout."""
    return request.config.rootpath


@pytest.fixture(scope="module")
def distributions(root, tmp_path_factory):
    """Build the sdist, and the wheel from the sdist alone."""
    folder = tmp_path_factory.mktemp("dist")
    _done(sys.executable, "-m", "build", "--outdir", folder, root, cwd=folder)
    return {path.suffix: path for path in folder.iterdir()}


@pytest.fixture(scope="module")
def wheel_files(distributions):
    """Content of the wheel by name."""
    with zipfile.ZipFile(distributions[".whl"]) as wheel:
        return {name: wheel.read(name) for name in wheel.namelist()}


@pytest.fixture(scope="module")
def sdist_files(distributions):
    """Names in the sdist, without its top folder."""
    with tarfile.open(distributions[".gz"]) as sdist:
        return {name.partition("/")[2] for name in sdist.getnames()}


def test_wheel_has_every_source_profile_and_template(root, wheel_files):
    """What the package needs at run time is inside the package, byte for byte."""
    sources = {p.relative_to(root).as_posix(): p for p in (root / _NAME).rglob("*.py")}
    sources |= {f"{_NAME}/{p.relative_to(root).as_posix()}": p for p in (root / "profiles").glob("*.toml")}
    sources |= {f"{_NAME}/{p.relative_to(root).as_posix()}": p for p in (root / "reports").iterdir() if p.is_file()}
    sources |= {p.relative_to(root).as_posix(): p for p in (root / _NAME).rglob("*.h")}
    sources |= {p.relative_to(root).as_posix(): p for p in _templates(root)}
    sources[f"{_NAME}/py.typed"] = root / _NAME / "py.typed"
    assert {name for name in sources if name not in wheel_files} == set()
    assert {name for name, path in sources.items() if wheel_files[name] != path.read_bytes()} == set()


def _templates(root):
    return [
        p
        for p in (root / _NAME / "controllers" / "templates").rglob("*")
        if p.is_file() and "__pycache__" not in p.parts
    ]


def test_wheel_has_nothing_else(wheel_files):
    """No tests, no benchmarks, no caches; the licence goes with it."""
    tops = {name.partition("/")[0] for name in wheel_files}
    assert {top for top in tops if not top.endswith(".dist-info")} == {_NAME}
    inside = {Path(name).suffix for name in wheel_files if name.startswith(f"{_NAME}/")}
    assert inside <= {".py", ".typed", ".toml", ".j2", ".typ", ".css", ".js", ".svg", ".c", ".h", ".md", ".yml", ""}
    assert not any("cache" in name for name in wheel_files)
    assert any(name.endswith("/licenses/LICENSE") for name in wheel_files)


def test_sdist_can_be_tested(root, sdist_files):
    """The sdist carries tests, and what they need, besides what the wheel is made from."""
    folders = ("tests", "profiles", "reports", "benchmarks", "examples", "validation", "docs")
    wanted = [p for folder in folders for p in (root / folder).rglob("*.*")]
    names = {p.relative_to(root).as_posix() for p in wanted if p.is_file() and not _is_left(p)}
    assert names - sdist_files == set()
    assert sdist_files >= {"README.md", "LICENSE", "pyproject.toml"}


def test_checkout_and_sdist_give_the_same_wheel(root, wheel_files, tmp_path):
    """A wheel built from the checkout has the same files as one built from the sdist."""
    _done(sys.executable, "-m", "build", "--wheel", "--outdir", tmp_path, root, cwd=tmp_path)
    with zipfile.ZipFile(next(tmp_path.glob("*.whl"))) as wheel:
        direct = {name: wheel.read(name) for name in wheel.namelist()}
    assert {name for name in direct.keys() | wheel_files.keys() if direct.get(name) != wheel_files.get(name)} == set()


@pytest.fixture(scope="module")
def installed(distributions, tmp_path_factory):
    """Folder of the programs of a fresh environment that has the wheel, and nothing of the checkout."""
    environment = tmp_path_factory.mktemp("fresh") / "venv"
    _done(sys.executable, "-m", "venv", environment, cwd=environment.parent)
    programs = environment / ("Scripts" if os.name == "nt" else "bin")
    _done(programs / "python", "-m", "pip", "install", "--quiet", distributions[".whl"], cwd=environment.parent)
    return programs


def test_main_job_from_a_wheel(installed, tmp_path):
    """The wheel alone, with what it declares as dependencies, does the main job from any folder."""
    done = _done(installed / "pvlvrt-check", "--profile", "iec61400-21", "--sag", "90%", cwd=tmp_path)
    assert "PASS: 1 test; checks: 7 pass" in done.stdout
    assert done.stderr == ""
    reports = tmp_path / "pvlvrt-report"
    assert "<title>" in (reports / "report.html").read_text("utf-8")
    assert (reports / "junit.xml").is_file()
    results = json.loads((reports / "results.json").read_text("utf-8"))
    assert (reports / results["tests"][0]["waveforms"]).is_file()


def test_resources_of_a_wheel_are_its_own(installed, tmp_path):
    """Profiles and templates are those inside the installed package."""
    script = (
        "from pathlib import Path; import pvlvrt_compliance; from pvlvrt_compliance.resources import resource_folder;"
        "package = Path(pvlvrt_compliance.__file__).resolve().parent;"
        "print([resource_folder(name) == package / name for name in ('profiles', 'reports')])"
    )
    assert _done(installed / "python", "-c", script, cwd=tmp_path).stdout.strip() == "[True, True]"


def test_project_from_a_wheel(installed, tmp_path):
    """The installed program begins a controller in Python that passes its own gate, and prints the C header."""
    _done(installed / "pvlvrt-check", "controllers", "new", "mine", cwd=tmp_path)
    gate = ("--controller", "controller.py:Controller", "--profile", "iec61400-21", "--sag", "50%")
    done = _done(installed / "pvlvrt-check", *gate, cwd=tmp_path / "mine")
    assert "PASS: 1 test; checks: 7 pass" in done.stdout
    header = _done(installed / "pvlvrt-check", "controllers", "header", cwd=tmp_path).stdout
    assert "Model_Outputs" in header


def test_bad_input_from_a_wheel(installed, tmp_path):
    """The installed program ends with the status of the verdict, and writes nothing on wrong usage."""
    done = _call(installed / "pvlvrt-check", "--profile", "nowhere", "--sag", "90%", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert "known: dk-rfg, " in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_editable_install_uses_the_folders_of_the_checkout(installed, root, tmp_path):
    """Beside the package of a checkout, `profiles` and `reports` are found, so that an edit acts at once."""
    environment = tmp_path / "venv"
    _done(sys.executable, "-m", "venv", environment, cwd=tmp_path)
    python = environment / installed.name / "python"
    _done(python, "-m", "pip", "install", "--quiet", "--no-deps", "--editable", root, cwd=tmp_path)
    script = (
        "from pvlvrt_compliance.resources import resource_folder;"
        "print(resource_folder('profiles'), resource_folder('reports'), sep='\\n')"
    )
    found = _done(python, "-c", script, cwd=tmp_path).stdout.splitlines()
    assert [Path(line) for line in found] == [root.resolve() / "profiles", root.resolve() / "reports"]


@pytest.mark.parametrize("name", ["profiles", "reports"])
def test_resources_of_these_tests(name):
    """However the package under test is installed, its folders have files."""
    assert any(resource_folder(name).iterdir())
