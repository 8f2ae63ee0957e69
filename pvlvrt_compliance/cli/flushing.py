"""Standard output to its end: what cannot be written is one line on stderr, and a status of its own."""

import os
import sys

from pvlvrt_compliance.cli.telling import tell

UNWRITTEN_STATUS = 3


def printed(said: str | bytes) -> int:
    """Print a text, or bytes as they are, and nothing else; the status with which the command ends then."""
    try:
        if isinstance(said, str):
            print(said, end="")
        else:
            sys.stdout.buffer.write(said)
    except OSError as error:
        return _lost(error, 0)
    return flushed(0)


def flushed(status: int) -> int:
    """Write what is still to be written; the status with which the command ends then."""
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except OSError as error:
        return _lost(error, status)
    return status


def unwritten(error: OSError) -> str:
    """What there is to say of a standard output that takes nothing."""
    return f"standard output cannot be written: {error.strerror or error}"


def _lost(error: OSError, status: int) -> int:
    # Python would try it again at its end, and end with a status of its own.
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    if isinstance(error, BrokenPipeError) or status == UNWRITTEN_STATUS:
        return status
    tell(unwritten(error))
    return UNWRITTEN_STATUS
