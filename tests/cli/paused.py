"""The command as a program, made to say where it is and to wait there: ``python paused.py PLACE ARGUMENTS...``.

A number is the test before which it says `here` and waits for ever. `compiled` is inside the compiled loop of the first
simulation, which says `here` when it is about to begin, and `over` when it has ended. `lock` is where Python takes a
lock back, which a signal leaves without it. With `twice` and `thrice` it
waits before the third test, and the SIGTERM that ends it comes again, so many times in all, while it keeps what is
finished.
"""

import math
import signal
import sys
import threading
from contextlib import ExitStack

import pvlvrt_compliance.simulation.simulate as simulation
import pvlvrt_compliance.study.run as study_run
from pvlvrt_compliance.cli.main import main
from pvlvrt_compliance.study.executors import choosing
from pvlvrt_compliance.study.store import OutputFolder


def _say(word):
    sys.stdout.write(f"{word}\n")
    sys.stdout.flush()


def _wait_before(number):
    right, seen = study_run.run_test, []

    def run_test(*arguments):
        seen.append(arguments)
        if len(seen) == number:
            _say("here")
            threading.Event().wait()
        return right(*arguments)

    study_run.run_test = run_test


def _wait_for_a_lock():
    class Lock:
        """As Python's own of a condition that is waited for."""

        def __enter__(self):
            _say("here")
            threading.Event().wait()

        def __exit__(self, *_):
            raise RuntimeError("release unlocked lock")

    def run_test(*_):
        with ExitStack() as stack:
            lock = Lock()
            stack.push(lock)
            lock.__enter__()

    study_run.run_test = run_test


def _tell_of_simulation():
    right = simulation.simulate

    def simulate(*arguments):
        _say("here")
        record = right(*arguments)
        _say("over")
        return record

    simulation.simulate = simulate


def _disturb_keeping(times):
    right = OutputFolder.keep_interrupted

    def keep_interrupted(output):
        for _ in range(times - 1):
            signal.raise_signal(signal.SIGTERM)
        return right(output)

    OutputFolder.keep_interrupted = keep_interrupted
    _wait_before(3)


if __name__ == "__main__":
    choosing.PAYS_FROM_S = math.inf  # what waits does so in this process
    place = sys.argv.pop(1)
    if place == "compiled":
        _tell_of_simulation()
    elif place == "lock":
        _wait_for_a_lock()
    elif place in ("twice", "thrice"):
        _disturb_keeping(2 if place == "twice" else 3)
    else:
        _wait_before(int(place))
    main()
