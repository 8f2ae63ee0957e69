"""What is given in Python, as a job takes it, and as a report tells it."""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields
from os import PathLike, fspath
from typing import Any

from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.study.job import HOW, Asked

File = str | PathLike[str]

_SPELLED = {"list_only": "Profile.tests()", "help": "docs/api.md"}  # what a message calls otherwise than its keyword


def listed(given: "File | Profile | Sequence[File | Profile]") -> tuple[str | Profile, ...]:
    """Profiles as a job takes them."""
    items = (given,) if isinstance(given, str | PathLike | Profile) else given
    return tuple(item if isinstance(item, Profile) else fspath(item) for item in items)


def texts(given: str | Sequence[str]) -> tuple[str, ...]:
    """One text or several, as a tuple."""
    return (given,) if isinstance(given, str) else tuple(given)


def assignments(settings: Mapping[str, Any] | Sequence[str]) -> tuple[str, ...]:
    """Parameters as the command takes them."""
    if isinstance(settings, Mapping):
        return tuple(f"{name}={json.dumps(value)}" for name, value in settings.items())
    return texts(settings)


def spell(name: str) -> str:
    """How a message names a keyword."""
    return _SPELLED.get(name, name)


def told(asked: Asked) -> dict[str, Any]:
    """What was asked for, without what is as it is unless it is given, and without how it is run."""
    return {
        field.name: getattr(asked, field.name)
        for field in fields(asked)
        if field.name not in HOW and getattr(asked, field.name) != field.default
    }


def call(function: str, given: Mapping[str, Any]) -> str:
    """The call that makes a run again, as it is written in Python."""
    words = ", ".join(f"{name}={_written(value)}" for name, value in given.items())
    return f"pvlvrt_compliance.{function}({words})"


def _written(value: Any) -> str:
    if isinstance(value, Profile):
        return repr(value.id)
    if isinstance(value, tuple):
        return f"[{', '.join(map(_written, value))}]"
    made: Callable[..., Any] | None = value if callable(value) else None
    if made is None and hasattr(value, "sample_time_s"):  # a controller, of which nobody knows how it was made
        return f"{type(value).__qualname__}(...)"
    return repr(value) if made is None else str(getattr(made, "__qualname__", type(made).__name__))
