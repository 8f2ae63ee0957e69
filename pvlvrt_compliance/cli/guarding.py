"""The streams of the command: no line of them commands a CI service, and none is lost to an encoding.

What is printed is `printable` already; here it is looked at as it falls: a table that is folded begins lines of its
own, and what an encoding lacks is known by its stream alone.
"""

import io
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, redirect_stderr, redirect_stdout, suppress
from typing import Any, TextIO

from pvlvrt_compliance.report.workflow_commands import is_read
from pvlvrt_compliance.texts import harmless, write_any_name


@contextmanager
def guarded() -> Iterator[None]:
    """Whatever is printed meanwhile, on either stream, has no line that a CI service would obey.

    A terminal is written to as it comes: nobody obeys lines there, unless a runner has made one.
    """
    with ExitStack() as stack:
        for stream, redirect in ((sys.stdout, redirect_stdout), (sys.stderr, redirect_stderr)):
            if isinstance(stream, io.TextIOWrapper) and stream.errors != "backslashreplace":  # stderr's own
                stack.callback(_whatever_it_takes, write_any_name(stream))
            if stream is not None and (is_read() or not stream.isatty()):
                lines = _Lines(stream)
                stack.enter_context(redirect(lines))
                stack.callback(_whatever_it_takes, lines.end)
        yield


def _whatever_it_takes(last: Callable[[], None]) -> None:
    """Do what is due at the end; a stream that takes nothing more says so again when it is flushed."""
    with suppress(OSError):
        last()


def command_the_runner(lines: str) -> None:
    """Print lines of ours for the runner, as they are."""
    stream = sys.stdout
    if isinstance(stream, _Lines):
        stream.write_commands(lines)
    else:
        stream.write(lines)


class _Lines:
    """A stream that is written to in whole lines, each harmless to a CI service."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._begun = ""  # of a line whose end is still to come

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def write(self, text: str) -> int:
        whole, end, self._begun = (self._begun + text).rpartition("\n")
        if end:
            self._stream.write(harmless(whole) + end)
        return len(text)

    def writelines(self, lines: Any) -> None:
        self.write("".join(lines))

    def write_commands(self, lines: str) -> None:
        self.end()
        self._stream.write(lines)

    def end(self) -> None:
        """End with what has no end of its own."""
        begun, self._begun = self._begun, ""
        self._stream.write(harmless(begun))
