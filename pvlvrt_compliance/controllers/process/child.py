"""Python processes of ours at the other end of pipes, which end with the process that has started them."""

import os
import signal
import subprocess
import sys
import threading
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from typing import IO, Any

from pvlvrt_compliance.compiled.notes import tell_in_lines
from pvlvrt_compliance.controllers.process import command, family

_PATIENCE_S = 0.5  # with a process that is to end
_SAID_LINES = 8


def start(module: str, **streams: Any) -> "subprocess.Popen[Any]":
    """Start a process that calls ``main()`` of a module, with pipes as its input and output.

    Nothing of the program that runs here is imported there, as `multiprocessing` would its main module: that may be
    anybody's script.

    Parameters
    ----------
    module : str
        Dotted name.
    **streams
        Further arguments of `subprocess.Popen`.
    """
    command.before_children()
    code = f"import sys; sys.path[:] = {sys.path!r}; from {module} import main; main()"
    return subprocess.Popen(
        [sys.executable, "-c", code],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        start_new_session=True,  # Ctrl-C goes to the command alone, which then ends this process
        **streams,
    )


def let_go(process: "subprocess.Popen[Any]") -> None:
    """Close the input of a process."""
    if process.stdin is not None:
        with suppress(OSError):  # it has gone, and what was still to be written with it
            process.stdin.close()


def end(process: "subprocess.Popen[Any]", *, listens: bool) -> None:
    """End a process, and whatever it has started.

    Parameters
    ----------
    process : subprocess.Popen
    listens : bool
        Whether it ends by itself, with all that it has started, once its input is closed: it is given some time then.
    """
    left = family.descendants(process.pid)
    if not listens:
        family.kill_group(process.pid)
        process.kill()
    let_go(process)
    if listens:
        with suppress(subprocess.TimeoutExpired):
            process.wait(_PATIENCE_S)
    process.kill()
    process.wait()
    for other in left:
        family.kill(other)


def killed_by(status: int) -> str:
    """Name of the signal that has killed a process, by its return code; nothing where it has ended by itself."""
    if status >= 0:
        return ""
    try:
        return signal.Signals(-status).name
    except ValueError:
        return str(-status)


def own_pipes() -> tuple[int, int]:
    """In such a process: descriptors that it is told by and answers to; what is printed from here on is no answer.

    What there is to say of compiled code comes as lines of the command (stderr).
    """
    told, answers = os.dup(0), os.dup(1)
    nothing = os.open(os.devnull, os.O_RDWR)
    os.dup2(nothing, 0)
    os.dup2(2, 1)
    os.close(nothing)
    tell_in_lines()
    return told, answers


class Echo:
    """What processes print on stderr, repeated on that of this process in whole lines.

    A line is repeated once however many of them print it: what there is to say of a machine all of them say.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._repeated: set[str] = set()

    def of(self, stream: IO[bytes]) -> Callable[[], str]:
        """Repeat a stream from now on; what gives its last lines."""
        last: deque[str] = deque(maxlen=_SAID_LINES)

        def repeat() -> None:
            with stream:
                for data in stream:
                    line = data.decode("utf-8", "replace").rstrip()
                    last.append(line)
                    self._repeat(line)

        thread = threading.Thread(target=repeat, daemon=True)
        thread.start()

        def said() -> str:
            thread.join(_PATIENCE_S)  # a process of a process may hold the other end
            return "\n".join(last).strip()

        return said

    def _repeat(self, line: str) -> None:
        with self._lock:
            if line in self._repeated:
                return
            self._repeated.add(line)
            with suppress(OSError, ValueError, AttributeError):  # nobody reads it, or there is no such stream
                sys.stderr.write(f"{line}\n")
                sys.stderr.flush()
