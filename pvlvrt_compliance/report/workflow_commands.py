"""What GitHub's runner reads in the output of a step: lines that command it (`texts.harmless` has those that do not).

Of a command the runner knows, ``%25`` is a percent sign, ``%0D`` and ``%0A`` are ends of lines, and in its properties
``%3A`` and ``%2C`` colon and comma (actions/runner, ActionCommand.cs).
"""

import os

from pvlvrt_compliance.texts import harmless

RUNNER = "GITHUB_ACTIONS"
"""Environment variable that the runner sets to ``true`` for every step."""


def is_read() -> bool:
    """Whether a runner reads what this process prints."""
    return os.environ.get(RUNNER) == "true"


def workflow_command(kind: str, message: str, **properties: str) -> str:
    """A line that tells the runner something: an ``error``, ``warning`` or ``notice``; an empty property is none."""
    given = ",".join(f"{name}={_property(value)}" for name, value in properties.items() if value)
    return f"::{kind}{' ' if given else ''}{given}::{_data(message)}"


def _data(text: str) -> str:
    return harmless(text).replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
