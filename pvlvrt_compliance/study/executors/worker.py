"""What runs in the process of a worker: units by their numbers, as `processes` sends them."""

import os
import pickle
import signal
import threading
import traceback
from collections.abc import Callable, Generator
from queue import SimpleQueue
from typing import IO, TYPE_CHECKING, Any, NamedTuple

from pvlvrt_compliance.controllers.process.child import own_pipes
from pvlvrt_compliance.controllers.process.command import leave

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator
    from pvlvrt_compliance.study.executors.executor import Finished
    from pvlvrt_compliance.study.selection import Assignment
    from pvlvrt_compliance.study.work import Work

Say = Callable[[Any], None]


class Begun(NamedTuple):
    """A test is begun: the id of its profile, and itself."""

    profile: str
    test: Any


class UnitEnded(NamedTuple):
    """A unit has come to its end, and whether the run has with it."""

    number: int
    is_end: bool


class Failed(NamedTuple):
    """Something has gone wrong that ends the run: what, and where in words."""

    error: BaseException
    trace: str


def start_words(work: "Work", controller: "ForeignSimulator | None") -> bytes:
    """What a worker is told at first.

    Raises
    ------
    Exception
        Of any kind, when something of it cannot go to another process.
    """
    data = pickle.dumps((work, controller))
    return b"%d\n%s" % (len(data), data)


def main() -> None:
    """Work: at first a `Work` with a controller, then a line with a number for each unit; `Say`ings come out.

    When the input ends, everything does, and at once: whoever has started this has gone, or needs it no more.
    """
    told, answered = own_pipes()
    signal.signal(signal.SIGINT, lambda *_: None)  # of a console, which everything in it hears: see above
    orders, answers = os.fdopen(told, "rb"), os.fdopen(answered, "wb")
    data = orders.read(int(orders.readline() or 0))  # all of it, before anything is imported that takes a while
    numbers: SimpleQueue[int] = SimpleQueue()
    threading.Thread(target=_listen, args=(orders, numbers), daemon=True).start()

    def say(message: Any) -> None:
        answers.write(pickle.dumps(message))
        answers.flush()

    try:
        work, controller = pickle.loads(data)
        _work(work, controller, numbers, say)
    except BaseException as error:  # whatever it is, the run ends with it where it was begun
        say(_failed(error))
        threading.Event().wait()


def _listen(orders: IO[bytes], numbers: "SimpleQueue[int]") -> None:
    for line in orders:
        numbers.put(int(line))
    leave(0)


def _work(work: "Work", controller: "ForeignSimulator | None", numbers: "SimpleQueue[int]", say: Say) -> None:
    from pvlvrt_compliance.study.executors.here import run_alone
    from pvlvrt_compliance.study.executors.units import units_of
    from pvlvrt_compliance.study.reuse.opening import simulator_for

    def begins(item: "Assignment") -> None:
        say(Begun(item.profile.id, item.test))

    units = units_of(work.job.tests, work.job.first)
    simulator = simulator_for(work.job, controller)
    while True:
        number = numbers.get()
        say(UnitEnded(number, _say_all(run_alone(work, units, number, controller, begins, simulator), say)))


def _say_all(stream: "Generator[Finished, None, bool]", say: Say) -> bool:
    while True:
        try:
            say(next(stream))
        except StopIteration as end:
            return bool(end.value)


def _failed(error: BaseException) -> Failed:
    trace = "".join(traceback.format_exception(error))
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:  # whatever a class of errors may do
        error = RuntimeError(f"{type(error).__name__}: {error}")
    return Failed(error.with_traceback(None), trace)
