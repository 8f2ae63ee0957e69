"""A process of its own for a controller from outside and the loop that runs it.

A server process imports everything once; for every job it makes a copy of itself (a fork, where the system has that
and it is safe: Linux), elsewhere it does one job and ends. What goes to and fro lies in a folder of the job's own, so
that the simulated time reached and what the controller has printed are there whatever ends the process.

Whatever comes from there is data of somebody else: `answer` reads what the job gives, `lines` what the server says. The
server holds the job to its limits (`watch`). Here they count once more, a little later, as it may be stopped or killed.
"""

import json
import os
import pickle
import queue
import secrets
import subprocess
import threading
import time
from pathlib import Path
from typing import IO, Any, NamedTuple

import numpy as np

from pvlvrt_compliance.controllers.limits import MB, OUTPUT, TABLE, TIME, Limits, in_words, parameter_of
from pvlvrt_compliance.controllers.process import command, family
from pvlvrt_compliance.controllers.process.answer import Answer, BadAnswerError, Due, read_answer
from pvlvrt_compliance.controllers.process.child import end, killed_by, start
from pvlvrt_compliance.controllers.process.family import FORKS
from pvlvrt_compliance.controllers.process.lines import WRITTEN_BY_OTHERS, Lines, NonsenseError, SilenceError
from pvlvrt_compliance.controllers.process.scratch import clear_abandoned, job_folder
from pvlvrt_compliance.errors import OutputError, PvlvrtError
from pvlvrt_compliance.simulation.door.exchange import LATEST_CALL, PROGRESSES, TRIP_SEEN
from pvlvrt_compliance.texts import printable

JOB, SAID, PROGRESS = "job.pickle", "said.txt", "progress.bin"
"""Files in the folder of a job, beside those of its answer."""

_SAID_LINES, _SAID_CHARACTERS = 8, 800
_LATER_S = 10.0  # than its limit: then the server has not ended the job, which is its affair
_STARTING_S = 1800.0  # to be ready: on a slow machine compiling takes minutes
_LOOK_S = 0.5
_STOPPED_S = 2.0  # see `watch`


class Ended(NamedTuple):
    """How a job has ended."""

    answer: Answer | None  # what it gave; None when the process ended without, or its answer cannot be used
    reason: str  # why there is no answer
    progress_s: float | None  # simulated time when it ended (s); None before the run
    tripped_s: float | None  # simulated time when the controller first was to be called after a trip (s); None: never
    said: str  # the end of what was printed meanwhile
    limit: str = ""  # parameter of the limit that it has come to


class _End(NamedTuple):
    """How the process of a job has ended."""

    status: int | None  # None: it was ended here, or nobody knows
    reason: str  # in words
    limit: str = ""  # parameter of the limit that it has come to


_ENDED = "the process for the controller has ended"


class LostServerError(PvlvrtError):
    """The process for a user's controller cannot be started."""


class _BeyondError(SilenceError):
    """The server has said nothing until the job is beyond one of its limits."""

    def __init__(self, limit: str) -> None:
        super().__init__(limit)
        self.limit = limit


class Server:
    """Process that does jobs, started when first needed."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None
        self._busy = threading.Lock()  # one job at a time, whatever threads ask for one
        self._lines = Lines(None)

    def do(self, job: Any, folder: Path, limits: Limits, rows: int | Due | None) -> Ended:
        """Do a job (an object that can be pickled) in a folder that is empty, within its limits.

        ``rows`` are the samples of the record that it is to give; None where it gives none.
        """
        with self._busy:
            return self._do(job, folder, limits, rows)

    def _do(self, job: Any, folder: Path, limits: Limits, rows: int | Due | None) -> Ended:
        token = secrets.token_hex(8)
        try:
            (folder / JOB).write_bytes(pickle.dumps(job))
            (folder / PROGRESS).write_bytes(np.full(PROGRESSES, np.nan).tobytes())
            (folder / SAID).touch()
            said, progress = (folder / SAID).open("rb"), (folder / PROGRESS).open("rb")
        except OSError as error:
            raise OutputError(f"{folder} cannot be written: {error.strerror or error}") from None
        # Held open: whatever becomes of the folder, these are the files that were made here.
        with said, progress:
            try:
                ended = self._await(folder, token, limits, said)
            except BaseException:
                self.end()  # whatever runs in it has no reader any more
                raise
            answer, reason = _answer(folder, token, rows, ended)
            reached = _progress(progress)
            return Ended(answer, reason, reached[LATEST_CALL], reached[TRIP_SEEN], _tail_of(said), ended.limit)

    def end(self) -> None:
        """End the process, whatever job it has, and whatever that has started."""
        process, self._process = self._process, None
        if process is None:
            return
        end(process, listens=FORKS)  # a server that forks ends its job and itself with its input

    def _await(self, folder: Path, token: str, limits: Limits, said: IO[bytes]) -> _End:
        """Have a job done; how it ended."""
        process, pid = self._ready(), 0
        try:
            self._tell(process, {"job": token, "folder": str(folder), "limits": limits._asdict()})
            pid = self._hear("started", token, limits, said)["pid"]
            ended = self._hear("ended", token, limits, said)
        except (NonsenseError, SilenceError, LostServerError) as error:
            if not FORKS and isinstance(error, LostServerError):  # it ends with its job
                status, self._process = process.wait(), None
                return _End(status, _in_words(status))
            if pid and FORKS:
                family.kill_group(pid)
            self.end()
            return _of_limit(error.limit, limits) if isinstance(error, _BeyondError) else _End(None, str(error))
        if ended["why"] == family.CALLED_OFF:
            is_here = self._process is not process  # another thread has ended it
            self.end()
            return _End(None, _ENDED if is_here else WRITTEN_BY_OTHERS)
        if ended["why"] in TABLE:
            return _of_limit(ended["why"], limits)
        return _End(None, ended["why"]) if ended["why"] else _End(ended["status"], _in_words(ended["status"]))

    def _ready(self) -> "subprocess.Popen[bytes]":
        if self._process is not None and self._process.poll() is None:
            return self._process
        self._process = self._start()
        try:
            is_ready = self._lines.next("ready", None, _STARTING_S) is not None
        except (queue.Empty, NonsenseError):
            is_ready = False
        if not is_ready:
            self.end()
            raise LostServerError("the process for the controller did not start")
        return self._process

    def _start(self) -> "subprocess.Popen[bytes]":
        clear_abandoned()
        process: subprocess.Popen[bytes] = start("pvlvrt_compliance.controllers.process.worker")
        self._lines = Lines(process.stdout)
        command.at_end(self.end)
        return process

    def _tell(self, process: "subprocess.Popen[bytes]", job: Any) -> None:
        assert process.stdin is not None
        try:
            process.stdin.write(json.dumps(job).encode() + b"\n")
            process.stdin.flush()
        except OSError:
            raise LostServerError(_ENDED) from None

    def _hear(self, what: str, token: str, limits: Limits, said: IO[bytes]) -> Any:
        """What the server says next, which is to be this of this job.

        Raises
        ------
        NonsenseError
            When it says anything else.
        SilenceError
            When it says nothing in time, with the reason: the time is over, or it has been stopped.
        LostServerError
            When it has ended.
        """
        process, now = self._process, time.monotonic()
        assert process is not None
        until = now + limits.time_s + (_LATER_S if FORKS else 0.0)
        stopped_since: float | None = None
        while True:
            try:
                line = self._lines.next(what, token, _LOOK_S)
            except queue.Empty:
                pass
            else:
                if line is None:
                    raise LostServerError(_ENDED)
                return line
            now = time.monotonic()
            if now > until:
                raise _BeyondError(TIME)
            if not FORKS and os.fstat(said.fileno()).st_size > limits.output_mb * MB:
                raise _BeyondError(OUTPUT)
            stopped_since = (stopped_since or now) if family.is_stopped(process.pid) else None
            if stopped_since is not None and now - stopped_since > _STOPPED_S:
                raise SilenceError("the process for the controller was stopped (SIGSTOP)")


_server = Server()


def stop_apart() -> None:
    """End the server's process, and with it the job that it does; the next job has another."""
    _server.end()


def do_apart(job: Any, limits: Limits, rows: int | Due | None = None) -> Ended:
    """Do a job in the server's process, within its limits.

    Parameters
    ----------
    job : object
        That can be pickled.
    limits : Limits
    rows : int or Due, optional
        Samples of the record that it is to give, all of a run, or what a replay is to give; None where it is to
        describe a controller.

    Raises
    ------
    OutputError
        When the system's temporary folder cannot be written.
    LostServerError
        When the process does not start.
    """
    with job_folder() as folder:
        return _server.do(job, folder, limits, rows)


def _answer(folder: Path, token: str, rows: int | Due | None, ended: _End) -> tuple[Answer | None, str]:
    """Answer of a job, or why there is none that counts: what has not ended well has not answered, whatever it left."""
    if ended.status != 0:
        is_removed = not (ended.limit or folder.is_dir())
        return None, f"the folder of its run, {folder}, was removed" if is_removed else ended.reason
    try:
        return read_answer(folder, token, rows), ended.reason
    except BadAnswerError as error:
        return None, str(error)


def _progress(file: IO[bytes]) -> list[float | None]:
    """What a run tells of its progress, as far as that is there."""
    data = file.read(PROGRESSES * 8)
    found = np.frombuffer(data.ljust(PROGRESSES * 8, b"\xff"))  # nothing but ones is no number
    return [float(x) if np.isfinite(x) else None for x in found]


def _of_limit(name: str, limits: Limits) -> _End:
    return _End(None, in_words(name, limits), parameter_of(name, limits))


def _in_words(status: int) -> str:
    killer = killed_by(status)
    if not killer:
        return f"the controller ended the process (status {status})"
    from_outside = ", as of a system that is out of memory" if killer == "SIGKILL" else ""
    return f"the controller crashed ({killer}{from_outside})"


def _tail_of(file: IO[bytes]) -> str:
    size = os.fstat(file.fileno()).st_size
    file.seek(max(size - 4 * _SAID_CHARACTERS, 0))
    text = file.read(4 * _SAID_CHARACTERS).decode("utf-8", "replace")
    lines = printable(text, None).strip().split("\n")
    return "\n".join(lines[-_SAID_LINES:])[-_SAID_CHARACTERS:]
