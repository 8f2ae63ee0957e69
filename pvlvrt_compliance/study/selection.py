"""Which tests of the profiles are run, and which checks judge them."""

import re
from collections.abc import Callable, Collection, Sequence
from fnmatch import fnmatchcase
from typing import NamedTuple

from pvlvrt_compliance.checks.check import RowCheck
from pvlvrt_compliance.checks.registry import find_check, judges_connection
from pvlvrt_compliance.errors import UsageError, did_you_mean, spelled_of
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.profile.profile import Profile

Spell = Callable[[str], str]
"""How a message names the fields ``tests``, ``skip`` and ``checks``, and the list of all tests (``list_only``)."""

FURTHER = "-further-"
"""Stands between the id of a row and the number of a further run of it."""

_WILD = re.compile(r"[*?\[]")
"""What makes a pattern more than a name."""


class Assignment(NamedTuple):
    """A test, and the profile that judges it."""

    profile: Profile
    test: TestCase

    @property
    def key(self) -> str:
        """That of its result: profile and id."""
        return f"{self.profile.id}.{self.test.id}"

    @property
    def names(self) -> tuple[str, ...]:
        """What selects it: its id, and those of the row that it is a run of, at its power and at any."""
        row = self.test.row
        return tuple(dict.fromkeys(filter(None, (self.test.id, row, row and self.profile.row_of(self.test)))))


def select(found: Sequence[Assignment], patterns: Sequence[str], spell: Spell = str) -> tuple[Assignment, ...]:
    """Tests whose id, or that of whose row, matches any of the shell-style patterns (``VD3*``), whatever the case.

    Without patterns, all of them. A pattern may begin with the profile's id and a dot.

    Raises
    ------
    UsageError
        When a pattern matches no test, with the near misses.
    """
    if not patterns:
        return tuple(found)
    _refuse_idle(found, patterns, "tests", spell)
    return _matching(found, patterns)


def skip(
    found: Sequence[Assignment], patterns: Sequence[str], everything: Sequence[Assignment], spell: Spell = str
) -> tuple[Assignment, ...]:
    """The tests without those that a pattern matches, as of `select`.

    Parameters
    ----------
    found : sequence of Assignment
        Of which some are skipped.
    patterns : sequence of str
    everything : sequence of Assignment
        All tests of the profiles: what nobody has selected may be skipped all the same.
    spell : callable

    Raises
    ------
    UsageError
        When a pattern matches no test at all, or nothing is left.
    """
    _refuse_idle(everything, patterns, "skip", spell)
    skipped = {item.key for item in _matching(found, patterns)}
    left = tuple(item for item in found if item.key not in skipped)
    if found and not left:
        raise UsageError(f"{spell('skip')} {', '.join(patterns)}: all {len(found)} tests selected are skipped")
    return left


def keep_short(found: Sequence[Assignment], patterns: Sequence[str]) -> tuple[Assignment, ...]:
    """The tests without the long ones, but with those that a pattern names in full, or by their row."""
    named = {pattern.lower() for pattern in patterns}
    return tuple(item for item in found if not item.test.long or named & {name.lower() for name in item.names})


def kinds_judged(profile: Profile, names: Collection[str]) -> tuple[str, ...]:
    """Kinds of a profile's requirements that are judged where only these are asked for; without names, none.

    A rule on rows goes by what the checks of the connection say, which are then judged, too.
    """
    kinds = [kind for kind, _ in profile.requirements.by_kind()]
    by_rows = any(isinstance(find_check(kind), RowCheck) for kind in kinds if kind in names)
    return tuple(kind for kind in kinds if kind in names or (by_rows and judges_connection(kind)))


def judge_only(
    profiles: Sequence[Profile], found: Sequence[Assignment], names: Sequence[str], spell: Spell = str
) -> tuple[Assignment, ...]:
    """The tests that any of these checks judges, each to be judged by no other; without names, all as they are.

    Raises
    ------
    UsageError
        When no profile has such a requirement, or it judges none of the tests.
    """
    if not names:
        return tuple(found)
    known = list(dict.fromkeys(kind for profile in profiles for kind, _ in profile.requirements.by_kind()))
    of_profiles = ", ".join(profile.id for profile in profiles)
    for name in names:
        asked = f"{spelled_of(spell, 'checks', name)} {name}"
        if name not in known:
            hint = did_you_mean(name, known) or f"; there are: {', '.join(known)}"
            raise UsageError(f"{asked}: no check of {of_profiles}{hint}")
        if found and not any(_judges(item, name) for item in found):
            raise UsageError(f"{asked}: judges none of the {len(found)} tests selected")
    only = {profile.id: kinds_judged(profile, names) for profile in profiles}
    return tuple(
        Assignment(item.profile, item.test.model_copy(update={"only": only[item.profile.id]}))
        for item in found
        if any(_judges(item, name) for name in names)
    )


def row_of_further(test: str) -> str:
    """Id of the row that a further run is of, by its own id; nothing of any other test."""
    row, _, number = test.rpartition(FURTHER)
    return row if number.isdecimal() else ""


def _judges(item: Assignment, kind: str) -> bool:
    return item.test.has(kind) and item.profile.requirements.of_kind(kind) is not None


def _refuse_idle(found: Sequence[Assignment], patterns: Sequence[str], field: str, spell: Spell) -> None:
    named = _by_profile(found)
    for pattern in patterns:
        if not any(_Patterns(profile, [pattern]).fit(names) for profile, names in named.items()):
            ids = [item.test.id for item in found]
            known = dict.fromkeys(name for item in found for name in item.names)
            hint = did_you_mean(pattern, known) or f"; the profile has {ids[0]} to {ids[-1]}" if ids else ""
            asked = f"{spelled_of(spell, field, pattern)} {pattern}"
            said = f"{asked}: no test of this name{hint} ({spell('list_only')} shows all)"
            raise UsageError(said)


def _matching(found: Sequence[Assignment], patterns: Sequence[str]) -> tuple[Assignment, ...]:
    of = {profile: _Patterns(profile, patterns) for profile in _by_profile(found)}
    return tuple(item for item in found if of[item.profile.id].fit({name.lower() for name in item.names}))


def _by_profile(found: Sequence[Assignment]) -> dict[str, set[str]]:
    """Names of tests, in small letters, by the id of their profile."""
    named: dict[str, set[str]] = {}
    for item in found:
        named.setdefault(item.profile.id, set()).update(name.lower() for name in item.names)
    return named


class _Patterns:
    """Patterns as they select tests of one profile: whole names, which are looked up, and all others."""

    def __init__(self, profile: str, patterns: Sequence[str]) -> None:
        asked = [pattern.lower().removeprefix(f"{profile}.".lower()) for pattern in patterns]
        self._whole = {pattern for pattern in asked if not _WILD.search(pattern)}
        self._others = [pattern for pattern in asked if pattern not in self._whole]

    def fit(self, names: Collection[str]) -> bool:
        """Whether any of them matches any of the names."""
        if not self._whole.isdisjoint(names):
            return True
        return any(fnmatchcase(name, pattern) for pattern in self._others for name in names)
