"""Coverage: every clause that a profile knows, tested or not, and what the code has that the profile has not."""

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence, Set
from functools import partial
from typing import Literal, NamedTuple

from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report.document.clauses import Judgement, counted, kinds_of, why_without_verdict
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.results import (
    JUDGED,
    UNSETTLED,
    ClauseSummary,
    NotCoveredSummary,
    ProfileSummary,
    Results,
    Status,
    TestResult,
    Verdict,
    worst,
)

State = Literal["error", "not_evaluated", "fail", "pass", "not_tested", "not_covered"]
"""What became of a clause; the first four are the worst verdict on it."""

STATES: tuple[State, ...] = ("error", "not_evaluated", "fail", "pass", "not_tested", "not_covered")

_SYMBOL = {"not_tested": "–", "not_covered": "·"}
_OF_VOLTAGE = "ride_through"  # the requirement that envelopes and regions of the voltage are part of
_NUMBER = re.compile(r"[+-]?\d+(\.\d+)?")


class CoverageRow(NamedTuple):
    """A clause, and what became of it."""

    clause: str
    about: tuple[str, ...]  # checks, parts of requirements and tests that are of it, in words
    state: State
    state_word: str
    symbol: str
    run: int  # tests of this run that are of it
    judged: int  # of these, in how many it passed or failed
    tests: tuple[tuple[int, str], ...]  # number and id of those that failed, the worst first; else the nearest to it
    worst: Judgement | None  # the verdict with the least margin among them
    margin: str  # of that verdict, with its unit; empty where another part of the requirement decided it
    reason: str  # why it was not judged, a sentence
    detail: str  # the commonest reason, quoted as the checks tell it, or the profile's: in English
    confidence: str


class Coverage(NamedTuple):
    """The coverage of one profile."""

    profile: ProfileSummary
    rows: tuple[CoverageRow, ...]
    tally: tuple[tuple[State, str, int], ...]  # states that occur, in words, with how many clauses


def coverage(results: Results, texts: Texts) -> tuple[Coverage, ...]:
    """Coverage of each profile of a run.

    Parameters
    ----------
    results : Results
        Of a version that told no clauses: those profiles are left out.
    texts : Texts
        Words of the report's language; what checks and profiles say themselves stays in English.
    """
    numbered = list(enumerate(results.tests, start=1))
    found = []
    for profile in results.profiles:
        if not profile.clauses and not profile.not_covered:
            continue
        tests = [(number, test) for number, test in numbered if test.profile == profile.id]
        rows = [_row(clause, profile, tests, texts) for clause in profile.clauses]
        rows += [_not_covered(entry, texts) for entry in profile.not_covered]
        found.append(Coverage(profile, tuple(rows), _tally(rows, texts)))
    return tuple(found)


def _row(
    clause: ClauseSummary, profile: ProfileSummary, tests: Sequence[tuple[int, TestResult]], texts: Texts
) -> CoverageRow:
    own = {kind: each.clause for each in profile.clauses for kind in each.checks}
    known = {(kind, each.clause) for each in profile.clauses for kind in kinds_of(each)}
    said = [
        Judgement(number, test, verdict)
        for number, test in tests
        for verdict in test.checks
        if _speaks_of(clause, test, verdict, own, known)
    ]
    said, partly = counted(clause, profile, said)
    status = worst(each.verdict.status for each in said)
    state: State = "not_tested" if status is Status.NOT_APPLICABLE else _STATE_OF[status]
    at_worst = sorted((each for each in said if each.verdict.status is status), key=partial(_by_margin, texts, clause))
    reason, detail = _reason(clause, profile, tests, at_worst, texts)
    if partly:
        reason = texts(f"coverage.reason.{partly}")
    nearest = at_worst[0] if at_worst and status in JUDGED | UNSETTLED else None
    # Of what passed, the test that was nearest to failing is enough.
    listed = dict.fromkeys((each.number, each.test.id) for each in at_worst[: 1 if status is Status.PASS else None])
    return CoverageRow(
        clause=clause.clause,
        about=_about(clause, texts),
        state=state,
        state_word=texts.named("coverage.state", state),
        symbol=_SYMBOL.get(state, spell.STATUS_SYMBOL[status]),
        run=len({each.number for each in said}),
        judged=len({each.number for each in said if each.verdict.status in JUDGED}),
        tests=tuple(listed) if nearest else (),
        worst=nearest,
        margin=spell.row(nearest.verdict, texts).margin if nearest and _decided(clause, nearest) else "",
        reason=reason,
        detail=detail,
        confidence=clause.confidence,
    )


_STATE_OF: dict[Status, State] = {
    Status.ERROR: "error",
    Status.NOT_EVALUATED: "not_evaluated",
    Status.FAIL: "fail",
    Status.PASS: "pass",
}


def _speaks_of(
    clause: ClauseSummary,
    test: TestResult,
    verdict: Verdict,
    own: Mapping[str, str],
    known: Set[tuple[str, str]],
) -> bool:
    """Whether a verdict is of a clause.

    It is of the clause of its requirement, of that of the test, and of those of the requirement's parts, unless it
    names another part, which decided, or the row of the test table alone did. A voltage that never moved has passed
    no limit of the voltage.

    Parameters
    ----------
    own
        The clause of each kind of requirement.
    known
        Kinds of requirements, each with a clause that it or one of its parts has.
    """
    if test.id in clause.tests:
        return True
    if verdict.check not in kinds_of(clause) or _passed_untouched(test, verdict):
        return False
    if verdict.clause == test.clause and (verdict.check, verdict.clause) not in known:
        return False
    return verdict.check in clause.checks or verdict.clause in {clause.clause, own.get(verdict.check)}


def _passed_untouched(test: TestResult, verdict: Verdict) -> bool:
    """Whether a verdict passed limits of the voltage in a test in which other things moved, and no voltage did."""
    if verdict.check != _OF_VOLTAGE or verdict.status is not Status.PASS or test.disturbance is None:
        return False
    return bool(test.disturbance.steps) and not test.disturbance.voltage_steps_s


def _decided(clause: ClauseSummary, judgement: Judgement) -> bool:
    """Whether the numbers of a verdict are those of a clause, rather than of another part of its requirement."""
    test, verdict = judgement.test, judgement.verdict
    return verdict.clause == clause.clause or verdict.check in clause.checks or test.id in clause.tests


def _by_margin(texts: Texts, clause: ClauseSummary, judgement: Judgement) -> tuple[bool, bool, float, int]:
    """Order of verdicts, the nearest to failing first, of those that the clause's own numbers decided.

    What is counted (runs) is met or not, never nearly.
    """
    is_counted = f"unit_word.{judgement.verdict.unit}" in texts
    margin = judgement.verdict.relative_margin
    missing = float("-inf") if judgement.verdict.status is Status.FAIL else float("inf")
    return not _decided(clause, judgement), is_counted, (missing if margin is None else margin), judgement.number


def _reason(
    clause: ClauseSummary,
    profile: ProfileSummary,
    tests: Sequence[tuple[int, TestResult]],
    at_worst: Sequence[Judgement],
    texts: Texts,
) -> tuple[str, str]:
    """Why a clause was not judged, or not in every test: a sentence, and the commonest reason that was told."""
    if at_worst:
        status = at_worst[0].verdict.status
        if status in JUDGED:
            return "", ""
        count = len({each.number for each in at_worst})
        told = "not_judged"
        if status is Status.NOT_APPLICABLE:
            told = "let_off_so_far" if count < clause.judged_tests else "let_off"
        commonest = _commonest(each.verdict.message for each in at_worst)
        quoted = texts("coverage.quoted", message=commonest) if commonest else ""
        return texts(f"coverage.reason.{told}", count=count), quoted
    return texts(f"coverage.reason.{why_without_verdict(clause, profile, tests)}"), ""


def _commonest(messages: Iterable[str]) -> str:
    """The message that occurs most, whatever the numbers in it; the first of its kind."""
    first: dict[str, str] = {}
    counted: Counter[str] = Counter()
    for message in messages:
        kind = _NUMBER.sub("#", message)
        first.setdefault(kind, message)
        counted[kind] += 1
    return first[counted.most_common(1)[0][0]] if counted else ""


def _about(clause: ClauseSummary, texts: Texts) -> tuple[str, ...]:
    """What of the profile is of a clause; a part of a check that is of it as a whole is not said again."""
    about = [texts.named("check", kind) for kind in clause.checks]
    for part in clause.parts:
        kind, _, name = part.partition(".")
        if kind not in clause.checks:
            about.append(
                texts("coverage.part", check=texts.named("check", kind), part=texts.named("coverage.of", name))
            )
    if clause.tests:
        about.append(texts("coverage.tests", count=len(clause.tests)))
    return tuple(about)


def _not_covered(entry: NotCoveredSummary, texts: Texts) -> CoverageRow:
    return CoverageRow(
        clause=entry.clause,
        about=(entry.what,),
        state="not_covered",
        state_word=texts.named("coverage.state", "not_covered"),
        symbol=_SYMBOL["not_covered"],
        run=0,
        judged=0,
        tests=(),
        worst=None,
        margin="",
        reason="",
        detail=entry.why,
        confidence="",
    )


def _tally(rows: Sequence[CoverageRow], texts: Texts) -> tuple[tuple[State, str, int], ...]:
    counts = Counter(row.state for row in rows)
    return tuple((state, texts.named("coverage.state", state), counts[state]) for state in STATES if counts[state])
