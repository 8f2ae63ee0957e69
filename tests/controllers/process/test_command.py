"""Signals that ask the command to end, and what it leaves behind: nothing."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from pvlvrt_compliance.controllers.process import family

linux = pytest.mark.skipif(not family.FORKS, reason="only Linux shows the processes of a process")

COMMAND = (
    "import os, subprocess, sys\n"
    "from pvlvrt_compliance.controllers.process import command\n"
    "before = subprocess.Popen(['sleep', '600'], stdout=subprocess.DEVNULL)\n"
    "command.become_the_command()\n"
    "command.before_children()\n"
    "started = subprocess.Popen([sys.executable, '-c', 'import subprocess; "
    'print(subprocess.Popen(["setsid", "sleep", "600"], stdout=2).pid)\'], stdout=subprocess.PIPE, text=True)\n'
    "orphan = int(started.communicate()[0])\n"
    "print(before.pid, orphan, flush=True)\n"
    "command.leave(7)\n"
)


@linux
def test_the_command_ends_what_its_children_have_left():
    """An orphan in a session of its own is killed and waited for; a child from before is none of the command's."""
    done = subprocess.run([sys.executable, "-c", COMMAND], stdout=subprocess.PIPE, text=True, check=False)
    assert done.returncode == 7
    before, orphan = map(int, done.stdout.split())
    with pytest.raises(ProcessLookupError):
        os.kill(orphan, 0)
    os.kill(before, 9)


LEAVING = (
    "import os, sys\n"
    "from pvlvrt_compliance.controllers.process import command\n"
    "command.become_the_command()\n"
    "to_send = [int(sys.argv[1])]\n"
    "command.at_end(lambda: to_send and os.kill(os.getpid(), to_send.pop()))\n"
    "command.leave(7)\n"
)


@pytest.mark.skipif(os.name == "nt", reason="Windows cannot send a signal to one process")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=["INT", "TERM"])
def test_a_signal_at_the_end_changes_no_status(number):
    """When all is written and only what was started is still to be ended, the verdict stands."""
    done = subprocess.run([sys.executable, "-c", LEAVING, str(int(number))], capture_output=True, check=False)
    assert (done.returncode, done.stderr) == (7, b"")


LIBRARY = (
    "import ctypes, signal, sys\n"
    "before = [signal.getsignal(n) for n in (signal.SIGINT, signal.SIGTERM)]\n"
    "from pvlvrt_compliance.cli.main import run\n"
    "from pvlvrt_compliance.controllers.simulator import ForeignSimulator\n"
    "ForeignSimulator(sys.argv[1])\n"
    "run(['--version'])\n"
    "adopts = ctypes.c_int()\n"
    "ctypes.CDLL(None).prctl(37, ctypes.byref(adopts), 0, 0, 0)\n"
    "assert adopts.value == 0\n"
    "assert before == [signal.getsignal(n) for n in (signal.SIGINT, signal.SIGTERM)]\n"
)


@linux
@pytest.mark.slow
def test_a_library_adopts_nobody_and_leaves_signals_alone():
    """Signals and orphans are the business of the program that uses the package."""
    spec = f"{Path(__file__).parents[1] / 'misbehaving.py'}:Controller"
    subprocess.run([sys.executable, "-c", LIBRARY, spec], check=True, stdout=subprocess.DEVNULL)


@pytest.mark.skipif(os.name == "nt", reason="Windows has no signals that are ignored from the start")
def test_a_signal_that_is_ignored_stays_ignored():
    """`nohup` and a shell's `&` mean it."""
    code = (
        "import signal\n"
        "from pvlvrt_compliance.controllers.process.command import become_the_command\n"
        "signal.signal(signal.SIGINT, signal.SIG_IGN)\n"
        "become_the_command()\n"
        "assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN\n"
        "assert signal.getsignal(signal.SIGTERM) is not signal.SIG_DFL\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
