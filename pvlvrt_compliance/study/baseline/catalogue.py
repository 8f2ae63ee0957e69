"""Which tests a run could have had: an entry of a baseline on any other is of one that is gone."""

from collections.abc import Collection
from functools import cache, cached_property

from pvlvrt_compliance.data.search_path import known_profiles
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.profile.profile import Profile, is_ad_hoc
from pvlvrt_compliance.study.selection import row_of_further


class Catalogue:
    """The tests of the profiles of a run.

    Parameters
    ----------
    profiles : collection of Profile
        Of the run.
    finished : collection of str
        Names (profile and id) of the tests that were run.
    """

    def __init__(self, profiles: Collection[Profile], finished: Collection[str]) -> None:
        self._profiles = {profile.id: profile for profile in profiles}
        self._finished = set(finished)
        self._rows = cache(lambda of: _rows_of(self._profiles[of]))

    @cached_property
    def _others(self) -> Collection[str] | None:
        """Names of all profiles; None where they cannot be had, which must not cost a run its results."""
        try:
            return known_profiles()
        except UsageError:
            return None

    def is_gone(self, name: str) -> bool:
        """Whether one of these profiles had a test of this name and has it no longer.

        A sag of the user's own is in no table, and never gone; a further run of a row is when all of its row was run
        without asking for it. Of another profile that can be named nothing is known; a test of none
        at all is misspelt, or of a profile that there no longer is.
        """
        owner = max((of for of in self._profiles if name.startswith(f"{of}.")), key=len, default=None)
        if owner is None:
            others = self._others
            return others is not None and not any(name.startswith(f"{of}.") for of in others)
        test, rows = name.removeprefix(f"{owner}."), self._rows(owner)
        if is_ad_hoc(test) or any(test in ids for ids in rows.values()):
            return False
        own = rows.get(row_of_further(test), set())
        return {f"{owner}.{each}" for each in own} <= self._finished


def _rows_of(profile: Profile) -> dict[str, set[str]]:
    """Ids of the tests of each row."""
    rows: dict[str, set[str]] = {}
    for case in profile.tests():
        rows.setdefault(case.row, set()).add(case.id)
    return rows
