"""Answer a shell that asks what may come next."""

import io
import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr
from typing import Any

from pvlvrt_compliance.cli.completion.scripts import ASKED_BY, PROGRAM

_COLUMNS = "COLUMNS"
_WIDEST = "10000"


def is_asked() -> bool:
    """Whether a shell has started the command only to ask."""
    return bool(os.environ.get(ASKED_BY))


def answer(command: Any) -> int:
    """Print what may come next in the line that a shell has handed over; its status, which fish reads.

    Whatever happens, nothing but answers is printed: the reader is in the middle of typing.
    """
    from typer.completion import completion_init  # type: ignore[attr-defined]  # its shells have no public name

    try:
        completion_init()
        with redirect_stderr(io.StringIO()), _one_line_an_answer(), warnings.catch_warnings(action="ignore"):
            command.main(args=[], prog_name=PROGRAM, standalone_mode=False)
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else 0
    except Exception:  # a line that is half written, or variables that no script of ours has set
        return 1
    return 0


@contextmanager
def _one_line_an_answer() -> Iterator[None]:
    """Keep typer from wrapping what an answer means: a shell takes every line for an answer."""
    before = os.environ.get(_COLUMNS)
    os.environ[_COLUMNS] = _WIDEST
    try:
        yield
    finally:
        if before is None:
            del os.environ[_COLUMNS]
        else:
            os.environ[_COLUMNS] = before
