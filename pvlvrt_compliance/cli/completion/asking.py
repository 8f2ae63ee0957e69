"""An option or argument whose values a shell completes, without loading what knows them before one is asked for."""

from collections.abc import Callable
from importlib import import_module
from typing import Any

import typer

from pvlvrt_compliance.texts import one_line

_VALUES = "pvlvrt_compliance.cli.completion.values"

Candidates = list[tuple[str, str]]
"""Words, each with what it means."""


def completer(name: str) -> Callable[[typer.Context, str], Candidates]:
    """What typer calls for the values of an option: a function of `values`, found when a shell asks.

    A shell that asks in the middle of a line has no use for an error: there is nothing to be offered then.
    """

    def candidates(context: typer.Context, incomplete: str) -> Candidates:
        try:
            asked: Callable[[Any, str], Candidates] = getattr(import_module(_VALUES), name)
            found = asked(context, incomplete)
        except Exception:  # whatever a half-written line, a file or another package raises
            return []
        return [(word, _one_line(meaning)) for word, meaning in found if word.startswith(incomplete)]

    return candidates


def _one_line(text: str) -> str:
    """A text that neither ends the line of a shell's list nor is read as markup by typer."""
    return one_line(text).replace("[", "(").replace("]", ")")
