"""What was started is found and ended, one by one."""

import os
import subprocess
import sys
from contextlib import suppress

import pytest

from pvlvrt_compliance.controllers.process import family

linux = pytest.mark.skipif(not family.FORKS, reason="only Linux shows the processes of a process")

FAMILY = (
    "import subprocess, sys\n"
    "child = subprocess.Popen(['setsid', 'sleep', '600'], stdout=subprocess.DEVNULL)\n"
    "print(child.pid, flush=True)\n"
    "sys.stdin.read()\n"
)


@pytest.fixture
def relatives():
    """A process, and its child that is in a session of its own."""
    process = subprocess.Popen([sys.executable, "-c", FAMILY], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    child = int(process.stdout.readline())
    yield process, child
    with suppress(ProcessLookupError):
        os.kill(child, 9)
    process.kill()
    process.communicate()


@linux
def test_family_is_found(relatives):
    """Children of children too; those that are spared are left out with theirs."""
    process, child = relatives
    found = [p.pid for p in family.descendants(os.getpid())]
    assert found.index(process.pid) < found.index(child)
    spared = next(p for p in family.descendants(os.getpid()) if p.pid == process.pid)
    assert not {process.pid, child} & {p.pid for p in family.descendants(os.getpid(), [spared])}


@linux
def test_only_the_same_process_is_killed(relatives):
    """A process that has the id of one that is gone is left alone."""
    process, child = relatives
    (found,) = (p for p in family.descendants(process.pid) if p.pid == child)
    family.kill(found._replace(started="1"))
    assert found in family.descendants(process.pid)
    handle = os.pidfd_open(child)
    family.kill(found)
    family.select.select([handle], [], [])
    os.close(handle)
