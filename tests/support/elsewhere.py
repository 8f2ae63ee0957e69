"""Processes that believe they run on another system, where what this one has alone is missing.

A folder with a ``sitecustomize`` is put before all others: as soon as such a process imports the package, what other
programs need of the system is imported, and the rest of it is taken away. Processes that it starts are the same.
"""

import os
import subprocess
import sys
from pathlib import Path

from waiting import PATIENCE_S

LINUX_ALONE = (
    *("os.pidfd_open", "os.sched_getaffinity", "signal.pidfd_send_signal", "select.epoll"),
    *("os.eventfd", "os.memfd_create", "os.prlimit"),
)
POSIX_ALONE = (
    *("os.fork", "os.forkpty", "os.killpg", "os.setpgid", "os.getpgid", "os.setpgrp", "os.getpgrp", "os.setsid"),
    *("os.getsid", "os.waitid", "os.wait", "os.wait3", "os.wait4", "os.WNOHANG", "os.getuid", "os.geteuid"),
    *("os.getgid", "os.getegid", "os.O_NOFOLLOW", "os.nice", "os.uname", "os.getloadavg", "os.chown", "os.lchown"),
    *("os.mkfifo", "os.fchown", "os.statvfs", "os.sync", "os.ctermid", "os.openpty"),
    *("signal.SIGKILL", "signal.SIGHUP", "signal.SIGALRM", "signal.SIGCHLD", "signal.SIGUSR1", "signal.SIGUSR2"),
    *("signal.SIGPIPE", "signal.SIGQUIT", "signal.SIGSTOP", "signal.SIGCONT", "signal.pthread_kill"),
    *("signal.pthread_sigmask", "signal.setitimer", "signal.alarm", "signal.sigwait", "signal.pause"),
    *("select.poll", "time.clock_gettime", "socket.AF_UNIX"),
)
POSIX_MODULES = ("fcntl", "pwd", "grp", "resource", "termios", "tty", "pty", "syslog", "posix")

MISSING = {"win32": (*LINUX_ALONE, *POSIX_ALONE), "darwin": LINUX_ALONE}
"""By system, what of the modules that every system has is missing there."""

MISSING_MODULES = {"win32": POSIX_MODULES, "darwin": ()}

_HOOK = """
import sys

class _Move:
    # To another system, as soon as the package is imported.

    def find_spec(self, name, path=None, target=None):
        if name != "pvlvrt_compliance":
            return None
        sys.meta_path.remove(self)
        # Others ask for these of the system themselves, and know where they are not there.
        import asyncio, concurrent.futures, ctypes.util, importlib.metadata, multiprocessing, os, queue, select, shutil
        import signal, socket, sqlite3, subprocess, tempfile, time, uuid, zipfile
        import jinja2, numba, numba.core.typed_passes, platformdirs, pydantic, scipy.special, typer, typer.testing
        import rich.console, rich.progress, rich.table
        if {platform!r} == "win32":
            _as_on_windows()
        for full in {attributes!r}:
            module, _, attribute = full.partition(".")
            if hasattr(sys.modules[module], attribute):
                delattr(sys.modules[module], attribute)
        for module in {modules!r}:
            sys.modules[module] = None
        sys.platform = {platform!r}
        return None


def _as_on_windows():
    # What Windows has in place of it, made of what there is here.
    import fcntl, os, subprocess, types

    def locking(descriptor, mode, count):
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)

    sys.modules["msvcrt"] = types.SimpleNamespace(locking=locking, LK_NBLCK=2)
    subprocess.Popen.kill = subprocess.Popen.terminate = lambda process: os.kill(process.pid, 9)


sys.meta_path.insert(0, _Move())
"""


def on(platform: str, folder: Path) -> dict[str, str]:
    """Environment of processes that believe they run on this system; an empty folder is filled for them."""
    hook = _HOOK.format(attributes=MISSING[platform], modules=MISSING_MODULES[platform], platform=platform)
    (folder / "sitecustomize.py").write_text(hook, "utf-8")
    path = os.pathsep.join(filter(None, [str(folder), os.environ.get("PYTHONPATH")]))
    return os.environ | {"PYTHONPATH": path, "NO_COLOR": "1"}


def run(environment: dict[str, str], *arguments: object, cwd: Path | None = None) -> "subprocess.CompletedProcess[str]":
    """Run Python with these arguments in such an environment."""
    command = [sys.executable, *map(str, arguments)]
    return subprocess.run(
        command, env=environment, cwd=cwd, capture_output=True, text=True, check=False, timeout=PATIENCE_S
    )
