"""A controller that is run in the process of whoever asks for its verdict, for a debugger or a sanitiser to look at.

What is told of it, and what the doors must know: no copy of a file is removed that a debugger may want to read, and
nobody is late who is being looked at.
"""

import faulthandler
import math
import sys
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from functools import cache
from pathlib import Path

from pvlvrt_compliance.controllers.limits import Limits, hold_to, limits_here
from pvlvrt_compliance.controllers.process.scratch import job_folder

NOTE = (
    "the controller runs in this process: no limit holds for its time, memory, output, files or processes, a crash of"
    " it ends the run, and what its modules keep lasts from one test to the next; one test at a time (jobs 1), no"
    " progress bar, no record is reused"
)
"""What is different with ``--debug``, told before the controller is opened."""

_NO_LIMITS = Limits(math.inf, math.inf, math.inf, math.inf, math.inf, math.inf)


_kept = ExitStack()  # what it holds is closed with this process


class _Debugging:
    is_on = False


def is_debugged() -> bool:
    """Whether a controller that is opened now is one to be looked at, in this process."""
    return _Debugging.is_on


@contextmanager
def debugged() -> Iterator[None]:
    """Open and run a controller to be looked at.

    Temporary files lie in one folder for as long as this process lives: what was loaded from there a debugger reads
    again whenever it likes. Where the process crashes, the next run removes it. A crash says where it was.

    Raises
    ------
    OutputError
        When that folder cannot be made.
    """
    before, limits, is_on = tempfile.tempdir, limits_here(), _Debugging.is_on
    if not faulthandler.is_enabled() and sys.__stderr__ is not None:
        with suppress(OSError, ValueError):  # it is none of the system's
            faulthandler.enable(sys.__stderr__)
    _Debugging.is_on, tempfile.tempdir = True, str(_folder())
    hold_to(_NO_LIMITS)
    try:
        yield
    finally:
        _Debugging.is_on, tempfile.tempdir = is_on, before
        hold_to(limits)


@cache
def _folder() -> Path:
    """The folder, which is removed when this process ends."""
    return _kept.enter_context(job_folder())
