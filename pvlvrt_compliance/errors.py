"""Every error that the package raises on purpose.

The command line turns them into one clear line and an exit status; library users catch `PvlvrtError`.
"""

import difflib
import errno
from collections.abc import Iterable


class PvlvrtError(Exception):
    """Base of all errors of this package."""


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
        self.origin = origin
        self.problems = tuple(problems)
        count = len(self.problems)
        head = f"{origin}: {count} problem{'s' if count != 1 else ''}"
        super().__init__("\n".join([head, *(f"  {p}" for p in self.problems)]))


class SimulationError(PvlvrtError):
    """A simulation ended without usable waveforms (that test becomes `error`, exit status 3)."""


class OutputError(PvlvrtError):
    """A file cannot be written though its place is a right one (exit status 3)."""


class MeasurementError(PvlvrtError):
    """A quantity cannot be measured on the waveforms given (that check becomes `not_evaluated`)."""


class CompiledCodeWarning(UserWarning):
    """Compiled code is not kept, or what was kept is damaged: that costs time and changes no verdict."""


_NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)


def unwritable(message: str, error: OSError) -> PvlvrtError:
    """The error for a file that cannot be written: `OutputError` for want of room, else the place is a wrong one."""
    return OutputError(message) if error.errno in _NO_ROOM else UsageError(message)


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return ``'; did you mean "x" or "y"?'`` for the near misses of a word, or an empty string."""
    near = [f'"{match}"' for match in difflib.get_close_matches(word, list(known), n=3, cutoff=0.6)]
    return f"; did you mean {' or '.join(near)}?" if near else ""
