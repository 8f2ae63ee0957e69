"""Who has what: units are handed to workers, and handed out anew where a worker is lost."""

import os
import pickle
import queue
import re
import zlib
from collections import deque
from collections.abc import Callable, Generator, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from time import monotonic
from typing import Any
from uuid import uuid4

from pvlvrt_compliance.errors import LostError, UsageError
from pvlvrt_compliance.results import TestResult
from pvlvrt_compliance.results.files import WAVEFORMS
from pvlvrt_compliance.study.executors.arranging import Arranged
from pvlvrt_compliance.study.executors.cluster import worker as there
from pvlvrt_compliance.study.executors.cluster.connecting import (
    Client,
    Future,
    go_on_without_us,
    outcome_of,
    patience_of_settings_s,
)
from pvlvrt_compliance.study.executors.cluster.luggage import Parcel
from pvlvrt_compliance.study.executors.executor import Finished
from pvlvrt_compliance.study.timing import FIXED_TIME
from pvlvrt_compliance.texts import one_line, printable

_LOOK_S = 0.5  # from one look at who is there to the next
_ANSWER_S = 30.0  # for a scheduler that lives to answer
_COMING_S = 60.0  # for a first worker to come, unless dask's own settings say how long
_OTHERS_S = 5.0  # for one that can be used to come after one that cannot
_RECORD = re.compile(rf"{WAVEFORMS}/(?!\.)[^/\\\0]+")
_AHEAD = 2  # units that a worker has at a time: it never waits for the next


@dataclass
class _Worker:
    """A worker that is there."""

    asked: Future  # whether it takes the job
    is_ready: bool = False
    has: dict[int, Future] = field(default_factory=dict)  # units


class Dispatch:
    """Units on their way through a scheduler.

    A unit is given to one worker that has taken the job, never to the scheduler's choice: so nothing runs on a worker
    that was not looked at, and it is known which units a lost worker had.

    Parameters
    ----------
    client : Client
    parcel : Parcel
        The job.
    arranged : Arranged
        Its units.
    count : int
        How many these are.
    begins : callable
        Told of a unit that is handed out.
    tell : callable
        Told of workers that are refused or lost.
    named : str
        The option and its value, for messages.
    """

    def __init__(
        self,
        client: Client,
        parcel: Parcel,
        arranged: Arranged,
        count: int,
        *,
        begins: Callable[[int], None],
        tell: Callable[[str], None],
        named: str,
    ) -> None:
        self._client = client
        self._parcel = parcel
        self._begins = begins
        self._tell = tell
        self._named = named
        self._run = uuid4().hex
        self._arranged = arranged
        self._waiting = count
        self._returned: deque[int] = deque()  # units that are to be begun before any other
        self._wrong: dict[int, str] = {}  # units that have gone wrong once, and how
        self._workers: dict[str, _Worker] = {}
        self._refused: dict[str, str] = {}  # why, by address
        self._events: queue.SimpleQueue[tuple[str, int | None, Any]] = queue.SimpleQueue()
        self._none_since = monotonic()  # since when there is no worker that is used or may be
        self._was_ready = False
        self._looked = 0.0

    def run(self) -> Generator[Finished, None, None]:
        """Run the units.

        Yields
        ------
        Finished
            As `Arranged` hands them on.

        Raises
        ------
        UsageError
            When there is no worker that can be used, before any was.
        LostError
            When the scheduler is gone, or all workers are.
        """
        while not self._arranged.is_done:
            if monotonic() - self._looked >= _LOOK_S:
                yield from self._look()
            self._hand_out()
            yield from self._next()

    def close(self) -> None:
        """Take back what is handed out; a worker ends the test that it is at, and removes what it has of the job."""
        for worker in self._workers.values():
            for future in (worker.asked, *worker.has.values()):
                future.release()
        with suppress(Exception):  # the scheduler may have gone
            for address in self._workers if self._client.status == "running" else ():
                go_on_without_us(self._submitted(address, there.forget, self._run))

    def _look(self) -> Iterator[Finished]:
        """See who has come and who has gone."""
        able, present = self._asked("ncores_running"), self._asked("ncores")  # who goes in between is still able
        self._looked = monotonic()
        self._refused = {address: why for address, why in self._refused.items() if address in present}
        for address in [address for address in self._workers if address not in able]:
            yield from self._lose(address, is_gone=address not in present)
        for address in able.keys() - self._workers.keys() - self._refused.keys():
            self._workers[address] = _Worker(self._watched(address, None, there.receive, self._run, self._parcel))
        if self._workers:
            self._none_since = self._looked
        else:
            self._end_where_nobody_comes(self._looked - self._none_since)

    def _asked(self, what: str) -> dict[str, int]:
        """Answer of the scheduler; what is there to know of it if it gives none."""
        if self._client.status == "running":
            with suppress(OSError, TimeoutError):  # it is closed, or does not answer
                found: dict[str, int] = self._client.sync(
                    getattr(self._client.scheduler, what), callback_timeout=_ANSWER_S
                )
                return found
        raise LostError(f"{self._named}: the scheduler is gone")

    def _end_where_nobody_comes(self, waited_s: float) -> None:
        refused = "; ".join(f"worker {address}: {why}" for address, why in self._refused.items())
        patience_s = patience_of_settings_s() or _COMING_S
        if waited_s < (_OTHERS_S if refused and not self._was_ready else patience_s):
            return
        if self._was_ready:
            raise LostError(f"{self._named}: all workers are gone{'; ' * bool(refused)}{refused}")
        if refused:
            raise UsageError(f"{self._named}: no worker can be used: {refused}")
        raise UsageError(f"{self._named}: no worker has come within {waited_s:.0f} s; start some with: dask worker")

    def _hand_out(self) -> None:
        for ahead in range(1, _AHEAD + 1):
            for address, worker in self._workers.items():
                if worker.is_ready and len(worker.has) < ahead and (unit := self._one_for(worker)) is not None:
                    self._waiting -= 1
                    self._begins(unit)
                    worker.has[unit] = self._watched(address, unit, there.run_unit, self._run, unit)

    def _one_for(self, worker: _Worker) -> int | None:
        """The next unit, if it is for this worker; one that has gone wrong before is alone with its worker."""
        if not self._returned and self._arranged.has_next:
            self._returned.append(self._arranged.next())
        if not self._returned:
            return None
        is_plenty = self._waiting >= len(self._workers)  # else somebody who waits would be left without
        is_apart = {self._returned[0], *worker.has} & self._wrong.keys()
        return self._returned.popleft() if not worker.has or (is_plenty and not is_apart) else None

    def _watched(self, address: str, unit: int | None, function: Callable[..., Any], *arguments: Any) -> Future:
        future = self._submitted(address, function, *arguments)
        future.add_done_callback(lambda ended: self._events.put((address, unit, ended)))
        return future

    def _submitted(self, address: str, function: Callable[..., Any], *arguments: Any) -> Future:
        key = f"pvlvrt-{function.__name__}-{uuid4().hex}"
        call = pickle.dumps(_Call(function, arguments))
        return self._client.submit(pickle.loads, call, key=key, workers=[address], pure=False)

    def _next(self) -> Iterator[Finished]:
        """What comes next, if anything does until the next look."""
        try:
            address, unit, future = self._events.get(timeout=_LOOK_S)
        except queue.Empty:
            return
        worker = self._workers.get(address)
        if worker is None or future is not (worker.asked if unit is None else worker.has.get(unit)):
            return  # of a worker that is lost by now
        if unit is None:
            self._take_answer(address, worker, future)
        else:
            yield from self._take(address, worker, unit, future)

    def _take_answer(self, address: str, worker: _Worker, future: Future) -> None:
        answer = outcome_of(future)
        if answer.value == "":
            worker.is_ready = self._was_ready = True
            future.release()
            return
        del self._workers[address]
        if answer.is_lost:
            return  # it is asked again, if it is there
        why = answer.value or f"it cannot load what version {self._version} sends ({answer.error})"
        self._refused[address] = why
        self._tell(f"worker {address} is not used: {why}")

    @property
    def _version(self) -> str:
        return self._parcel.needed["pvlvrt-compliance"]

    def _take(self, address: str, worker: _Worker, unit: int, future: Future) -> Iterator[Finished]:
        outcome = outcome_of(future)
        ran: there.Ran | None = outcome.value
        if outcome.is_lost or (ran is not None and ran.is_unknown):
            yield from self._lose(address, is_gone=True)
            return
        del worker.has[unit]
        future.release()
        if ran is None or ran.failed:
            yield from self._gone_wrong(unit, f"worker {address}: {ran.failed if ran else outcome.error}")
            return
        try:
            arrived = [_as_here(finished) for finished in ran.finished]
        except (ValueError, zlib.error) as error:
            yield from self._gone_wrong(unit, f"worker {address}: what it sends is no result: {one_line(str(error))}")
            return
        for finished in arrived:
            yield from self._arranged.finished(finished)
        yield from self._arranged.ended(unit, ran.ended)

    def _lose(self, address: str, *, is_gone: bool) -> Iterator[Finished]:
        """Take back what a worker has that is gone, or for the time being takes no task."""
        worker = self._workers.pop(address)
        for future in (worker.asked, *worker.has.values()):
            future.release()
        if is_gone and worker.is_ready:
            self._tell(f"worker {address} is gone" + "; what it had is run again" * bool(worker.has))
        for unit in worker.has:
            if is_gone:
                yield from self._gone_wrong(unit, f"worker {address} was lost while it was run")
            else:
                self._waiting += 1
                self._returned.append(unit)

    def _gone_wrong(self, unit: int, how: str) -> Iterator[Finished]:
        """Have a unit run again, unless it has been."""
        before = self._wrong.get(unit)
        if before is None:
            self._wrong[unit] = how
            self._waiting += 1
        yield from self._arranged.lost(unit, f"given up after two tries: {before}; {how}")


def _as_here(finished: Finished) -> Finished:
    """A test as it would be of this process: its texts pass `texts` here, too, and whether time is fixed is said here.

    Raises
    ------
    ValueError
        When it is none, or a record of it would lie elsewhere than records do.
    zlib.error
        When a record is not packed as it is sent.
    """
    result = TestResult.model_validate(finished.result.model_dump())
    for name in finished.files:
        if not _RECORD.fullmatch(name):
            raise ValueError(f"{name!r} is no name of a record")
    files = there.unpressed(finished.files)
    if FIXED_TIME in os.environ:
        result = result.model_copy(update={"wall_time_s": 0.0})
    return finished._replace(result=result, files=files, notes=[*map(printable, finished.notes)])


class _Call:
    """A call that is made where it is unpickled, on the worker: a scheduler reads its tasks, and need not have us."""

    def __init__(self, function: Callable[..., Any], arguments: tuple[Any, ...]) -> None:
        self._made = function, arguments

    def __reduce__(self) -> tuple[Any, ...]:
        return self._made
