"""Whether a verdict is better or worse than an earlier one: one rule for baselines and comparisons."""

from collections import Counter
from collections.abc import Iterator
from enum import StrEnum
from typing import NamedTuple

from pvlvrt_compliance.results.results import Results, TestResult
from pvlvrt_compliance.results.verdict import JUDGED, UNSETTLED, Status, Verdict

BEST_FIRST = (Status.PASS, Status.NOT_APPLICABLE, Status.FAIL, Status.NOT_EVALUATED, Status.ERROR)
"""Verdicts by how good they are for a gate: what was judged and no longer is, is worse than before."""


class Key(NamedTuple):
    """What a verdict speaks of, in every run: test, with its profile, and check.

    Where a test has several verdicts of one check, the second is ``check (2)``, as in junit.xml.
    """

    test: str
    check: str


class Change(StrEnum):
    """How a verdict stands to the earlier one."""

    WORSE = "worse"
    SAME = "same"
    BETTER = "better"


class Earlier(NamedTuple):
    """What is kept of an earlier verdict; ``rounding`` is what its margin may have lost by it, in ``unit``."""

    status: Status
    margin: float | None = None
    unit: str = ""
    rounding: float = 0.0


def by_key(results: Results) -> dict[Key, Verdict]:
    """Every verdict of a run, in its order; a test that ended before any check has one of its own, ``test``."""
    return {Key(test.key, name): verdict for test in results.tests for name, verdict in named(test)}


def named(test: TestResult) -> Iterator[tuple[str, Verdict]]:
    """The verdicts of a test in their order, each by a name that no other of them has."""
    seen: Counter[str] = Counter()
    for verdict in test.checks or (Verdict(check="test", status=test.status, message="no check was evaluated"),):
        seen[verdict.check] += 1
        number = f" ({seen[verdict.check]})" if seen[verdict.check] > 1 else ""
        yield verdict.check + number, verdict


def not_selected(old: Results, new: Results) -> Iterator[Key]:
    """Verdicts of an old run that a new one was not asked for; what it has not come to it was asked for."""
    profiles = {profile.id: profile for profile in new.profiles}
    for test in old.tests:
        profile = profiles.get(test.profile)
        if profile is None:
            continue
        for name, verdict in named(test):
            is_judged = not profile.selected_checks or verdict.check in profile.selected_checks
            if test.id in profile.not_selected or not is_judged:
                yield Key(test.key, name)


def change_of(earlier: Earlier, verdict: Verdict, tolerance: float | None = None) -> Change:
    """How a verdict stands to an earlier one.

    Parameters
    ----------
    earlier : Earlier
        On the same thing.
    verdict : Verdict
        The one of now.
    tolerance : float, optional
        By how much its margin may differ, as a share of what margins are measured by (`margin_lost`). None: only the
        verdicts count.
    """
    if earlier.status is not verdict.status:
        worse = BEST_FIRST.index(verdict.status) > BEST_FIRST.index(earlier.status)
        return Change.WORSE if worse else Change.BETTER
    lost = margin_lost(earlier, verdict) if verdict.status in JUDGED else None
    if tolerance is None or lost is None or abs(lost) <= tolerance + earlier.rounding / scale_of(verdict):
        return Change.SAME
    return Change.WORSE if lost > 0 else Change.BETTER


def change_by_appearing(verdict: Verdict) -> Change:
    """How a verdict changes things that has no earlier one: what nobody looked into before may not begin unsettled."""
    if verdict.status in UNSETTLED:
        return Change.WORSE
    return Change.BETTER if verdict.status is Status.PASS else Change.SAME


def change_by_leaving(earlier: Earlier) -> Change:
    """How it changes things that a verdict has no later one.

    Worse, even of a failure: evidence that is gone shows nothing, and to leave a test out must never look like a
    repair. Only what was not applicable has shown nothing before.
    """
    return Change.SAME if earlier.status is Status.NOT_APPLICABLE else Change.WORSE


def margin_lost(earlier: Earlier, verdict: Verdict) -> float | None:
    """What a margin has lost (negative: gained), as a share of |limit| + tolerance of now, as of `relative_margin`.

    None where one of them has no margin, their units differ, or there is nothing to divide by.
    """
    scale = scale_of(verdict)
    if earlier.margin is None or verdict.margin is None or earlier.unit != verdict.unit or scale <= 0:
        return None
    return (earlier.margin - verdict.margin) / scale


def scale_of(verdict: Verdict) -> float:
    """What margins of a verdict are measured by, in its unit: |limit| + tolerance; 0 where there is neither."""
    return abs(verdict.limit or 0.0) + verdict.tolerance
