"""A process of its own for a controller from outside and the loop that runs it.

A server process imports everything once; for every job it makes a copy of itself (a fork, where the system has that
and it is safe: Linux), elsewhere it does one job and ends. What goes to and fro lies in a folder of the job's own, so
that the simulated time reached and what the controller has printed are there whatever ends the process.
"""

import json
import pickle
import queue
import subprocess
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from pvlvrt_compliance.controllers.process import command, family
from pvlvrt_compliance.controllers.process.child import end, killed_by, start
from pvlvrt_compliance.controllers.process.family import FORKS
from pvlvrt_compliance.controllers.process.scratch import clear_abandoned, job_folder
from pvlvrt_compliance.errors import OutputError, PvlvrtError
from pvlvrt_compliance.simulation.door.exchange import LATEST_CALL, PROGRESSES, TRIP_SEEN

JOB, ANSWER, SAID, PROGRESS, RECORD = "job.pickle", "answer.json", "said.txt", "progress.bin", "record.npy"
"""Files in the folder of a job."""

_SAID_LINES, _SAID_CHARACTERS = 8, 800


class Ended(NamedTuple):
    """How a job has ended."""

    answer: dict[str, Any] | None  # what it gave; None when the process ended without
    reason: str  # why there is no answer
    progress_s: float | None  # simulated time when it ended (s); None before the run
    tripped_s: float | None  # simulated time when the controller first was to be called after a trip (s); None: never
    said: str  # the end of what was printed meanwhile


class LostServerError(PvlvrtError):
    """The process for a user's controller cannot be started."""


class Server:
    """Process that does jobs, started when first needed."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[str] | None = None
        self._busy = threading.Lock()  # one job at a time, whatever threads ask for one
        self._lines: queue.Queue[str | None] = queue.Queue()

    def do(self, job: Any, folder: Path, limit_s: float) -> Ended:
        """Do a job (an object that can be pickled) in a folder that is empty, for so long (s) at most."""
        with self._busy:
            return self._do(job, folder, limit_s)

    def _do(self, job: Any, folder: Path, limit_s: float) -> Ended:
        try:
            (folder / JOB).write_bytes(pickle.dumps(job))
            (folder / PROGRESS).write_bytes(np.full(PROGRESSES, np.nan).tobytes())
            (folder / SAID).touch()
        except OSError as error:
            raise OutputError(f"{folder} cannot be written: {error.strerror or error}") from None
        try:
            reason = self._await(folder, limit_s)
        except BaseException:
            self.end()  # whatever runs in it has no reader any more
            raise
        answer = folder / ANSWER
        progress = [None if np.isnan(x) else float(x) for x in np.fromfile(folder / PROGRESS)]
        return Ended(
            answer=json.loads(answer.read_text("utf-8")) if answer.is_file() else None,
            reason=reason,
            progress_s=progress[LATEST_CALL],
            tripped_s=progress[TRIP_SEEN],
            said=_tail_of(folder / SAID),
        )

    def end(self) -> None:
        """End the process, whatever job it has, and whatever that has started."""
        process, self._process = self._process, None
        if process is None:
            return
        end(process, listens=FORKS)  # a server that forks ends its job and itself with its input

    def _await(self, folder: Path, limit_s: float) -> str:
        """Have a job done; why it ended, in words."""
        process = self._ready()
        assert process.stdin is not None
        process.stdin.write(f"{folder}\n")
        process.stdin.flush()
        pid = int(self._line(None).removeprefix("started "))
        try:
            status = int(self._line(limit_s).removeprefix("ended "))
        except queue.Empty:
            self._kill(pid)
            return f"the controller was stopped after {limit_s:g} s of computing (simulation.time_limit_s)"
        except LostServerError:
            if FORKS:
                raise
            status = process.wait()
            self._process = None
        return _in_words(status)

    def _kill(self, pid: int) -> None:
        if FORKS:
            family.kill_group(pid)
            self._line(None)
        else:
            self.end()

    def _ready(self) -> "subprocess.Popen[str]":
        if self._process is not None and self._process.poll() is None:
            return self._process
        self._process = self._start()
        if self._line(None) != "ready":
            raise LostServerError("the process for the controller did not start")
        return self._process

    def _start(self) -> "subprocess.Popen[str]":
        clear_abandoned()
        process: subprocess.Popen[str] = start(
            "pvlvrt_compliance.controllers.process.worker", encoding="utf-8", errors="surrogateescape"
        )
        self._lines = queue.Queue()
        threading.Thread(target=_read, args=(process, self._lines), daemon=True).start()
        command.at_end(self.end)
        return process

    def _line(self, limit_s: float | None) -> str:
        line = self._lines.get(timeout=limit_s)
        if line is None:
            raise LostServerError("the process for the controller has ended")
        return line


def _read(process: "subprocess.Popen[str]", lines: "queue.Queue[str | None]") -> None:
    assert process.stdout is not None
    for line in process.stdout:
        lines.put(line.rstrip("\n"))
    process.stdout.close()
    lines.put(None)


def _in_words(status: int) -> str:
    killer = killed_by(status)
    return f"the controller crashed ({killer})" if killer else f"the controller ended the process (status {status})"


def _tail_of(file: Path) -> str:
    with file.open("rb") as stream:
        stream.seek(max(file.stat().st_size - 4 * _SAID_CHARACTERS, 0))
        text = stream.read().decode("utf-8", "replace")
    lines = "".join(c if c.isprintable() or c == "\n" else "?" for c in text).strip().splitlines()
    return "\n".join(lines[-_SAID_LINES:])[-_SAID_CHARACTERS:]


_server = Server()


def stop_apart() -> None:
    """End the server's process, and with it the job that it does; the next job has another."""
    _server.end()


def do_apart(job: Any, limit_s: float, keep: Sequence[str] = ()) -> tuple[Ended, dict[str, Any]]:
    """Do a job in the server's process; arrays by name that it has left are read before its folder is removed.

    Raises
    ------
    OutputError
        When the system's temporary folder cannot be written.
    """
    with job_folder() as folder:
        ended = _server.do(job, folder, limit_s)
        files = {name: folder / name for name in keep}
        return ended, {name: np.load(file) for name, file in files.items() if file.is_file()}
