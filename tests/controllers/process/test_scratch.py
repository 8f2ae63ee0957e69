"""Temporary folders of runs that were killed are cleared away by the next, and nobody else's."""

import os
import signal
import subprocess
import sys

import pytest

from pvlvrt_compliance import locks
from pvlvrt_compliance.controllers.process.scratch import clear_abandoned, job_folder

MAKE = (
    "import sys\n"
    "from pvlvrt_compliance.controllers.process.scratch import job_folder\n"
    "with job_folder() as folder:\n"
    "    (folder / 'record.npy').write_text('half')\n"
    "    print(folder, flush=True)\n"
    "    sys.stdin.read()\n"
)


@pytest.fixture(autouse=True)
def temporary(tmp_path, monkeypatch):
    """A temporary folder of the test's own."""
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    return tmp_path


@pytest.fixture
def other():
    """Another process with a job."""
    process = subprocess.Popen([sys.executable, "-c", MAKE], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    process.stdout.readline()
    yield process
    process.kill()
    process.communicate()


def test_folder_is_gone_after_its_job(temporary):
    """With its lock."""
    with job_folder() as folder:
        assert folder.is_dir()
        assert len(list(temporary.iterdir())) == 2
    assert list(temporary.iterdir()) == []


def locked(folder):
    """Nobody may look into it, nor into what is in it."""
    (folder / "in" / "it").mkdir(parents=True)
    (folder / "in" / "it" / "file").touch()
    (folder / "in").chmod(0)
    folder.chmod(0)


def elsewhere(folder):
    """A link stands in its place."""
    folder.rmdir()
    (folder.parent / "mine").mkdir()
    (folder.parent / "mine" / "file").touch()
    folder.symlink_to(folder.parent / "mine")


@pytest.mark.skipif(os.name == "nt", reason="rights and links are those of POSIX")
@pytest.mark.parametrize(("deed", "stays"), [(locked, []), (elsewhere, ["mine"]), (os.rmdir, [])])
def test_folder_that_a_controller_has_spoiled(temporary, deed, stays):
    """It is gone after its job all the same, and what a link leads to is left alone."""
    with job_folder() as folder:
        deed(folder)
    assert [path.name for path in temporary.iterdir()] == stays
    assert all((temporary / name / "file").is_file() for name in stays)


@pytest.mark.usefixtures("other")
def test_living_process_keeps_its_folder(temporary):
    """As long as it lives; and so does this one."""
    with job_folder():
        before = sorted(temporary.iterdir())
        clear_abandoned()
        assert sorted(temporary.iterdir()) == before
    assert len(list(temporary.iterdir())) == 2


def test_killed_process_leaves_nothing_for_long(temporary, other):
    """Its folder and lock are there until the next run."""
    other.kill()
    other.communicate()
    assert len(list(temporary.iterdir())) == 2
    (temporary / "pvlvrt-job-mine.txt").write_text("mine")
    (temporary / "pvlvrt-job-mine").mkdir()
    clear_abandoned()
    assert sorted(p.name for p in temporary.iterdir()) == ["pvlvrt-job-mine", "pvlvrt-job-mine.txt"]


def test_folder_of_another_user(temporary, other, monkeypatch):
    """It is left alone, whether its process lives or not."""
    other.kill()
    other.communicate()
    monkeypatch.setattr(locks, "is_mine", lambda _path: False)
    monkeypatch.setattr("pvlvrt_compliance.controllers.process.scratch.is_mine", locks.is_mine)
    clear_abandoned()
    assert len(list(temporary.iterdir())) == 2


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="files have no users there")
def test_whose_a_file_is(temporary, monkeypatch):
    """By its user; of a link, by that of the link."""
    (temporary / "file").touch()
    assert locks.is_mine(temporary / "file")
    monkeypatch.setattr(os, "geteuid", lambda: os.stat(temporary).st_uid + 1)  # noqa: PTH116 - not through Path
    assert not locks.is_mine(temporary / "file")


@pytest.mark.skipif(os.name == "nt", reason="Windows ends a process without a signal")
def test_ended_by_a_signal_of_its_own(temporary, other):
    """Ctrl-C ends a job with its folder."""
    other.send_signal(signal.SIGINT)
    other.communicate()
    assert list(temporary.iterdir()) == []
