"""What a worker must have in common with the process that asks: versions, and the text of what decides a verdict."""

import inspect
import json
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path

from pvlvrt_compliance.checks.registry import find_check
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.study.provenance import versions
from pvlvrt_compliance.study.sources import digest_of_content, digest_of_file, of_results

_SOURCES = "digest of pvlvrt-compliance's files"


def identity(kinds: Iterable[str] = ()) -> dict[str, str]:
    """What the results of this process go by, in words.

    Parameters
    ----------
    kinds : iterable of str
        Kinds of checks that the job judges: those of other packages go by the text of their module.
    """
    return {**versions(), _SOURCES: _sources(), **_of_others(kinds)}


def kinds_of(profiles: Iterable[Profile]) -> tuple[str, ...]:
    """Kinds of checks that profiles ask for."""
    return tuple(sorted({kind for profile in profiles for kind, _ in profile.requirements.by_kind()}))


def differences(needed: Mapping[str, str], found: Mapping[str, str]) -> str:
    """In which of its parts an identity is another than the one that is needed; empty where it is the same."""
    others = [name for name in needed if found.get(name) != needed[name]]
    return ", ".join(f"{name} {_short(found.get(name))} where {_short(needed[name])} is needed" for name in others)


@cache
def _sources() -> str:
    return digest_of_content(json.dumps(of_results()).encode())


def _of_others(kinds: Iterable[str]) -> dict[str, str]:
    """Digests of the modules of checks that do not come with this package."""
    own = __name__.partition(".")[0]
    checks = {kind: find_check(kind) for kind in kinds}
    modules = {kind: inspect.getmodule(type(check)) for kind, check in checks.items() if check is not None}
    return {
        f"check {kind}": digest_of_file(Path(module.__file__))
        for kind, module in modules.items()
        if module is not None and module.__file__ and module.__name__.partition(".")[0] != own
    }


def _short(value: str | None) -> str:
    """A version as it is, of a digest as much as a person compares."""
    return "none" if value is None else value[:12]
