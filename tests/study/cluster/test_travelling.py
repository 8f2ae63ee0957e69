"""How what a job needs comes to a worker that shares no disk: here the worker is this process."""

import sys
from pathlib import Path

import pytest

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.study.executors.cluster import worker
from pvlvrt_compliance.study.executors.cluster.identity import differences, identity
from pvlvrt_compliance.study.executors.cluster.luggage import packed
from pvlvrt_compliance.study.job import Asked, make_job
from pvlvrt_compliance.study.opening import open_controller
from pvlvrt_compliance.study.work import Work

CONTROLLER = """
from pathlib import Path

from helper import GAIN


class Own:
    sample_time_s = 1e-4

    def __init__(self):
        self.offset = float(Path(__file__).with_name("offset.txt").read_text())

    def reset(self, nominal):
        pass

    def step(self, y):
        return GAIN * y.m_a + self.offset, GAIN * y.m_b, GAIN * y.m_c
"""


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A controller of several files, in the working folder."""
    folder = tmp_path / "project"
    folder.mkdir()
    (folder / "own.py").write_text(CONTROLLER)
    (folder / "helper.py").write_text("GAIN = 1.0\n")
    (folder / "offset.txt").write_text("0.0\n")
    (folder / "own.mapping.toml").write_text('files = ["helper.py", "*.txt"]\n')
    monkeypatch.chdir(folder)
    return folder


@pytest.fixture(autouse=True)
def _taken():
    """What the worker has taken is removed at the end."""
    yield
    worker.forget("run")


def _parcel(**asked):
    job = make_job(Asked(profiles=["iec61400-21"], sag="50%", duration="50ms", **asked))
    return packed(Work(job=job), open_controller(job))


def _moved(folder: Path) -> None:
    """As on a machine of which the user's folder is not a part."""
    folder.rename(folder.with_name("elsewhere"))


def test_a_controller_travels_with_what_its_mapping_lists(project):
    """It runs where nothing of it was: its file, the module that it imports and the file that it reads were sent."""
    parcel = _parcel(controller="own.py:Own")
    _moved(project)
    assert worker.receive("run", parcel) == ""
    ran = worker.run_unit("run", 0)
    (finished,) = ran.finished
    assert not ran.failed
    assert finished.result.status != "error"


def test_a_file_that_is_not_listed_is_missed(project):
    """The worker is refused before anything is run, with what is missing there."""
    (project / "own.mapping.toml").unlink()
    parcel = _parcel(controller="own.py:Own")
    _moved(project)
    said = worker.receive("run", parcel)
    assert said.startswith("controller own.py:Own: as it was sent: ")
    assert "No module named 'helper'" in said


def test_the_same_files_at_the_same_place_do_as_well(project):
    """A worker with the same disk runs what cannot be sent from where it is; not if its digest is another."""
    (project / "own.mapping.toml").unlink()
    parcel = _parcel(controller="own.py:Own")
    assert worker.receive("run", parcel) == ""
    (project / "own.py").write_text(CONTROLLER + "# another\n")
    assert "its digest is" in worker.receive("run", parcel)


def test_a_parameter_out_of_its_range_is_as_allowed_there_as_here():
    """What the worker opens anew is opened with the same leave, and every run of it, too."""
    own = Path(__file__).resolve().parents[3] / "examples" / "program-python" / "controller.py"
    given = {"controller": f'stdio:"{sys.executable}" "{own}"', "settings": ["controller.reactive_gain=12"]}
    assert worker.receive("run", _parcel(**given, allow_out_of_range=True)) == ""
    (finished,) = worker.run_unit("run", 0).finished
    assert finished.result.status != "error"
    with pytest.raises(UsageError, match="12 is out of range; 0 to 10 is allowed"):
        open_controller(make_job(Asked(profiles=["iec61400-21"], sag="50%", **given)))


def test_a_class_of_this_process_is_refused():
    """What exists here alone cannot go anywhere, which is said before a scheduler is asked."""

    class Own:
        sample_time_s = 1e-4

        def reset(self, nominal):
            pass

        def step(self, y):
            return y.m_a, y.m_b, y.m_c

    with pytest.raises(UsageError, match="cannot be sent to other machines: the controller exists in this process"):
        _parcel(controller=Own)


def test_a_recording_travels(tmp_path, monkeypatch):
    """A voltage that is played back comes from the file that was sent; the result names it as it was given."""
    monkeypatch.chdir(tmp_path)
    rows = (f"{k * 1e-3:.3f},{400 * (k % 20 < 10)},0,0" for k in range(40))
    Path("recorded.csv").write_text("\n".join(["t_s,u_a_v,u_b_v,u_c_v", *rows]) + "\n")
    Path("events.toml").write_text('[[events]]\nkind = "recording"\nfile = "recorded.csv"\nt_s = 0.0\n')
    parcel = _parcel(events="events.toml")
    Path("recorded.csv").unlink()
    assert worker.receive("run", parcel) == ""
    (finished,) = worker.run_unit("run", 0).finished
    assert finished.result.status != "error"


def test_a_damaged_job_is_not_taken():
    """What has not the digest that was sent with it is not unpacked."""
    parcel = _parcel()
    said = worker.receive("run", parcel._replace(content=parcel.content + b"."))
    assert said == "the job has not arrived as it was sent"
    assert worker.run_unit("run", 0).is_unknown


def test_a_worker_keeps_few_jobs():
    """Of a client that never says goodbye nothing is kept for ever."""
    parcel = _parcel()
    names = [f"client {k}" for k in range(6)]
    for name in names:
        assert worker.receive(name, parcel) == ""
    known = [not worker.run_unit(name, 99).is_unknown for name in names]
    assert known == [False, False, True, True, True, True]
    for name in names:
        worker.forget(name)


def test_what_differs_is_named():
    """A version is shown whole, a digest as much as a person compares; what is there besides does not matter."""
    needed = identity()
    assert differences(needed, needed | {"other": "1"}) == ""
    assert differences(needed, needed | {"numpy": "1.0"}) == f"numpy 1.0 where {needed['numpy']} is needed"
    assert differences({"check mine": "a" * 64}, {}) == f"check mine none where {'a' * 12} is needed"
