"""Hold a run against a baseline: what is known, what is worse, what is better, and what there no longer is."""

from collections.abc import Callable, Collection, Iterator
from typing import NamedTuple

from pvlvrt_compliance.checks.check import RowCheck
from pvlvrt_compliance.checks.registry import find_check
from pvlvrt_compliance.results import (
    BaselineNote,
    BaselineSummary,
    Results,
    Status,
    TestResult,
    Verdict,
)
from pvlvrt_compliance.results.changes import Change, Key, by_key, change_of, named
from pvlvrt_compliance.study.baseline.entries import Baseline, Entry, now_in_words, rounded_margin
from pvlvrt_compliance.study.baseline.reading import BaselineFile
from pvlvrt_compliance.texts import printable

UPDATE = "pvlvrt-check baseline update"
NO_SUCH_TEST = "no such test"
NO_SUCH_CHECK = "no such check in it"

IsGone = Callable[[str], bool]
"""Whether there no longer is a test of a name (profile and id) that is not in the run."""


class Held(NamedTuple):
    """A baseline to hold a run against; ``tolerance`` as of `change_of`."""

    source: BaselineFile
    tolerance: float


def held_against(results: Results, held: Held, is_gone: IsGone) -> Results:
    """The same run with what its baseline says of it; verdicts do not change, what they count as does.

    Parameters
    ----------
    results : Results
    held : Held
        The baseline.
    is_gone : callable
        Of the name of a test that is not in the run.
    """
    baseline, found = held.source.baseline, by_key(results)
    summary = BaselineSummary(
        file=held.source.name,
        digest=held.source.digest,
        tolerance=held.tolerance,
        better=tuple(_better(baseline, found, held.tolerance)),
        gone=tuple(_gone(baseline, results, found, is_gone)),
    )
    tests = tuple(with_baseline(test, held) for test in results.tests)
    return results.model_copy(update={"tests": tests, "baseline": summary})


def says_nothing(verdict: Verdict) -> bool:
    """Whether a verdict is on a row of which not enough runs were selected, which leaves open what it would be."""
    return verdict.status is Status.NOT_APPLICABLE and isinstance(find_check(verdict.check), RowCheck)


def is_judged_in(results: Results) -> Callable[[Key], bool]:
    """Whether a run has judged what a key speaks of, if there is such a thing.

    Where only some checks were selected nobody knows what the others would have found.
    """
    selected = {profile.id: profile.selected_checks for profile in results.profiles}
    judged = {test.key: selected.get(test.profile, ()) for test in results.tests if test.checks}

    def is_judged(key: Key) -> bool:
        only = judged.get(key.test)
        return only is not None and (not only or key.check.partition(" (")[0] in only)

    return is_judged


def with_baseline(test: TestResult, held: Held) -> TestResult:
    """A test whose verdicts say what the baseline makes of them."""
    if not test.checks:
        return test
    entries = held.source.baseline.entries
    checks = tuple(
        verdict.model_copy(update=_marks(entries[key], verdict, held.tolerance)) if key in entries else verdict
        for key, verdict in ((Key(test.key, name), verdict) for name, verdict in named(test))
    )
    return test.model_copy(update={"checks": checks})


def _marks(entry: Entry, verdict: Verdict, tolerance: float) -> dict[str, object]:
    if says_nothing(verdict):
        return {}
    beside = f"was {entry.in_words}; now {now_in_words(verdict)}"
    if change_of(entry.before(verdict), verdict, tolerance) is Change.WORSE:
        return {"worse": beside}
    if verdict.status is not entry.status:  # better
        return {}
    if why := _not_comparable(entry, verdict):
        return {"worse": f"{beside}; the two cannot be compared: {why} ({UPDATE} writes the line anew)"}
    return {"known": True, "known_reason": printable(entry.reason)} if verdict.status is Status.FAIL else {}


def _not_comparable(entry: Entry, verdict: Verdict) -> str:
    """Why nobody can say whether a verdict like that of its entry is worse; an empty text where one can.

    What cannot be compared is never taken for known, or whatever comes would be.
    """
    now = rounded_margin(verdict)
    if entry.margin is None or now is None:
        return "" if entry.margin is now else f"{'the line' if entry.margin is None else 'the verdict'} has no margin"
    return "" if entry.unit == verdict.unit else "the units differ"


def _better(baseline: Baseline, found: dict[Key, Verdict], tolerance: float) -> Iterator[BaselineNote]:
    for key, verdict in found.items():
        entry = baseline.entries.get(key)
        if entry is None or says_nothing(verdict):
            continue
        if change_of(entry.before(verdict), verdict, tolerance) is Change.BETTER:
            yield _note(key, entry, now_in_words(verdict))


def _gone(baseline: Baseline, results: Results, found: Collection[Key], is_gone: IsGone) -> Iterator[BaselineNote]:
    is_judged = is_judged_in(results)
    run = {test.key for test in results.tests}
    for key, entry in baseline.entries.items():
        if key in found:
            continue
        if is_judged(key):
            yield _note(key, entry, NO_SUCH_CHECK)
        elif key.test not in run and is_gone(key.test):
            yield _note(key, entry, NO_SUCH_TEST)


def _note(key: Key, entry: Entry, now: str) -> BaselineNote:
    return BaselineNote(test=key.test, check=key.check, was=entry.in_words, now=now)
