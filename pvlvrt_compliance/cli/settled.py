"""What holds for a command: its options over the environment over a file of settings."""

import os
from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from pvlvrt_compliance.cli.options import SETTINGS, given_options
from pvlvrt_compliance.cli.telling import tell
from pvlvrt_compliance.settings.effective import Effective, effective
from pvlvrt_compliance.settings.reading import Level

_TYPED = Level.COMMAND_LINE


def settled(values: Mapping[str, Any], fields: Collection[str] | None = None) -> Effective:
    """What holds, of the options as typer gives them; says on stderr what was taken from where.

    With ``fields``, file and environment are asked for these alone.

    Raises
    ------
    UsageError
        When a file of settings or a variable cannot be used, or the nearest file is of somebody else.
    """
    holds = of_options(values).to_run_by()
    if fields is not None:
        used = {name: value for name, value in holds.values.items() if name in fields or value.level is _TYPED}
        holds = replace(holds, values=used)
    for warning in holds.warnings:
        tell(warning)
    if not holds.given.get("quiet"):
        for line in filter(None, (holds.in_words, *holds.put_aside)):
            tell(line)
    return holds


def of_options(values: Mapping[str, Any]) -> Effective:
    """The same without a word, and also where the nearest file is of somebody else: it is left out then."""
    where, typed = given_options(values, ("config", "isolated"))
    return effective(SETTINGS, typed, os.environ, start=Path.cwd(), **where)
