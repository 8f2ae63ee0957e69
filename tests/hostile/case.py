"""What a case is, and what lies ready for all."""

from collections.abc import Mapping
from functools import cache
from typing import NamedTuple

from tests.hostile import options, runs, seeds
from tests.hostile.damage import File

OUT = "out"
"""Folder that a case writes to, unless it says another."""

EVALUATE = "evaluate"
"""In place of a command: the function `pvlvrt_compliance.evaluate`, with a profile and a file."""

SHORT = ("--sag", "50%", "--duration", "20ms")
QUICK = ("--jobs", "1", "--output", OUT)


class Case(NamedTuple):
    """What is run, and on what."""

    kind: str
    arguments: tuple[str, ...]
    files: Mapping[str, File] = {}
    environment: Mapping[str, str] = {}
    writes: tuple[str, ...] = (OUT, "pvlvrt-report", "pvlvrt-comparison")
    encoding: str = "utf-8"

    @property
    def simulates(self) -> bool:
        """Whether it may take as long as a simulation does: it is a run that is not only shown, or a comparison."""
        first = next(iter(self.arguments), "")
        return "--list" not in self.arguments and (first in ("compare", "merge") or first.startswith("-"))


@cache
def ready() -> dict[str, File]:
    """All files that lie ready."""
    return seeds.made() | runs.files()


@cache
def commands() -> list[options.Command]:
    """All commands, the main one first."""
    return options.commands()
