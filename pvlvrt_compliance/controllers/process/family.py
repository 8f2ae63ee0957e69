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
_PAGE = os.sysconf("SC_PAGE_SIZE") if FORKS else 4096  # bytes
_BECOME_SUBREAPER = 36  # PR_SET_CHILD_SUBREAPER
_SIGNAL_AT_PARENTS_END = 1  # PR_SET_PDEATHSIG


CALLED_OFF = "nobody waits for it any more"
"""Why a copy is ended when there is something to read from its other side."""


class CopyEnd(NamedTuple):
    """How a copy has ended."""

    status: int  # its exit status; that of a signal is below zero
    why: str  # what was seen of it for which it was ended; empty: nothing was
    peak_bytes: int  # of memory that it had at once


def in_a_copy(
    work: Callable[[], None], begun: Callable[[int], None], other_side: int, look: Callable[[], tuple[str, float]]
) -> CopyEnd:
    """Do work in a copy of this process, the leader of a group that ends with it; how it has ended (Linux).

    The copy ends early when there is something to read from the descriptor ``other_side``, or its other end is closed;
    and with this process. ``begun`` is called with its id, ``look`` again and again as long as it lives: it gives a
    reason for which the copy is to be ended now, or nothing, and how long to wait (s) before it looks again.
    """
    parent = os.getpid()
    pid = os.fork()
    if pid == 0:
        os.setpgid(0, 0)
        _end_with(parent)
        _work_and_exit(work)
    with suppress(OSError):  # the copy does the same, whoever comes first: before anybody is told of it, it is a group
        os.setpgid(pid, pid)
    begun(pid)
    ended = os.pidfd_open(pid)
    try:
        why = _until_it_ends(ended, other_side, look)
        kill_group(pid)  # what it has started ends with it
        _, status, usage = os.wait4(pid, 0)
    finally:
        os.close(ended)
        kill_group(pid)
    return CopyEnd(os.waitstatus_to_exitcode(status), why, usage.ru_maxrss * 1024)


def _until_it_ends(ended: int, other_side: int, look: Callable[[], tuple[str, float]]) -> str:
    """Look after a copy until it ends; why it has to, if it has."""
    wait_s = 0.0
    while True:
        found, _, _ = select.select([ended, other_side], [], [], wait_s)
        if found:
            return "" if ended in found else CALLED_OFF
        why, wait_s = look()
        if why:
            return why


def _end_with(parent: int) -> None:
    """Have this process killed when its parent ends (Linux)."""
    import ctypes

    ctypes.CDLL(None).prctl(_SIGNAL_AT_PARENTS_END, signal.SIGKILL, 0, 0, 0)
    if os.getppid() != parent:  # it has ended already
        os._exit(1)


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


class Seen(NamedTuple):
    """What there is to see of a process."""

    process: Process
    parent: int
    state: str  # a letter of `/proc/PID/stat`: R, S, D, Z (has ended), T (is stopped)
    memory: int  # bytes, those included that it shares with others


def descendants(pid: int, spared: Collection[Process] = ()) -> list[Process]:
    """A process's children and all of theirs, but for the spared ones and theirs, parents first (Linux; else none)."""
    return [seen.process for seen in tree(pid, spared)]


def tree(pid: int, spared: Collection[Process] = ()) -> list[Seen]:
    """What there is to see of the descendants of a process (Linux; else nothing)."""
    children: dict[int, list[Seen]] = {}
    for name in os.listdir(_PROC) if FORKS and _PROC.is_dir() else ():  # noqa: PTH208 - thousands of times in a run
        if name.isdecimal() and (seen := _seen(int(name))):
            children.setdefault(seen.parent, []).append(seen)
    found = [child for child in children.get(pid, []) if child.process not in spared]
    for seen in found:
        found += [child for child in children.get(seen.process.pid, []) if child.process not in spared]
    return found


def memory_of(pid: int) -> int | None:
    """Memory of a process (bytes), what it shares with others by its part; None where that is not known (Linux)."""
    try:
        for line in (_PROC / str(pid) / "smaps_rollup").read_text("ascii", "replace").splitlines():
            if line.startswith("Pss:"):
                return int(line.split()[1]) * 1024
    except (OSError, ValueError, IndexError):
        pass
    return None


def is_stopped(pid: int) -> bool:
    """Whether a process has been stopped, so that it does nothing until somebody has it go on (Linux; else never)."""
    return FORKS and _fields_of(pid)[:1] == ["T"]


def end_descendants(spared: Collection[Process] = (), patience_s: float = 1.0) -> None:
    """Kill what this process has started and what that has, one by one, until nothing is left or patience ends."""
    until = time.monotonic() + patience_s
    while family := descendants(os.getpid(), spared):
        for process in family:
            kill(process)
        for process in family:
            reap(process, until)
        if time.monotonic() > until:
            return


def bury(pid: int) -> None:
    """Take note of the end of a child that has ended, so that nothing is left of it (Linux)."""
    with suppress(OSError):
        os.waitpid(pid, os.WNOHANG)


def _seen(pid: int) -> Seen | None:
    fields = _fields_of(pid)
    if not fields:
        return None
    return Seen(Process(pid, fields[19]), int(fields[1]), fields[0], int(fields[21]) * _PAGE)


def _fields_of(pid: int) -> list[str]:
    """Fields of `/proc/PID/stat` from the third, the state, on; nothing when the process is gone."""
    try:
        # The name before them stands in brackets and may hold anything.
        with open(f"{_PROC}/{pid}/stat", "rb") as file:  # noqa: PTH123 - as above
            return file.read().decode("utf-8", "replace").rpartition(")")[2].split()
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
