"""Wheel, sdist and editable install: each finds its profiles and reports."""

import json
import os
import re
import shutil
import sys
from functools import cache
from pathlib import Path

import pytest

import jobs
from calls import call_program, completed
from pvlvrt_compliance.resources import resource_folder

pytestmark = pytest.mark.slow

_NAME = "pvlvrt_compliance"

ONE_TEST = {"PVLVRT_TEST": "VD2-full-1"}


@pytest.fixture(scope="module")
def project(distributions, root, tmp_path_factory):
    """Begin a project that has the wheel: ``project(kind) -> folder``."""
    folder = tmp_path_factory.mktemp("projects")

    @cache
    def project(kind):
        new = ("controllers", "new", "--kind", kind, "--install-from", distributions[".whl"], folder / kind)
        path = os.pathsep.join(filter(None, [str(root), os.environ.get("PYTHONPATH")]))
        completed("env", f"PYTHONPATH={path}", sys.executable, "-m", _NAME, *new, cwd=folder)
        return folder / kind

    return project


@pytest.fixture(scope="module")
def first_job(project, tmp_path_factory):
    """How each command of the job on GitHub ended, in a fresh environment; and where that has its programs."""
    environment, folder = tmp_path_factory.mktemp("fresh") / "venv", project("python")
    completed(sys.executable, "-m", "venv", environment, cwd=environment.parent)
    programs = environment / ("Scripts" if os.name == "nt" else "bin")
    job = jobs.github_job((folder / jobs.GITHUB).read_text("utf-8"), folder)
    return jobs.run(job, folder, programs, **ONE_TEST), programs


CUT_OFF = """
import socket

_connect, _find = socket.socket.connect, socket.getaddrinfo


def connect(self, address):
    if self.family in (socket.AF_INET, socket.AF_INET6) and address[0] not in ("127.0.0.1", "::1"):
        raise OSError(f"no network: {address}")
    return _connect(self, address)


def getaddrinfo(host, *rest, **more):
    if host not in (None, "localhost", "127.0.0.1", "::1"):
        raise socket.gaierror(f"no network: {host}")
    return _find(host, *rest, **more)


socket.socket.connect, socket.getaddrinfo = connect, getaddrinfo
"""
"""A module by which an environment reaches this machine alone."""


@pytest.fixture(scope="module")
def wheels(distributions, tmp_path_factory):
    """Folder of what the wheel needs, fetched where there is a network."""
    folder = tmp_path_factory.mktemp("wheels")
    pip = (sys.executable, "-m", "pip")
    completed(*pip, "download", "--quiet", "--dest", folder, distributions[".whl"], cwd=folder)
    return folder


@pytest.fixture(scope="module")
def installed(distributions, wheels, tmp_path_factory):
    """Folder of the programs of a fresh environment that has the wheel, nothing of the checkout, and no network."""
    environment = tmp_path_factory.mktemp("fresh") / "venv"
    completed(sys.executable, "-m", "venv", environment, cwd=environment.parent)
    programs = environment / ("Scripts" if os.name == "nt" else "bin")
    where = (programs / "python", "-c", "import sysconfig; print(sysconfig.get_path('purelib'))")
    site = Path(completed(*where, cwd=environment.parent).stdout.strip())
    (site / "cut_off.py").write_text(CUT_OFF, "utf-8")
    (site / "cut_off.pth").write_text("import cut_off\n", "utf-8")
    pip = (programs / "python", "-m", "pip", "install", "--quiet", "--no-index", "--find-links", wheels)
    completed(*pip, distributions[".whl"], cwd=environment.parent)
    return programs


def test_the_environment_has_no_network(installed, tmp_path):
    """What these tests show is shown without a network: an address elsewhere, or a name, is not reached."""
    for address in ("203.0.113.1", "example.org"):
        script = f"import socket; socket.create_connection(({address!r}, 80), timeout=5)"
        assert "no network" in call_program(installed / "python", "-c", script, cwd=tmp_path).stderr


def test_main_job_from_a_wheel(installed, tmp_path):
    """The wheel alone, with what it declares as dependencies, does the main job from any folder."""
    done = completed(installed / "pvlvrt-check", "--profile", "iec61400-21", "--sag", "90%", cwd=tmp_path)
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
    assert completed(installed / "python", "-c", script, cwd=tmp_path).stdout.strip() == "[True, True]"


def test_first_job_of_a_project(first_job, project):
    """The commands of the workflow, as written, install the wheel in a bare environment and find the project green."""
    done, _ = first_job
    assert [step.returncode for step in done] == [0, 0, 0], done[-1].stdout
    assert "PASS: 1 test; checks: 7 pass" in done[-1].stdout
    reports = project("python") / "pvlvrt-report"
    assert {"report.html", "junit.xml", "results.json"} <= {file.name for file in reports.iterdir()}


def test_job_of_another_service_uses_what_the_first_compiled(first_job, project):
    """The script for GitLab runs in the same checkout, writes what it says it publishes, and compiles nothing anew.

    There anybody may write what was checked out, as GitLab's runner has no umask.
    """
    _, programs = first_job
    folder = project("python")
    (folder / "pvlvrt.toml").chmod(0o666)
    compiled = kept_in(folder)
    assert compiled
    job = jobs.gitlab_job((folder / jobs.GITLAB).read_text("utf-8"), folder)
    (done,) = jobs.run(job, folder, programs, **ONE_TEST)
    assert done.returncode == 0, done.stdout
    assert kept_in(folder) == compiled
    (published,) = jobs.loaded((folder / jobs.GITLAB).read_text("utf-8")).values()
    for whole, _ in published["artifacts"]["reports"].values():
        assert (folder / whole).is_file()


def test_job_that_finds_something(first_job, project):
    """It ends with 1 and names what failed where the service shows it; the reports are there all the same."""
    _, programs = first_job
    folder = project("python")
    job = jobs.github_job((folder / jobs.GITHUB).read_text("utf-8"), folder)
    *_, done = jobs.run(job, folder, programs, PVLVRT_SET="controller.plateau_power_pu=0.2", **ONE_TEST)
    assert done.returncode == 1, done.stdout
    assert re.search(r"^::error [^\n]*VD2-full-1 reactive_support", done.stdout, re.MULTILINE), done.stdout
    assert r"| reactive\_support | fail |" in (folder.parent / jobs.STEP_SUMMARY).read_text("utf-8")
    results = json.loads((folder / "pvlvrt-report" / "results.json").read_text("utf-8"))
    assert results["status"] == "fail"


@pytest.mark.compiler
@pytest.mark.parametrize("kind", ["c", "fmu"])
def test_jobs_of_other_kinds(first_job, project, kind):
    """With what a runner has, a library or an FMU is built and found green."""
    _, programs = first_job
    folder = project(kind)
    shutil.copytree(project("python") / ".cache", folder / ".cache")
    job = jobs.github_job((folder / jobs.GITHUB).read_text("utf-8"), folder)
    done = jobs.run(job, folder, programs, **ONE_TEST)
    assert [step.returncode for step in done] == [0, 0, 0, 0], done[-1].stdout
    assert "PASS: 1 test; checks: 7 pass" in done[-1].stdout


def test_job_without_its_wheel(installed, tmp_path):
    """A project that still wants its wheel says so when it is begun, and its job ends by naming the file."""
    begun = completed(installed / "pvlvrt-check", "controllers", "new", "mine", cwd=tmp_path)
    (wheel,) = re.findall(r"pvlvrt_compliance-\S+\.whl", begun.stderr)
    folder = tmp_path / "mine"
    job = jobs.gitlab_job((folder / jobs.GITLAB).read_text("utf-8"), folder)
    (done,) = jobs.run(job, folder, installed)
    assert done.returncode != 0
    assert re.search(rf"No such file or directory: .*wheels/{wheel}", done.stdout), done.stdout


def test_header_from_a_wheel(installed, tmp_path):
    """The installed program prints the C header."""
    assert "Model_Outputs" in completed(installed / "pvlvrt-check", "controllers", "header", cwd=tmp_path).stdout


def kept_in(folder):
    """Compiled files of a project and when each was written."""
    kept = (folder / ".cache" / "kernels").rglob("*")
    return {str(file): file.stat().st_mtime_ns for file in kept if file.suffix in (".words", ".nbi", ".nbc")}


def test_bad_input_from_a_wheel(installed, tmp_path):
    """The installed program ends with the status of the verdict, and writes nothing on wrong usage."""
    done = call_program(installed / "pvlvrt-check", "--profile", "nowhere", "--sag", "90%", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert "known: dk-rfg, " in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_editable_install_uses_the_folders_of_the_checkout(installed, root, tmp_path):
    """Beside the package of a checkout, `profiles` and `reports` are found, so that an edit acts at once."""
    environment = tmp_path / "venv"
    completed(sys.executable, "-m", "venv", environment, cwd=tmp_path)
    python = environment / installed.name / "python"
    completed(python, "-m", "pip", "install", "--quiet", "--no-deps", "--editable", root, cwd=tmp_path)
    script = (
        "from pvlvrt_compliance.resources import resource_folder;"
        "print(resource_folder('profiles'), resource_folder('reports'), sep='\\n')"
    )
    found = completed(python, "-c", script, cwd=tmp_path).stdout.splitlines()
    assert [Path(line) for line in found] == [root.resolve() / "profiles", root.resolve() / "reports"]


@pytest.mark.parametrize("name", ["profiles", "reports"])
def test_resources_of_these_tests(name):
    """However the package under test is installed, its folders have files."""
    assert any(resource_folder(name).iterdir())
