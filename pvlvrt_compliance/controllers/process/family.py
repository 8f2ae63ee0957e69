"""Copies of a process, groups, orphans: what a process has started, and how that is ended.

The one module that knows of `fork`, process groups, `prctl` and `/proc`. It can be imported anywhere; what a system
lacks is left out there, as each function says.
"""
# mypy: disable-error-code="attr-defined"
# What one system has alone is used in this file alone: mypy --platform win32 and darwin find nothing in all others.

import os
import select
import signal
import sys
import time
import traceback
from collections.abc import Callable, Collection
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple, NoReturn

FORKS = sys.platform == "linux"
"""Whether a process can make a copy of itself safely, and see when that ends."""

_PROC = Path("/proc")
_BECOME_SUBREAPER = 36  # PR_SET_CHILD_SUBREAPER


def in_a_copy(work: Callable[[], None], begun: Callable[[int], None], other_side: int) -> int:
    """Do work in a copy of this process, the leader of a group that ends with it; its exit status (Linux).

    The copy ends early when there is something to read from the descriptor ``other_side``, or its other end is closed.
    ``begun`` is called with its id.
    """
    pid = os.fork()
    if pid == 0:
        os.setpgid(0, 0)
        _work_and_exit(work)
    with suppress(OSError):  # the copy does the same, whoever comes first: before anybody is told of it, it is a group
        os.setpgid(pid, pid)
    begun(pid)
    ended = os.pidfd_open(pid)
    try:
        found, _, _ = select.select([ended, other_side], [], [])
        if ended not in found:
            kill_group(pid)
        _, status = os.waitpid(pid, 0)
    finally:
        os.close(ended)
        kill_group(pid)  # what it has started ends with it
    return os.waitstatus_to_exitcode(status)


def _work_and_exit(work: Callable[[], None]) -> NoReturn:
    """Work and end, whatever happens: a copy must never come back to what the first was about."""
    try:
        work()
    except BaseException:
        traceback.print_exc()
        sys.stderr.flush()
        os._exit(1)
    os._exit(0)


def kill_group(pid: int) -> None:
    """Kill a group of processes by its leader, who may have ended already (POSIX)."""
    if hasattr(os, "killpg"):
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(pid, signal.SIGKILL)


class Process(NamedTuple):
    """A process, told from a later one of the same id."""

    pid: int
    started: str  # ticks since the system's start


def descendants(pid: int, spared: Collection[Process] = ()) -> list[Process]:
    """A process's children and all of theirs, but for the spared ones and theirs, parents first (Linux; else none)."""
    children: dict[int, list[Process]] = {}
    for folder in _PROC.iterdir() if FORKS and _PROC.is_dir() else ():
        if folder.name.isdecimal() and (fields := _fields_of(int(folder.name))):
            children.setdefault(int(fields[1]), []).append(Process(int(folder.name), fields[19]))
    found = [child for child in children.get(pid, []) if child not in spared]
    for process in found:
        found += [child for child in children.get(process.pid, []) if child not in spared]
    return found


def _fields_of(pid: int) -> list[str]:
    """Fields of `/proc/PID/stat` from the third, the state, on; nothing when the process is gone."""
    try:
        # The name before them stands in brackets and may hold anything.
        return (_PROC / str(pid) / "stat").read_text("utf-8", "replace").rpartition(")")[2].split()
    except OSError:
        return []


def kill(process: Process) -> None:
    """Kill a process that `descendants` has found, if it is still the same (Linux)."""
    with suppress(OSError):
        handle = os.pidfd_open(process.pid)
        try:
            if _fields_of(process.pid)[19:20] == [process.started]:
                signal.pidfd_send_signal(handle, signal.SIGKILL)
        finally:
            os.close(handle)


def reap(process: Process, until: float) -> None:
    """Wait for the end of a killed process, until an instant (s) at most; of children, for that one alone (Linux)."""
    with suppress(OSError):
        handle = os.pidfd_open(process.pid)
        try:
            select.select([handle], [], [], max(until - time.monotonic(), 0.0))
        finally:
            os.close(handle)
        os.waitpid(process.pid, os.WNOHANG)


def adopt_orphans() -> bool:
    """Make this process the parent of whatever its children leave behind; whether it is now (Linux)."""
    if not FORKS:
        return False
    import ctypes

    return bool(ctypes.CDLL(None).prctl(_BECOME_SUBREAPER, 1, 0, 0, 0) == 0)
