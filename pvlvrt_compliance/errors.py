"""Every error that the package raises on purpose.

The command line turns them into one clear line and an exit status; library users catch `PvlvrtError`.
"""

import errno
import signal
from collections.abc import Callable, Iterable, Sequence

from pvlvrt_compliance.texts import each_line, printable

_MOST_LISTED = 100


class PvlvrtError(Exception):
    """Base of all errors of this package.

    Parameters
    ----------
    message : str
        It may quote files, controllers and other libraries: what is kept of it can be shown anywhere
        (`texts.each_line`).
    """

    def __init__(self, message: str = "") -> None:
        super().__init__(each_line(message))


class UsageError(PvlvrtError):
    """A value given by the user cannot be used (exit status 2)."""


class ProfileError(PvlvrtError):
    """A profile cannot be read; carries all problems of the file at once (exit status 2).

    Parameters
    ----------
    origin : str
        The file, as the user named it.
    problems : iterable of str
        One line each, ``key: what is wrong and what is allowed``.
    """

    def __init__(self, origin: str, problems: Iterable[str]) -> None:
        self.origin = printable(origin)
        self.problems = tuple(map(printable, problems))
        super().__init__(listed(self.origin, self.problems))


class SimulationError(PvlvrtError):
    """A simulation ended without usable waveforms (that test becomes `error`, exit status 3)."""


class UnfinishedError(PvlvrtError):
    """A run cannot go on to its end; what is finished is kept (exit status 3)."""


class OutputError(UnfinishedError):
    """A file cannot be written though its place is a right one (exit status 3)."""


class LostError(UnfinishedError):
    """What runs the tests is gone before all of them are run (exit status 3)."""


class MeasurementError(PvlvrtError):
    """A quantity cannot be measured on the waveforms given (that check becomes `not_evaluated`)."""


class KeptFileWarning(UserWarning):
    """Something is not kept from one run to the next, or is damaged: that costs time and changes no verdict."""


class StoredRecordWarning(KeptFileWarning):
    """Records are not kept, or what was kept is damaged."""


class CompiledCodeWarning(KeptFileWarning):
    """Compiled code is not kept, or what was kept is damaged."""


def listed(origin: str, problems: Sequence[str]) -> str:
    """Problems of a file as one text: how many there are, then one a line, the first hundred of them."""
    head = f"{origin}: {len(problems)} problem{'s' * (len(problems) != 1)}"
    more = len(problems) - _MOST_LISTED
    last = [f"  and {more} more"] if more > 0 else []
    return "\n".join([head, *(f"  {problem}" for problem in problems[:_MOST_LISTED]), *last])


_NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)


def unwritable(message: str, error: OSError) -> PvlvrtError:
    """The error for a file that cannot be written: `OutputError` for want of room, else the place is a wrong one."""
    return OutputError(message) if error.errno in _NO_ROOM else UsageError(message)


def spelled_of(spell: Callable[[str], str], field: str, item: str) -> str:
    """How a message names a field of which one item is meant: where that stands, if who spells the field knows it."""
    of_item: Callable[[str, str], str] | None = getattr(spell, "of_item", None)
    return spell(field) if of_item is None else of_item(field, item)


def near_misses(word: str, known: Iterable[str]) -> list[str]:
    """Return up to three words of those known that a word may have been meant to be, the nearest first."""
    import difflib  # for who makes a mistake

    return difflib.get_close_matches(word, list(known), n=3, cutoff=0.6)


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return ``'; did you mean "x" or "y"?'`` for the near misses of a word, or an empty string."""
    near = [f'"{match}"' for match in near_misses(word, known)]
    return f"; did you mean {' or '.join(near)}?" if near else ""


class Stopped(BaseException):
    """A signal has asked this process to end: SIGINT, or SIGTERM, which a CI service, `timeout` and docker send.

    No `KeyboardInterrupt`, of which libraries make what they like.
    """

    def __init__(self, number: int = signal.SIGINT) -> None:
        super().__init__(number)
        self.number = number


def stop_behind(error: BaseException) -> BaseException | None:
    """The signal or Ctrl-C that an exception is, or that it came in the place of; None of an error.

    A signal is raised wherever Python is just at, in the middle of its own locks, too: what unwinds them then raises
    errors of its own ("release unlocked lock" of `threading`), which are none of the program.
    """
    met: BaseException | None = error
    while met is not None and not isinstance(met, (KeyboardInterrupt, Stopped)):
        met = met.__cause__ or met.__context__
    return met
