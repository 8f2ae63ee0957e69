"""What ends a run from outside while a controller's Python is at work: Ctrl-C, a signal, a debugger that is left.

Compiled code between the loop and a controller lets no exception through. What is met there is kept, by thread, until
whoever began the run takes it.
"""

import sys
import threading

from pvlvrt_compliance.errors import stop_behind


class _Met(threading.local):
    end: BaseException | None = None


_met = _Met()


def from_outside(error: BaseException) -> BaseException | None:
    """What an exception is that no controller has made: Ctrl-C, a signal, or a debugger's; None of all others."""
    return error if is_of_the_debugger(error) else stop_behind(error)


def is_of_the_debugger(error: BaseException) -> bool:
    """Whether the debugger was left by it (`bdb.BdbQuit`); where none was loaded, it was not."""
    debugger = sys.modules.get("bdb")
    return debugger is not None and isinstance(error, debugger.BdbQuit)


def keep(error: BaseException) -> None:
    """Keep what ends the run from outside for `take`; of everything else nothing is kept."""
    if (end := from_outside(error)) is not None:
        _met.end = end


def take() -> BaseException | None:
    """What has been kept in this thread since it was last asked for; None where nothing was."""
    found, _met.end = _met.end, None
    return found
