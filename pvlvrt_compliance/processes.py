"""Copies of a process, groups, signals, orphans.

The one module that knows of `fork`, process groups, `prctl` and `/proc`. It can be imported anywhere; what a system
lacks is left out there, as each function says.
"""

import atexit
import os
import select
import signal
import sys
import threading
import time
import traceback
from collections.abc import Callable, Collection
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple, NoReturn

FORKS = sys.platform == "linux"
"""Whether a process can make a copy of itself safely, and see when that ends."""

_PATIENCE_S = 1.0  # with what has been told to end
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


def _reap(process: Process, until: float) -> None:
    """Wait for the end of a killed process; where it is a child of this one, of that child alone."""
    with suppress(OSError):
        handle = os.pidfd_open(process.pid)
        try:
            select.select([handle], [], [], max(until - time.monotonic(), 0.0))
        finally:
            os.close(handle)
        os.waitpid(process.pid, os.WNOHANG)


class Stopped(BaseException):
    """A signal has asked this process to end: SIGINT, or SIGTERM, which a CI service, `timeout` and docker send.

    No `KeyboardInterrupt`, of which libraries make what they like.
    """

    def __init__(self, number: int = signal.SIGINT) -> None:
        super().__init__(number)
        self.number = number


STOPS = (KeyboardInterrupt, Stopped)
"""Ways in which a command is ended early."""


def status_of(end: BaseException) -> int:
    """Exit status of a command that was ended early: 130, by SIGTERM 143."""
    return 128 + (end.number if isinstance(end, Stopped) else signal.SIGINT)


def words_of(end: BaseException) -> str:
    """What has ended a command early."""
    return "interrupted" if status_of(end) == 128 + signal.SIGINT else "terminated (SIGTERM)"


class _Command:
    """The process as the command that a person or a CI service has started, once `become_the_command` says so."""

    def __init__(self) -> None:
        self.is_command = False
        self.signals = 0  # seen so far
        self.spared: list[Process] | None = None  # children from before this process adopts orphans
        self.ends: list[Callable[[], None]] = []

    def on_signal(self, number: int, _frame: Any) -> None:
        """End the run by an exception; the second signal finds that at work already, the third ends at once."""
        self.signals += 1
        if self.signals == 1:
            raise Stopped(number)
        if self.signals > 2:
            os._exit(128 + number)

    def end_family(self) -> None:
        """Kill what is left of what was started, one by one, until nothing is."""
        until = time.monotonic() + _PATIENCE_S
        while self.spared is not None and (family := descendants(os.getpid(), self.spared)):
            for process in family:
                kill(process)
            for process in family:
                _reap(process, until)
            if time.monotonic() > until:
                return


_command = _Command()


def become_the_command() -> None:
    """Take SIGTERM like SIGINT, as an exception in the main thread, and adopt what controllers leave behind.

    For the command alone: in a library these are the business of the program that uses it. A signal that the process
    was started to ignore stays ignored.
    """
    _command.is_command = True
    for number in (signal.SIGINT, signal.SIGTERM):
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _command.on_signal)


def before_children() -> None:
    """Make the command the parent of whatever processes its children leave behind (Linux), before it has children."""
    if not _command.is_command or not FORKS or _command.spared is not None:
        return
    import ctypes

    if ctypes.CDLL(None).prctl(_BECOME_SUBREAPER, 1, 0, 0, 0) == 0:
        _command.spared = descendants(os.getpid())


def at_end(function: Callable[[], None]) -> None:
    """Have a function called when this process ends, in `leave` or else by itself."""
    _command.ends.append(function)
    atexit.register(function)


def leave(status: int) -> NoReturn:
    """End the command, whatever its threads are at: a controller may hang, and compiled code hears no signal.

    From here on a first signal asks for what is done already, and changes no status.
    """
    _command.signals = max(_command.signals, 1)
    for function in reversed(_command.ends):
        with suppress(Exception):
            function()
    _command.end_family()
    others = [thread for thread in threading.enumerate() if thread is not threading.current_thread()]
    if all(thread.daemon for thread in others):
        sys.exit(status)
    for stream in (sys.stdout, sys.stderr):
        with suppress(Exception):
            stream.flush()
    os._exit(status)
