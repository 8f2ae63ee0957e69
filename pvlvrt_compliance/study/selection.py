"""Which tests of the profiles are run."""

from collections.abc import Callable, Sequence
from fnmatch import fnmatchcase
from typing import NamedTuple

from pvlvrt_compliance.errors import UsageError, did_you_mean
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.profile.profile import Profile


class Assignment(NamedTuple):
    """A test, and the profile that judges it."""

    profile: Profile
    test: TestCase


def select(
    found: Sequence[Assignment], patterns: Sequence[str], spell: Callable[[str], str] = str
) -> tuple[Assignment, ...]:
    """Tests whose id matches any of the shell-style patterns (``VD3*``), upper and lower case alike.

    Without patterns, all of them. A pattern may begin with the profile's id and a dot. ``spell`` says how a message
    names the patterns (``tests``) and the list of all tests (``list_only``).

    Raises
    ------
    UsageError
        When a pattern matches no test, with the near misses.
    """
    if not patterns:
        return tuple(found)
    for pattern in patterns:
        if not any(_matches(item, pattern) for item in found):
            ids = [item.test.id for item in found]
            hint = did_you_mean(pattern, ids) or f"; the profile has {ids[0]} to {ids[-1]}" if ids else ""
            said = f"{spell('tests')} {pattern}: no test of this name{hint} ({spell('list_only')} shows all)"
            raise UsageError(said)
    return tuple(item for item in found if any(_matches(item, pattern) for pattern in patterns))


def keep_short(found: Sequence[Assignment], patterns: Sequence[str]) -> tuple[Assignment, ...]:
    """The tests without the long ones, but with those that a pattern names in full."""
    named = {pattern.lower() for pattern in patterns}
    return tuple(item for item in found if not item.test.long or item.test.id.lower() in named)


def _matches(item: Assignment, pattern: str) -> bool:
    of_profile = f"{item.profile.id}.".lower()
    return fnmatchcase(item.test.id.lower(), pattern.lower().removeprefix(of_profile))
