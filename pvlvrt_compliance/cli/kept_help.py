"""Helps as typer has drawn them, kept from one process to the next: what one goes by, and what was printed."""

import io
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, redirect_stdout
from importlib.util import find_spec
from typing import Any, BinaryIO, cast

from pvlvrt_compliance.cache import named

_DRAWN_BY = ("pvlvrt_compliance", "typer", "rich", "click")
"""Packages that decide what a help says and how it looks; later versions of typer bring click within themselves."""

_BYTECODE = "__pycache__"

VARIABLES = (
    *("COLUMNS", "LINES", "TERMINAL_WIDTH", "JUPYTER_COLUMNS", "JUPYTER_LINES", "UNICODE_VERSION"),
    *("TERM", "COLORTERM", "NO_COLOR", "FORCE_COLOR", "PY_COLORS", "TTY_COMPATIBLE", "TTY_INTERACTIVE"),
    *("GITHUB_ACTIONS", "DATABRICKS_RUNTIME_VERSION", "TYPER_USE_RICH", "_TYPER_FORCE_DISABLE_TERMINAL"),
    *("LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG"),
)
"""What of the environment they look at."""


def name_of(arguments: Sequence[str]) -> str:
    """Name of the help that some words ask for, by all that decides it; empty where it cannot be kept.

    Of a file of the packages its size and the time of its last change count, by which Python, too, knows whether
    bytecode is still that of a source.
    """
    if sys.platform == "win32" or not isinstance(sys.stdout, io.TextIOWrapper):
        return ""  # Windows has several kinds of console, which is for rich to tell
    try:
        files = [file for package in _DRAWN_BY for file in _files(package)]
    except OSError:
        return ""
    surroundings = [os.environ.get(name) for name in VARIABLES]
    screen = [sys.stdout.isatty(), sys.stdout.encoding, *(_columns(stream) for stream in range(3))]
    python = [sys.version, sys.flags.optimize]  # without docstrings commands have no text
    return named("help", *map(repr, (list(arguments), python, files, surroundings, screen)))


@contextmanager
def noted() -> Iterator[list[bytes]]:
    """Every byte that goes to standard output meanwhile, on which way whatever: click goes round a text stream."""
    said: list[bytes] = []
    stream = cast(io.TextIOWrapper, sys.stdout)
    around = io.TextIOWrapper(
        cast(BinaryIO, _Noted(cast(BinaryIO, stream.buffer), said)),
        encoding=stream.encoding,
        errors=stream.errors,
        newline="\n",  # as Python opens it
        line_buffering=stream.line_buffering,
        write_through=stream.write_through,
    )
    with redirect_stdout(around):
        yield said


class _Noted(io.BufferedIOBase):
    """A stream that notes what is written on another."""

    def __init__(self, stream: BinaryIO, said: list[bytes]) -> None:
        self._stream = stream
        self._said = said

    def writable(self) -> bool:
        return True

    def write(self, data: Any) -> int:
        self._said.append(bytes(data))
        return self._stream.write(data)

    def flush(self) -> None:
        self._stream.flush()

    def fileno(self) -> int:
        return self._stream.fileno()

    def isatty(self) -> bool:
        return self._stream.isatty()


def _files(package: str) -> Iterator[tuple[str, int, int]]:
    """Every file of a package with its size and the time of its last change; nothing of one that is not installed."""
    spec = find_spec(package)
    folders = list(spec.submodule_search_locations or ()) if spec else []
    while folders:
        with os.scandir(folders.pop()) as found:
            entries = sorted(found, key=lambda entry: entry.name)
        for entry in entries:
            if entry.name == _BYTECODE:
                continue
            if entry.is_dir():
                folders.append(entry.path)
            else:
                state = entry.stat()
                yield entry.path, state.st_size, state.st_mtime_ns


def _columns(stream: int) -> int | None:
    """Width of the terminal that a stream is; rich takes that of any that is one."""
    try:
        return os.get_terminal_size(stream).columns
    except OSError:
        return None
