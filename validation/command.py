"""The command behind each page: write it, or compare with ``--check``."""

import argparse
import sys
from collections.abc import Callable
from typing import NamedTuple


class MissingProgramError(Exception):
    """A program that the evidence needs is not installed; its text says which."""


class Outcome(NamedTuple):
    """What a command has to say."""

    problems: list[str]
    summary: str  # said when there is no problem


def run(package: str | None, doc: str | None, work: Callable[[bool], Outcome]) -> int:
    """Run ``work(check)``, print what it found; exit status 0, 1 with a problem, 2 when it cannot run.

    ``package`` and ``doc`` are ``__package__`` and ``__doc__`` of the caller.
    """
    parser = argparse.ArgumentParser(f"python -m {package}", description=doc)
    parser.add_argument("--check", action="store_true", help="compare with the page, write nothing")
    check = parser.parse_args().check
    try:
        problems, summary = work(check)
    except MissingProgramError as error:
        print(error, file=sys.stderr)
        return 2
    print("\n".join(problems) or summary)
    return 1 if problems else 0
