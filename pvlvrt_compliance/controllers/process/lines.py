"""What the server says of its jobs: a line of JSON each, read as what anybody may have written into its pipe."""

import json
import queue
import threading
from collections.abc import Mapping
from contextlib import suppress
from typing import IO, Any

from pvlvrt_compliance.errors import PvlvrtError

_LONGEST = 4096  # bytes of a line
_MOST = 100  # lines that nobody has asked for

SAYINGS: Mapping[str, Mapping[str, type]] = {
    "ready": {},
    "started": {"pid": int},
    "ended": {"status": int, "why": str},
}
"""What there is to say, each with ``job`` and with these."""


WRITTEN_BY_OTHERS = "somebody else has written into a pipe of the process for the controller"


class NonsenseError(PvlvrtError):
    """The server has said what it never says: somebody else has written into its pipe."""


class SilenceError(PvlvrtError):
    """The server has said nothing in time."""


class Lines:
    """Lines of a stream, read as they come; few are kept that nobody asks for."""

    def __init__(self, stream: IO[bytes] | None) -> None:
        self._lines: queue.Queue[bytes | None] = queue.Queue(_MOST)
        if stream is not None:
            threading.Thread(target=_read, args=(stream, self._lines), daemon=True).start()

    def next(self, what: str, job: str | None, limit_s: float) -> dict[str, Any] | None:
        """What is said next, which is to be this of this job; None where the stream has ended.

        Raises
        ------
        NonsenseError
            When it is anything else.
        queue.Empty
            When nothing is said in so many seconds.
        """
        line = self._lines.get(timeout=limit_s)
        return None if line is None else _message(line, what, job)


def say(stream: IO[str], what: str, job: str | None = None, **said: Any) -> None:
    """Say something, in one line."""
    print(json.dumps({"say": what, "job": job, **said}), file=stream, flush=True)


def _message(line: bytes, what: str, job: str | None) -> dict[str, Any]:
    try:
        found = json.loads(line)
    except (ValueError, RecursionError):
        found = None
    kinds = SAYINGS[what]
    if (
        not isinstance(found, dict)
        or found.keys() != {"say", "job", *kinds}
        or (found["say"], found["job"]) != (what, job)
        or not all(type(found[key]) is kind for key, kind in kinds.items())
    ):
        raise NonsenseError(WRITTEN_BY_OTHERS)
    return found


def _read(stream: IO[bytes], lines: "queue.Queue[bytes | None]") -> None:
    with stream:
        while line := stream.readline(_LONGEST):
            try:
                lines.put_nowait(line)
            except queue.Full:  # the first of them will be told for what it is
                break
    with suppress(queue.Full):
        lines.put_nowait(None)
