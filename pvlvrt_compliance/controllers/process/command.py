"""The process as the command that somebody has started: signals that ask it to end, and how it ends.

In a library all of this is the business of the program that uses it; only `become_the_command` changes anything.
"""

import atexit
import os
import signal
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from typing import Any, NoReturn

from pvlvrt_compliance.controllers.process.family import Process, adopt_orphans, descendants, end_descendants
from pvlvrt_compliance.errors import Stopped

_PATIENCE_S = 1.0  # with what has been told to end


def status_of(end: BaseException) -> int:
    """Exit status of a command that was ended early: 130, by SIGTERM 143."""
    return 128 + (end.number if isinstance(end, Stopped) else signal.SIGINT)


def words_of(end: BaseException) -> str:
    """What has ended a command early."""
    return "interrupted" if status_of(end) == 128 + signal.SIGINT else "terminated (SIGTERM)"


class _Command:
    """The process as the command that a person or a CI service has started, once `become_the_command` says so.

    Or as what runs a user's controller for one, once `become_the_server` does.
    """

    def __init__(self) -> None:
        self.is_command = False
        self.is_server = False
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
        if self.spared is not None:
            end_descendants(self.spared, _PATIENCE_S)


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


def become_the_server() -> None:
    """Say that this process is the one of a user's controller: what runs there must not begin a run of its own."""
    _command.is_server = True


def is_the_server() -> bool:
    """Whether this process is the one of a user's controller, or a copy of it."""
    return _command.is_server


def before_children() -> None:
    """Make the command the parent of whatever processes its children leave behind (Linux), before it has children."""
    if _command.is_command and _command.spared is None and adopt_orphans():
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
