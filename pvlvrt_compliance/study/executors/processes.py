"""Tests run in processes of this machine, which share nothing but the compiled code.

No pool of Python's own: those import the main module anew in each process, which may be anybody's script, and a process
that is killed breaks all of them.
"""

import os
import pickle
import subprocess
import threading
import time
from collections.abc import Generator, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING, Any, NamedTuple

from pvlvrt_compliance.controllers.process import child
from pvlvrt_compliance.controllers.process.command import at_end
from pvlvrt_compliance.controllers.process.family import is_stopped
from pvlvrt_compliance.errors import LostError
from pvlvrt_compliance.study.executors.arranging import Arranged
from pvlvrt_compliance.study.executors.executor import Finished
from pvlvrt_compliance.study.executors.units import Begins, Unit
from pvlvrt_compliance.study.executors.worker import Begun, Failed, UnitEnded, start_words
from pvlvrt_compliance.study.selection import Assignment
from pvlvrt_compliance.study.work import Work

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator

# Each process has a core of its own: threads of the matrix library would only wait for each other there.
_ONE_THREAD = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")

_LOOK_S = 1.0  # Windows hears no Ctrl-C while a lock is waited for
_STOPPED_S = 5.0  # one that a scheduler has stopped with all others goes on with them
_PATIENCE_S = 5.0  # with a process that has said half a word


class _Lost(NamedTuple):
    """A worker has ended, and how."""

    reason: str


class _FromWorkerError(Exception):
    """What has gone wrong in a worker, as it was told there."""

    def __str__(self) -> str:
        return f"\n{self.args[0]}"


@dataclass(frozen=True)
class Processes:
    """Runs units in processes (`Executor`).

    Parameters
    ----------
    count : int
        How many at once, at most.
    controller : ForeignSimulator, optional
        The job's own, opened; each process has one of its own by it.
    """

    count: int
    controller: "ForeignSimulator | None" = None

    def run(self, work: Work, units: Sequence[Unit], begins: Begins) -> Generator[Finished, None, None]:
        """Run units, as of `Executor`.

        Raises
        ------
        LostError
            When the first processes end before any has begun with a test.
        """
        arranged, profiles = Arranged(work, units), {profile.id: profile for profile in work.job.profiles}
        with _crew(min(self.count, len(units)), start_words(work, self.controller)) as crew:
            while not arranged.is_done:
                crew.begin(arranged)
                worker, said = crew.hear()
                if isinstance(said, Begun):
                    begins(Assignment(profiles[said.profile], said.test))
                elif isinstance(said, Finished):
                    yield from arranged.finished(said)
                elif isinstance(said, UnitEnded):
                    worker.unit = None
                    yield from arranged.ended(*said)
                elif isinstance(said, _Lost):
                    number = crew.bury(worker, said.reason)
                    yield from arranged.lost(number, said.reason) if number is not None else ()
                else:
                    assert isinstance(said, Failed)
                    raise said.error from _FromWorkerError(said.trace)


class _Worker:
    """A process, and the unit that it has."""

    def __init__(self, start: bytes, heard: "SimpleQueue[tuple[_Worker, Any]]", echo: child.Echo) -> None:
        self.unit: int | None = None
        self.has_begun = False
        self._why = ""  # it was ended here
        self._stopped_since: float | None = None
        self._start = start
        self._process = child.start(
            "pvlvrt_compliance.study.executors.worker", stderr=subprocess.PIPE, env={**_ONE_THREAD, **os.environ}
        )
        assert self._process.stderr is not None
        self._said = echo.of(self._process.stderr)
        threading.Thread(target=self._listen, args=(heard,), daemon=True).start()

    def begin(self, number: int) -> None:
        """Have it run a unit. One that has ended takes it, and is lost with it."""
        self.unit = number
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(b"%s%d\n" % (self._start, number))
            self._process.stdin.flush()
        except OSError:
            return
        self._start = b""

    def let_go(self) -> None:
        """Let it end by itself."""
        if self.has_begun:
            child.let_go(self._process)

    def end(self) -> None:
        """End it, and whatever it has started."""
        child.end(self._process, listens=self.has_begun)

    def end_if_stopped(self) -> None:
        """End it if it has been stopped for a while: a controller can do that, and it would never go on."""
        now = time.monotonic()
        if not is_stopped(self._process.pid):
            self._stopped_since = None
        elif self._stopped_since is None:
            self._stopped_since = now
        elif now - self._stopped_since > _STOPPED_S:
            self._kill("was stopped (SIGSTOP)")  # what it has started sees the end of its own input

    def _kill(self, why: str) -> None:
        self._why = self._why or f"the process that ran it {why}"
        self._process.kill()

    def _listen(self, heard: "SimpleQueue[tuple[_Worker, Any]]") -> None:
        assert self._process.stdout is not None
        with self._process.stdout as answers:
            while True:
                try:
                    said = pickle.load(answers)
                except EOFError:  # it has ended
                    break
                except Exception:  # it has ended in the middle of a word, or the word is of somebody else
                    said = None
                if not isinstance(said, (Begun, Finished, UnitEnded, Failed)):
                    self._end_of_sense()
                    break
                self.has_begun = True
                heard.put((self, said))
        heard.put((self, _Lost(self._last_words())))

    def _last_words(self) -> str:
        status, said = self._process.wait(), self._said()
        why = self._why or _in_words(status)
        return f"{why}\nit had printed: {said}" if said else why

    def _end_of_sense(self) -> None:
        """See to its end, where what it says is nothing that can be understood."""
        try:
            self._process.wait(_PATIENCE_S)
        except subprocess.TimeoutExpired:
            self._kill("said what it never says")


class _Crew:
    """The workers that there are."""

    def __init__(self, count: int, start: bytes) -> None:
        self._count = count
        self._start = start
        self._heard: SimpleQueue[tuple[_Worker, Any]] = SimpleQueue()
        self._echo = child.Echo()
        self._workers: list[_Worker] = []
        self._has_begun = False
        self._losses = 0
        self._looked_s = 0.0

    def begin(self, arranged: Arranged) -> None:
        """Give each worker that has no unit one, as long as there are units."""
        while arranged.has_next:
            free = [worker for worker in self._workers if worker.unit is None]
            if not free and len(self._workers) == self._count:
                return
            if free:
                free[0].begin(arranged.next())
            else:
                self.fill()

    def fill(self) -> None:
        """Start those that are missing."""
        while len(self._workers) < self._count:
            self._workers.append(_Worker(self._start, self._heard, self._echo))

    def hear(self) -> tuple[_Worker, Any]:
        """What one says next."""
        while True:
            if time.monotonic() > self._looked_s + _LOOK_S:
                self._looked_s = time.monotonic()
                for each in self._workers:
                    each.end_if_stopped()
            try:
                worker, said = self._heard.get(timeout=_LOOK_S)
            except Empty:
                continue
            self._has_begun = self._has_begun or not isinstance(said, _Lost)
            return worker, said

    def bury(self, worker: _Worker, reason: str) -> int | None:
        """Forget one that is lost; the unit that it had.

        Raises
        ------
        LostError
            When as many have been lost as there are to be, and none has begun with anything.
        """
        self._losses += 1
        if not self._has_begun and self._losses >= self._count:
            raise LostError(f"no test can be run in a process of its own: {reason}")
        self._workers.remove(worker)
        worker.end()
        return worker.unit

    def end(self) -> None:
        """End all."""
        for worker in self._workers:
            worker.let_go()
        while self._workers:
            self._workers[-1].end()
            self._workers.pop()


_crews: list[_Crew] = []


def _end_all() -> None:
    for crew in list(_crews):
        crew.end()


@cache
def _end_with_this_process() -> None:
    at_end(_end_all)


@contextmanager
def _crew(count: int, start: bytes) -> Iterator[_Crew]:
    _end_with_this_process()
    crew = _Crew(count, start)
    _crews.append(crew)
    try:
        crew.fill()
        yield crew
    finally:
        crew.end()
        _crews.remove(crew)


def _in_words(status: int) -> str:
    killer = child.killed_by(status)
    how = f"was killed ({killer})" if killer else f"has ended (status {status})"
    return f"the process that ran it {how}"
