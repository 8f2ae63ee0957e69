"""What GitHub's runner reads in the output of a step: lines that command it, and how a text is none.

The runner takes a line as a command where it begins with ``::``, white space before it or not, and, in an older form,
where ``##[`` stands anywhere in it (actions/runner, ActionCommand.cs). Lines end with a line feed, a carriage return,
or both. Of a command it knows, ``%25`` is a percent sign, ``%0D`` and ``%0A`` are ends of lines, and in its properties
``%3A`` and ``%2C`` colon and comma.
"""

import os
import re

RUNNER = "GITHUB_ACTIONS"
"""Environment variable that the runner sets to ``true`` for every step."""

_BEGINS = re.compile(r"(^|[\r\n])(\s*):(?=:)")
_OLDER = "##["


def is_read() -> bool:
    """Whether a runner reads what this process prints."""
    return os.environ.get(RUNNER) == "true"


def workflow_command(kind: str, message: str, **properties: str) -> str:
    """A line that tells the runner something: an ``error``, ``warning`` or ``notice``; an empty property is none."""
    given = ",".join(f"{name}={_property(value)}" for name, value in properties.items() if value)
    return f"::{kind}{' ' if given else ''}{given}::{_data(message)}"


def harmless(text: str) -> str:
    """Whole lines in which nothing is a command; what would be one is kept readable."""
    return _BEGINS.sub(r"\1\2: ", text).replace(_OLDER, "## [")


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A").replace(_OLDER, "## [")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
