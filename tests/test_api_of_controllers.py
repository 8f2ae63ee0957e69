"""A controller that is given to `check`: a class, an object, a specification, and where it runs."""

import os
import shutil
import signal
import subprocess
import sys

import pytest

from pvlvrt_compliance import Status, check, read_results
from pvlvrt_compliance.cli.main import run
from waiting import PATIENCE_S

IEC = "iec61400-21"


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """A project with a controller that rides through."""
    folder = tmp_path_factory.mktemp("api") / "my-controller"
    assert run(["controllers", "new", "--kind", "python", str(folder)]) == 0
    return folder


@pytest.fixture
def imported(project, monkeypatch):
    """A controller's class, imported from its file as a notebook would."""
    monkeypatch.chdir(project)
    monkeypatch.syspath_prepend(str(project))
    monkeypatch.delitem(sys.modules, "controller", raising=False)
    from controller import Controller

    yield Controller
    monkeypatch.delitem(sys.modules, "controller")


def test_an_imported_class_runs_as_it_is_here(imported, monkeypatch):
    """What has been changed of it counts; its verdicts are those of its file otherwise."""
    by_class, by_file = (check(IEC, controller=of, sag=0.5) for of in (imported, "controller.py:Controller"))
    assert by_class.tests[0].checks == by_file.tests[0].checks
    processes = set()
    reset = imported.reset
    monkeypatch.setattr(imported, "reset", lambda self, nominal: processes.add(os.getpid()) or reset(self, nominal))
    assert check(IEC, controller=imported, sag=0.5).tests[0].checks == by_file.tests[0].checks
    assert processes == {os.getpid()}


def test_an_object_gives_what_its_class_does(imported):
    """With the parameters that it was made with; how that was is told as far as it is known."""
    made = check(IEC, controller=imported(dsogi_gain=1.0), sag=0.5)
    of_class = check(IEC, controller=imported, sag=0.5, settings={"controller.dsogi_gain": 1.0})
    assert made.tests[0].checks == of_class.tests[0].checks
    assert "controller=Controller(...)" in made.provenance["command"]
    assert made.provenance["controller_parameters"]["dsogi_gain"] == 1.0


@pytest.mark.usefixtures("imported")
def test_a_specification_is_debugged_here(capfd):
    """It runs in this process, which is told by the logger alone; the verdicts are the same."""
    debugged, apart = (check(IEC, controller="controller.py:Controller", sag=0.5, debug=on) for on in (True, False))
    assert debugged.tests[0].checks == apart.tests[0].checks
    assert "debug" not in debugged.provenance["command"]
    assert capfd.readouterr() == ("", "")


def test_parameters_of_a_class(imported, capfd):
    """They reach a class; nothing is printed. Where tests run in processes of their own, the file is named."""
    given = {"controller": imported, "sag": 0.5, "settings": {"controller.dsogi_gain": 1.0}}
    for jobs, named in ((None, "controller.Controller"), (2, "controller.py:Controller")):
        results = check(IEC, **given, jobs=jobs)
        assert results.provenance["controller"] == named
        assert results.provenance["controller_parameters"]["dsogi_gain"] == 1.0
        assert "controller=Controller" in results.provenance["command"]
    assert capfd.readouterr() == ("", "")


@pytest.mark.slow
@pytest.mark.parametrize("controller", ["Controller", "None"])
def test_a_controllers_file_that_begins_a_run(project, tmp_path, controller):
    """It is refused in words, not run within its own run without end."""
    runs = f"from pvlvrt_compliance import check\ncheck('{IEC}', sag=0.5, controller={controller})\n"
    (tmp_path / "mine.py").write_text((project / "controller.py").read_text() + runs)
    command = ("-m", "pvlvrt_compliance", "--profile", IEC, "--sag", "50%", "--controller", "mine.py:Controller")
    done = subprocess.run(
        [sys.executable, *command], cwd=tmp_path, capture_output=True, text=True, check=False, timeout=PATIENCE_S
    )
    assert done.returncode == 2
    assert 'put what does under `if __name__ == "__main__":`' in done.stderr


INTERRUPTED = """
import sys
from controller import Controller
from pvlvrt_compliance import check
given = Controller if sys.argv[1] == "apart" else lambda: Controller()
check("iec61400-21", controller=given, output="out", progress=lambda *words: print(*words, flush=True))
"""


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="Windows cannot send a signal to one process")
@pytest.mark.parametrize("where", ["apart", "here"])
def test_ctrl_c_in_a_script(project, tmp_path, where):
    """It ends, whatever its controller is at, and says what is kept."""
    shutil.copy(project / "controller.py", tmp_path)
    (tmp_path / "script.py").write_text(INTERRUPTED)
    process = subprocess.Popen(
        [sys.executable, "script.py", where], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert [process.stdout.readline().split()[2] for _ in range(3)] == ["0", "1", "2"]
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=PATIENCE_S)
    assert process.returncode == -signal.SIGINT
    assert err.endswith("KeyboardInterrupt\n2 of 27 tests were finished and are kept in out/interrupted\n")
    assert len(read_results(tmp_path / "out" / "interrupted" / "results.json").tests) == 2


def test_a_controllers_file_with_the_usual_guard(project, tmp_path):
    """What runs as a script alone is not run with the controller."""
    guarded = (project / "controller.py").read_text() + '\nif __name__ == "__main__":\n    raise SystemExit("run")\n'
    (tmp_path / "mine.py").write_text(guarded)
    results = check(IEC, sag=0.5, controller=f"{tmp_path / 'mine.py'}:Controller")
    assert results.status in (Status.PASS, Status.FAIL)
