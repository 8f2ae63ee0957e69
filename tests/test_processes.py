"""What was started is found and ended one by one; and what one system has alone keeps the package from no other."""

import ast
import os
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest

import pvlvrt_compliance
from pvlvrt_compliance import processes

PACKAGE = Path(pvlvrt_compliance.__file__).parent

# What Windows has not, or macOS, by module, and the one module that may use it.
OWNERS = {"fcntl": "locks", "msvcrt": "locks", "pwd": None, "grp": None, "resource": None, "termios": None}
ATTRIBUTES = {
    **dict.fromkeys(("os.geteuid", "os.getuid", "os.O_NOFOLLOW"), "locks"),
    **dict.fromkeys(("os.fork", "os.forkpty", "os.killpg", "os.setpgid", "os.getpgid", "os.setsid"), "processes"),
    **dict.fromkeys(("os.waitpid", "os.WNOHANG", "os.pidfd_open", "os.waitstatus_to_exitcode"), "processes"),
    **dict.fromkeys(("signal.SIGKILL", "signal.SIGHUP", "signal.pidfd_send_signal", "signal.setitimer"), "processes"),
}
MODULES = [path for path in sorted(PACKAGE.rglob("*.py")) if "templates" not in path.parts]


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.relative_to(PACKAGE).as_posix())
def test_one_module_knows_what_one_system_has(path):
    """Calls that not every system has stand in `processes` and `locks`."""
    tree = ast.parse(path.read_text("utf-8"))
    for node in ast.walk(tree):
        names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        for name in names:
            assert OWNERS.get(name, path.stem) == path.stem
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            name = f"{node.value.id}.{node.attr}"
            assert ATTRIBUTES.get(name, path.stem) == path.stem


def test_the_package_is_imported_without_them():
    """Every module is imported where none of these is there."""
    code = (
        "import importlib, os, signal, sys\n"
        "import numba, scipy.special, pydantic, rich.progress, typer, jinja2, platformdirs, subprocess, tempfile\n"
        f"for name in {sorted(ATTRIBUTES)!r}:\n"
        "    module, _, attribute = name.partition('.')\n"
        "    if hasattr(sys.modules[module], attribute): delattr(sys.modules[module], attribute)\n"
        f"for name in {sorted(OWNERS)!r}: sys.modules[name] = None\n"
        f"for name in {[_dotted(path) for path in MODULES]!r}: importlib.import_module(name)\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def _dotted(path):
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


linux = pytest.mark.skipif(not processes.FORKS, reason="only Linux shows the processes of a process")

FAMILY = (
    "import subprocess, sys\n"
    "child = subprocess.Popen(['setsid', 'sleep', '600'], stdout=subprocess.DEVNULL)\n"
    "print(child.pid, flush=True)\n"
    "sys.stdin.read()\n"
)


@pytest.fixture
def family():
    """A process, and its child that is in a session of its own."""
    process = subprocess.Popen([sys.executable, "-c", FAMILY], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    child = int(process.stdout.readline())
    yield process, child
    with suppress(ProcessLookupError):
        os.kill(child, 9)
    process.kill()
    process.communicate()


@linux
def test_family_is_found(family):
    """Children of children too; those that are spared are left out with theirs."""
    process, child = family
    found = [p.pid for p in processes.descendants(os.getpid())]
    assert found.index(process.pid) < found.index(child)
    spared = next(p for p in processes.descendants(os.getpid()) if p.pid == process.pid)
    assert not {process.pid, child} & {p.pid for p in processes.descendants(os.getpid(), [spared])}


@linux
def test_only_the_same_process_is_killed(family):
    """A process that has the id of one that is gone is left alone."""
    process, child = family
    (found,) = (p for p in processes.descendants(process.pid) if p.pid == child)
    processes.kill(found._replace(started="1"))
    assert found in processes.descendants(process.pid)
    handle = os.pidfd_open(child)
    processes.kill(found)
    processes.select.select([handle], [], [])
    os.close(handle)


COMMAND = (
    "import os, subprocess, sys\n"
    "from pvlvrt_compliance import processes\n"
    "before = subprocess.Popen(['sleep', '600'], stdout=subprocess.DEVNULL)\n"
    "processes.become_the_command()\n"
    "processes.before_children()\n"
    "started = subprocess.Popen([sys.executable, '-c', 'import subprocess; "
    'print(subprocess.Popen(["setsid", "sleep", "600"], stdout=2).pid)\'], stdout=subprocess.PIPE, text=True)\n'
    "orphan = int(started.communicate()[0])\n"
    "print(before.pid, orphan, flush=True)\n"
    "processes.leave(7)\n"
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
    "from pvlvrt_compliance import processes\n"
    "processes.become_the_command()\n"
    "to_send = [int(sys.argv[1])]\n"
    "processes.at_end(lambda: to_send and os.kill(os.getpid(), to_send.pop()))\n"
    "processes.leave(7)\n"
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
    "from pvlvrt_compliance.simulation.foreign_simulate import ForeignSimulator\n"
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
    spec = f"{Path(__file__).parent / 'simulation' / 'doors' / 'misbehaving.py'}:Controller"
    subprocess.run([sys.executable, "-c", LIBRARY, spec], check=True, stdout=subprocess.DEVNULL)


@pytest.mark.skipif(os.name == "nt", reason="Windows has no signals that are ignored from the start")
def test_a_signal_that_is_ignored_stays_ignored():
    """`nohup` and a shell's `&` mean it."""
    code = (
        "import signal\n"
        "from pvlvrt_compliance.processes import become_the_command\n"
        "signal.signal(signal.SIGINT, signal.SIG_IGN)\n"
        "become_the_command()\n"
        "assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN\n"
        "assert signal.getsignal(signal.SIGTERM) is not signal.SIG_DFL\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
