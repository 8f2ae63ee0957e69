"""A lock is held by a process that lives, and by nobody else."""

import errno
import os
import subprocess
import sys

import pytest

from pvlvrt_compliance import locks
from pvlvrt_compliance.locks import holder_of, take_lock

HOLD = (
    "import sys, pathlib\n"
    "from pvlvrt_compliance.locks import take_lock\n"
    "lock = take_lock(pathlib.Path(sys.argv[1]))\n"
    "print('held' if lock else 'refused', flush=True)\n"
    "sys.stdin.read()\n"
)


def _holder(path):
    process = subprocess.Popen(
        [sys.executable, "-c", HOLD, path], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    return process, process.stdout.readline().strip()


@pytest.fixture
def path(tmp_path):
    """Where the lock stands."""
    return tmp_path / "lock"


def test_another_process_is_refused_until_the_first_is_gone(path):
    """Killed or not: a dead process holds nothing, whatever process has its id by then."""
    first, word = _holder(path)
    try:
        assert word == "held"
        assert take_lock(path) is None
        assert holder_of(path) == str(first.pid)
    finally:
        first.kill()
        first.communicate()
    assert path.exists()
    lock = take_lock(path)
    assert lock.is_certain
    assert holder_of(path) == str(os.getpid())
    second, word = _holder(path)
    second.communicate()
    assert word == "refused"
    lock.release()
    assert not path.exists()


def test_refused_within_one_process(path):
    """Two runs in two threads are two runs."""
    lock = take_lock(path)
    assert take_lock(path) is None
    lock.release()


def test_file_that_is_removed_meanwhile(path, monkeypatch):
    """What is held is the file that stands there, not one that its last holder has just removed."""
    right, removed = locks._hold, []

    def hold(descriptor):
        if not removed:
            removed.append(path.unlink())
        return right(descriptor)

    monkeypatch.setattr(locks, "_hold", hold)
    lock = take_lock(path)
    monkeypatch.undo()
    assert removed
    assert take_lock(path) is None
    lock.release()


def test_file_system_without_locks(path, monkeypatch):
    """It is taken all the same, and known to be uncertain."""
    fcntl = pytest.importorskip("fcntl")

    def flock(*_arguments):
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr(fcntl, "flock", flock)
    lock = take_lock(path)
    assert not lock.is_certain
    lock.release()


def test_link_in_the_place_of_a_lock(path, tmp_path):
    """Nobody has this process write to a file elsewhere by a link."""
    (tmp_path / "theirs").write_text("mine")
    path.symlink_to(tmp_path / "theirs")
    with pytest.raises(OSError, match="symbolic link"):
        take_lock(path)
    assert (tmp_path / "theirs").read_text() == "mine"


def test_no_room_for_a_signature(path, monkeypatch):
    """A lock that cannot be written is told, and leaves nothing."""

    def write(*_arguments):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "write", write)
    with pytest.raises(OSError, match="No space"):
        take_lock(path)
    assert not path.exists()
