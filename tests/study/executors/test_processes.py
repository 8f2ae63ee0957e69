"""Tests run in processes of their own."""

import os
import pickle
import subprocess
import sys
from datetime import UTC, datetime
from pathlib import Path

import pytest

from pvlvrt_compliance.controllers.process.family import FORKS, descendants
from pvlvrt_compliance.errors import LostError
from pvlvrt_compliance.results import Status
from pvlvrt_compliance.study.executors import worker
from pvlvrt_compliance.study.executors.here import Here
from pvlvrt_compliance.study.executors.processes import Processes
from pvlvrt_compliance.study.executors.worker import start_words
from pvlvrt_compliance.study.job import Asked, make_job
from pvlvrt_compliance.study.named import Named
from pvlvrt_compliance.study.opening import open_controller
from pvlvrt_compliance.study.session import session
from pvlvrt_compliance.study.work import Keeping, Work
from waiting import PATIENCE_S, wait_until

IEC = "iec61400-21"
CONTROLLERS = Path(__file__).parents[2] / "controllers"

TWO = ("VD6-full-1", "paper-phase-c-90")
"""Tests of two units, the shortest that there are."""

pytestmark = pytest.mark.skipif(os.name == "nt", reason="these tests kill processes as POSIX does")


def work(*tests, each=None, **asked):
    """These tests, in which something is made."""
    return Work(job=make_job(Asked(profiles=(IEC,), tests=tests, **asked)), each=each)


def keeping(folder):
    """Records kept in a folder."""
    (folder / "waveforms").mkdir()
    return Keeping(staging=folder, folder=folder, created=datetime(2026, 1, 1, tzinfo=UTC))


@pytest.fixture
def none_are_left():
    """Wait until nothing runs any more that has been started in this test, as far as that can be seen."""
    before = set(descendants(os.getpid())) if FORKS else set()

    def wait():
        if FORKS:
            wait_until(lambda: not set(descendants(os.getpid())) - before, "the end of all processes")

    return wait


@pytest.mark.slow
def test_results_are_those_of_this_process(tmp_path, monkeypatch, none_are_left):
    """Each unit is run in a process of its own; results, records and what is made are the same."""
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    found = {}
    for name, executor in (("here", Here(is_ahead=False)), ("there", Processes(2))):
        (folder := tmp_path / name).mkdir()
        asked = Work(job=work(*TWO).job, keeping=keeping(folder), each=Named("makings:killed", {"tests": {}}))
        told = []
        tests = list(session(asked, executor=executor, progress=lambda *words, told=told: told.append(words)))
        assert {words[0] for words in told} == {f"{IEC} {test}" for test in TWO}
        files = {path.name: path.read_bytes() for path in (folder / "waveforms").iterdir()}
        found[name] = {test.result.id: test.result for test in tests}, files
        assert len(files) == 4
        assert len({test.made for test in tests} - {os.getpid()}) == (0 if name == "here" else 2)
        assert all(test.profile is asked.job.profiles[0] for test in tests)
    assert found["here"] == found["there"]
    none_are_left()


@pytest.mark.slow
def test_workers_that_are_killed(tmp_path, capfd, none_are_left):
    """A unit is run again in another process; one that kills that, too, is an error with the reason.

    What was printed is repeated here, once.
    """
    always, once = TWO
    tests = {always: "", once: str(tmp_path / "mark")}
    asked = work(*TWO, each=Named("makings:killed", {"tests": tests}))
    found = {test.result.id: test.result for test in session(asked, executor=Processes(1))}
    assert {test: found[test].status for test in TWO} == {always: Status.ERROR, once: Status.PASS}
    said = f"the process that ran it was killed (SIGKILL)\nit had printed: {always} is too much"
    assert {check.message for check in found[always].checks} == {said}
    assert sorted(capfd.readouterr().err.splitlines()) == sorted(f"{test} is too much" for test in TWO)
    none_are_left()


@pytest.mark.slow
@pytest.mark.skipif(not FORKS, reason="only Linux shows that a process is stopped")
@pytest.mark.parametrize(
    ("deed", "reason"), [("stopped", "was stopped (SIGSTOP)"), ("babbling", "said what it never says")]
)
def test_workers_that_are_stopped_or_not_understood(deed, reason, none_are_left):
    """They are ended; their unit is run again, is then an error, and the other test is in the results."""
    well, bad = TWO
    asked = work(*TWO, each=Named(f"makings:{deed}", {"tests": [bad]}))
    found = {test.result.id: test.result for test in session(asked, executor=Processes(1))}
    assert {test: found[test].status for test in TWO} == {well: Status.PASS, bad: Status.ERROR}
    said = {check.message.splitlines()[0] for check in found[bad].checks}
    assert said == {f"the process that ran it {reason}"}
    none_are_left()


@pytest.mark.slow
def test_an_error_of_the_program_ends_the_run(none_are_left):
    """It is raised as it was, and says where it was in the other process."""
    with pytest.raises(ZeroDivisionError, match=r"VD6-full-1 of \d") as raised:
        list(session(work(TWO[0], each=Named("makings:failing")), executor=Processes(1)))
    assert "makings.py" in str(raised.value.__cause__)
    none_are_left()


def test_processes_that_do_not_start(monkeypatch, none_are_left):
    """Nothing is tried for ever: the run ends with what they have printed."""
    monkeypatch.setattr(worker, "__name__", "worker")  # the module is one that nobody has
    monkeypatch.setattr(sys, "path", [])
    with pytest.raises(LostError, match=r"(?s)no test can be run in a process.*status 1\)\nit had printed: .*Error"):
        list(session(work(*TWO), executor=Processes(2)))
    none_are_left()


@pytest.mark.slow
def test_who_stops_listening_ends_the_processes():
    """Whatever they are at, and what controllers run in, they are gone then."""
    before = set(descendants(os.getpid()))  # of tests before, in the same process
    asked = work(*TWO, controller=f"{CONTROLLERS / 'small.py'}:Small")
    stream = session(asked, controller=open_controller(asked.job), executor=Processes(2))
    next(stream)
    stream.close()
    left = set(descendants(os.getpid())) - before
    assert len(left) <= 1  # that in which this process has opened the controller
    open_controller(asked.job).stop()


def test_a_worker_whose_run_has_gone_goes_too():
    """A worker ends as its input does, without a word, whatever has become of the other side."""
    code = "from pvlvrt_compliance.study.executors.worker import main; main()"
    words = start_words(work(*TWO), None) + b"0\n"
    ended = subprocess.run(
        [sys.executable, "-c", code], check=False, input=words, capture_output=True, timeout=PATIENCE_S
    )
    assert (ended.returncode, ended.stderr) == (0, b"")


def test_work_goes_to_another_process_as_it_is():
    """Profiles, tests and parameters are the same there, and one profile is one object."""
    asked = work(*TWO)
    found, _ = pickle.loads(pickle.dumps((asked, None)))
    assert found == asked
    assert found.job.profiles[0].digest == asked.job.profiles[0].digest
    assert all(item.profile is found.job.profiles[0] for item in found.job.tests)
