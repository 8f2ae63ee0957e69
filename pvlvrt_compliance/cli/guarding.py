"""What the command prints where GitHub's runner reads it: no text of others commands the runner."""

import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, redirect_stderr, redirect_stdout
from typing import Any, TextIO

from pvlvrt_compliance.report.workflow_commands import harmless, is_read


@contextmanager
def guarded() -> Iterator[None]:
    """Whatever is printed meanwhile, on either stream, has no line that the runner would obey, if there is a runner."""
    with ExitStack() as stack:
        if is_read():
            for stream, redirect in ((sys.stdout, redirect_stdout), (sys.stderr, redirect_stderr)):
                if stream is not None:
                    lines = _Lines(stream)
                    stack.enter_context(redirect(lines))
                    stack.callback(lines.end)
        yield


def command_the_runner(lines: str) -> None:
    """Print lines of ours for the runner, as they are."""
    stream = sys.stdout
    if isinstance(stream, _Lines):
        stream.write_commands(lines)
    else:
        stream.write(lines)


class _Lines:
    """A stream that is written to in whole lines, each harmless to the runner."""

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
