"""The verdicts as a gate takes them: what fails a run, what is known, what is let off: one rule for what CI reads."""

import math
from collections.abc import Iterable
from enum import StrEnum
from typing import NamedTuple

from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report.verdicts import NOTHING_JUDGED, interrupted_in_words, left_aside
from pvlvrt_compliance.results import Results, Status, TestResult, Verdict
from pvlvrt_compliance.results.changes import named


class Outcome(StrEnum):
    """What a verdict is to a gate, worst first, by the names that JUnit has for it."""

    ERROR = "error"
    FAILURE = "failure"
    SKIPPED = "skipped"
    PASSED = "passed"


STOPS = frozenset({Outcome.ERROR, Outcome.FAILURE})
"""What makes a run red."""

_OUTCOME = {
    Status.ERROR: Outcome.ERROR,
    Status.NOT_EVALUATED: Outcome.ERROR,
    Status.FAIL: Outcome.FAILURE,
    Status.PASS: Outcome.PASSED,
    Status.NOT_APPLICABLE: Outcome.SKIPPED,
}


class Told(NamedTuple):
    """A verdict, the test that it is of, the name that no other verdict of the test has, and what it is to a gate."""

    test: TestResult
    name: str
    verdict: Verdict
    outcome: Outcome

    @property
    def reason(self) -> str:
        """Why, in a sentence: of a known failure that it is one, of what is worse than before also that."""
        return reason(self.verdict)


def told(results: Results) -> tuple[Told, ...]:
    """Every verdict of a run, in its order; a test that ended before any check has one of its own."""
    return tuple(each for test in results.tests for each in told_of(test, allow_unjudged=results.allow_unjudged))


def told_of(test: TestResult, *, allow_unjudged: bool = False) -> tuple[Told, ...]:
    """The verdicts of one test."""
    return tuple(Told(test, name, found, outcome(found, allow_unjudged=allow_unjudged)) for name, found in named(test))


def of_the_run(results: Results, found: Iterable[Told]) -> Told | None:
    """What makes a run red besides its verdicts.

    That it was interrupted, or that nothing was judged where none of the verdicts says so by being red.
    """
    if results.interrupted:
        return _told_of_run("finished", Status.ERROR, interrupted_in_words(results))
    if not results.nothing_judged or any(each.outcome in STOPS for each in found):
        return None
    return _told_of_run("judged", Status.NOT_EVALUATED, NOTHING_JUDGED)


def _told_of_run(check: str, status: Status, message: str) -> Told:
    verdict = Verdict(check=check, status=status, message=message)
    return Told(TestResult(id="run", status=verdict.status, checks=(verdict,)), verdict.check, verdict, Outcome.ERROR)


def of_a_part(results: Results) -> Told | None:
    """That a run is a part of what its profiles have, and which: for a list in which what is gone counts as mended."""
    aside = left_aside(results)
    if not aside:
        return None
    message = f"not the whole of what the profiles have: {'; '.join(aside)}"
    verdict = Verdict(check="selection", status=Status.NOT_APPLICABLE, message=message)
    return Told(TestResult(id="run", status=verdict.status, checks=(verdict,)), verdict.check, verdict, Outcome.SKIPPED)


def outcome(verdict: Verdict, *, allow_unjudged: bool = False) -> Outcome:
    """What a verdict is to a gate: a known failure is skipped, and so is what may stay unjudged."""
    return Outcome.SKIPPED if verdict.is_known else _OUTCOME[verdict.counted(allow_unjudged=allow_unjudged)]


def reason(verdict: Verdict) -> str:
    """Why a verdict is what it is to a gate."""
    by_the_baseline = spell.baseline_in_words(verdict)
    if verdict.is_known:
        return by_the_baseline
    return "; ".join(filter(None, [verdict.message, by_the_baseline]))


class Tests(NamedTuple):
    """How many tests of a run there are, by the worst that one has for a gate; they add up to `all`."""

    red: int  # fail the run
    known: int  # have known failures, and nothing that fails the run
    unjudged: int  # have something that was not judged, and may stay so
    good: int

    @property
    def all(self) -> int:
        """How many there are."""
        return sum(self)


def tests(results: Results) -> Tests:
    """Count the tests of a run."""
    groups: list[str] = []
    for test in results.tests:
        found = told_of(test, allow_unjudged=results.allow_unjudged)
        if any(each.outcome in STOPS for each in found):
            groups.append("red")
        elif any(each.verdict.is_known for each in found):
            groups.append("known")
        else:
            unjudged = any(each.verdict.status is Status.NOT_EVALUATED for each in found)
            groups.append("unjudged" if unjudged else "good")
    return Tests(**{name: groups.count(name) for name in Tests._fields})


def worst_first(found: Iterable[Told]) -> list[Told]:
    """In the order in which somebody should read them: by verdict, then by how far from passing (`relative_margin`)."""
    return sorted(found, key=_badness)


def _badness(each: Told) -> tuple[int, float]:
    margin = each.verdict.relative_margin
    return list(Status).index(each.verdict.counted()), -math.inf if margin is None else margin


def numbers_in_words(first: Verdict, *others: Verdict) -> str:
    """All that is known of a verdict besides its message, in a line: ``measured 156.5 kvar; limit at least ...``.

    Of several it is what they have in common.
    """
    theirs = [set(_pieces(other)) for other in others]
    return "; ".join(piece for piece in _pieces(first) if all(piece in pieces for pieces in theirs))


def _pieces(verdict: Verdict) -> list[str]:
    numbers = spell.row(verdict)
    parts = {
        "measured": numbers.measured,
        "limit": spell.limit_in_words(verdict),
        "margin": numbers.margin,
        "uncertainty": numbers.uncertainty,
        "at": spell.number(verdict.at_s, "s"),
        "stretch": verdict.stretch,
        "clause": verdict.clause,
        "confidence": verdict.confidence,
    }
    return [*spell.marks_of(verdict), *(f"{name} {value}" for name, value in parts.items() if value)]


def place_of(test: TestResult, results: Results) -> str | None:
    """File in the repository that a verdict on a test is looked for in: the controller's, else the profile's."""
    files = results.provenance.get("files", {})
    found = files.get("controller") or files.get("profiles", {}).get(test.profile)
    return str(found) if found else None
