"""A baseline brought up to date with the results of a run."""

from collections.abc import Collection, Iterable, Iterator
from enum import StrEnum
from typing import NamedTuple

from pvlvrt_compliance.results import JUDGED, Results, Status, Verdict
from pvlvrt_compliance.results.changes import Key, by_key
from pvlvrt_compliance.study.baseline.applying import NO_SUCH_CHECK, is_judged_in, says_nothing
from pvlvrt_compliance.study.baseline.entries import KEPT, Baseline, Entry, entry_of, now_in_words, rounded_off
from pvlvrt_compliance.texts import one_line

NOT_RUN = "not in this run"


class Kind(StrEnum):
    """What an update does to an entry."""

    ADDED = "added"
    CHANGED = "changed"
    DROPPED = "dropped"


class Step(NamedTuple):
    """What an update does to one entry: ``was`` and ``now`` are None where there is no entry before or after it."""

    kind: Kind
    key: Key
    was: Entry | None
    now: Entry | None
    why: str = ""

    @property
    def in_words(self) -> str:
        """A line: ``+ current_limit in p.VD1: fail, -0.086 pu``."""
        place = one_line(f"{self.key.check} in {self.key.test}")
        if self.now is None:
            reason = f" # {self.was.reason}" if self.was and self.was.reason else ""
            return f"- {place}: {self.was.in_words if self.was else ''}; now {self.why}{reason}"
        before = f"; was {self.was.in_words}" if self.was else ""
        return f"{'~' if self.was else '+'} {place}: {self.now.in_words}{before}"


class Update(NamedTuple):
    """A baseline after a run, and how it came to be.

    Parameters
    ----------
    baseline : Baseline
        Of now.
    steps : tuple of Step
        What is not as it was.
    not_run : int
        Entries that stay since their test was not run.
    unjudged : tuple of Key
        Verdicts that could not be had: they never are in a baseline, and entries on them stay.
    """

    baseline: Baseline
    steps: tuple[Step, ...]
    not_run: int
    unjudged: tuple[Key, ...]

    def count(self, kind: Kind) -> int:
        """How many entries were added, changed or dropped."""
        return sum(step.kind is kind for step in self.steps)

    @property
    def without_reason(self) -> int:
        """How many failures nobody has given a reason for."""
        entries = self.baseline.entries.values()
        return sum(entry.status is Status.FAIL and not entry.reason for entry in entries)


def updated(
    before: Baseline, results: Results, *, margins: bool | None = None, prune: bool = False, reason: str = ""
) -> Update:
    """Bring a baseline up to date.

    Parameters
    ----------
    before : Baseline
        As it is; an empty one for a new file.
    results : Results
        Of a run. What it could not judge, or has not run, leaves entries as they are.
    margins : bool, optional
        Whether what passed has an entry, too, so that a lost margin is seen; by default as it is in ``before``.
    prune : bool
        Whether entries of tests that were not run go.
    reason : str
        Of the failures that have none.
    """
    wanted = KEPT if (before.has_passes if margins is None else margins) else (Status.FAIL,)
    found = by_key(results)
    entries: dict[Key, Entry] = {}
    steps: list[Step] = []
    for key, verdict in found.items():
        was = before.entries.get(key)
        now = was if _leaves_open(verdict) else _entry(key, verdict, was, wanted, reason)
        steps += _step(key, was, now, now_in_words(verdict))
        if now is not None:
            entries[key] = now
    is_judged = is_judged_in(results)
    run = {test.key for test in results.tests}
    not_run = 0
    for key, was in before.entries.items():
        if key in found:
            continue
        gone = NO_SUCH_CHECK if is_judged(key) else NOT_RUN if prune and key.test not in run else ""
        if gone:
            steps += _step(key, was, None, gone)
        else:
            entries[key] = was
            not_run += key.test not in run
    unjudged = tuple(key for key, verdict in found.items() if verdict.status in (Status.ERROR, Status.NOT_EVALUATED))
    return Update(Baseline(entries, before.below), tuple(_in_order(steps)), not_run, unjudged)


def _leaves_open(verdict: Verdict) -> bool:
    return verdict.status in (Status.ERROR, Status.NOT_EVALUATED) or says_nothing(verdict)


def _entry(key: Key, verdict: Verdict, was: Entry | None, wanted: Collection[Status], reason: str) -> Entry | None:
    """The entry of a verdict; the one that is there where it still says what was found."""
    if verdict.status not in wanted or verdict.status not in JUDGED:
        return None
    now = entry_of(key, verdict)._replace(above=was.above if was else ())
    new_reason = reason if now.status is Status.FAIL else ""
    if was is None or was.status is not now.status:  # a reason for the one is none for the other
        return now._replace(reason=new_reason)
    kept = was if _is_as_rounded(was, now, verdict) else now
    return kept._replace(reason=was.reason or new_reason)


def _is_as_rounded(was: Entry, now: Entry, verdict: Verdict) -> bool:
    if was.margin is None or now.margin is None or verdict.margin is None:
        return was.margin is now.margin
    return was.unit == now.unit and abs(float(was.margin) - verdict.margin) <= rounded_off(was.margin, verdict)


def _step(key: Key, was: Entry | None, now: Entry | None, found: str) -> Iterator[Step]:
    if was is None and now is not None:
        yield Step(Kind.ADDED, key, None, now)
    elif was is not None and now is None:
        yield Step(Kind.DROPPED, key, was, None, found)
    elif was != now:
        yield Step(Kind.CHANGED, key, was, now)


def _in_order(steps: Iterable[Step]) -> list[Step]:
    return sorted(steps, key=lambda step: list(Kind).index(step.kind))
