"""Neither a controller that hangs nor what it has started outlives the run."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from waiting import PATIENCE_S, wait_until

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells whose child an orphan was")

CONTROLLER = Path(__file__).parents[1] / "controllers" / "lasting.py"


@pytest.fixture
def start(tmp_path):
    """Start the command with the controller, its temporary folder `tmp`: ``start(hangs) -> (process, its child)``.

    When the process has left its child behind, that child's id is known.
    """
    (tmp_path / "tmp").mkdir()
    pid_file = tmp_path / "pid"
    started = []

    def start(hangs, *more):
        settings = (f"controller.pid_file={pid_file}", f"controller.hangs={str(hangs).lower()}")
        process = subprocess.Popen(
            [
                *(sys.executable, "-m", "pvlvrt_compliance.cli.main", "--profile", "iec61400-21", "--sag", "50%"),
                *("--controller", f"{CONTROLLER}:Controller", "--set", settings[0], "--set", settings[1]),
                *("--output", tmp_path / "out", *more),
            ],
            env=os.environ | {"TMPDIR": str(tmp_path / "tmp")},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        started.append(process)
        wait_until(lambda: pid_file.exists() or process.poll() is not None, "the controller's child")
        assert pid_file.exists(), process.communicate()
        return process, int(pid_file.read_text())

    yield start
    for process in started:
        process.kill()
        process.communicate()


def assert_gone(pid):
    """There is no such process, not even one that nobody has waited for."""
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)


@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)], ids=["INT", "TERM"])
def test_one_signal_ends_it_all(start, tmp_path, number, status):
    """The controller hangs in the one simulation: nothing is kept, no process, no folder."""
    process, child = start(hangs=True)
    process.send_signal(number)
    out, err = process.communicate(timeout=PATIENCE_S)
    assert (process.returncode, out) == (status, "")
    assert err.endswith("; 0 of 1 tests were finished, nothing was written\n")
    assert_gone(child)
    assert list((tmp_path / "tmp").iterdir()) == []
    assert not (tmp_path / "out").exists()


def test_the_end_of_the_run_is_the_end_of_its_children(start, tmp_path):
    """Without any signal, too."""
    process, child = start(hangs=False)
    process.communicate(timeout=PATIENCE_S)
    assert process.returncode in (1, 3)
    assert_gone(child)
    assert list((tmp_path / "tmp").iterdir()) == []


@pytest.mark.slow
def test_time_counts_while_the_command_is_stopped(start, tmp_path):
    """Its controller ends at its limit, and what that has started; the command goes on where it was."""
    process, child = start(True, "--set", "simulation.time_limit_s=5")
    process.send_signal(signal.SIGSTOP)
    wait_until(lambda: not Path(f"/proc/{child}").exists(), "the end of the controller")
    process.send_signal(signal.SIGCONT)
    out, err = process.communicate(timeout=PATIENCE_S)
    assert process.returncode == 3, err
    assert "stopped after 5 s of computing (simulation.time_limit_s)" in out
    assert "Traceback" not in out + err
    assert list((tmp_path / "tmp").iterdir()) == []


@pytest.mark.slow
def test_what_a_killed_command_leaves_in_the_temporary_folder(start, program, tmp_path):
    """It is gone once the next run has begun, whatever controller that has."""
    process, child = start(hangs=True)
    process.kill()
    process.communicate(timeout=PATIENCE_S)
    wait_until(lambda: not Path(f"/proc/{child}").exists(), "the end of what is in a session of its own")
    assert len(list((tmp_path / "tmp").iterdir())) == 2
    arguments = ("--profile", "iec61400-21", "--sag", "90%", "--output", tmp_path / "out")
    assert program(*arguments, TMPDIR=str(tmp_path / "tmp")).status == 0
    assert list((tmp_path / "tmp").iterdir()) == []
    assert not list((tmp_path / "out").glob(".unfinished*"))


@pytest.mark.parametrize(
    ("number", "status", "says"),
    [(signal.SIGINT, 130, "interrupted"), (signal.SIGTERM, 143, "terminated (SIGTERM)")],
    ids=["INT", "TERM"],
)
def test_one_signal_while_a_controller_is_opened(tmp_path, number, status, says):
    """Before any simulation, too, the one line is there, and nothing else."""
    code = f"from pathlib import Path\nPath({str(tmp_path / 'here')!r}).touch()\nwhile True: pass\n"
    (tmp_path / "hangs.py").write_text(code)
    (tmp_path / "tmp").mkdir()
    process = subprocess.Popen(
        [
            *(sys.executable, "-m", "pvlvrt_compliance.cli.main", "--profile", "iec61400-21", "--sag", "50%"),
            *("--controller", f"{tmp_path / 'hangs.py'}:C", "--output", tmp_path / "out"),
        ],
        env=os.environ | {"TMPDIR": str(tmp_path / "tmp")},
        stderr=subprocess.PIPE,
        text=True,
    )
    wait_until(lambda: (tmp_path / "here").exists() or process.poll() is not None, "the controller's file")
    assert (tmp_path / "here").exists(), process.communicate()
    process.send_signal(number)
    _, err = process.communicate(timeout=PATIENCE_S)
    assert (process.returncode, err) == (status, f"pvlvrt-check: {says}\n")
    assert list((tmp_path / "tmp").iterdir()) == []
    assert not (tmp_path / "out").exists()
