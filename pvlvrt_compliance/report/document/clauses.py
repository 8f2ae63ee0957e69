"""What a run says of a clause: which verdicts count for it, and why there may be none."""

from collections.abc import Sequence
from typing import NamedTuple

from pvlvrt_compliance.results import UNSETTLED, ClauseSummary, ProfileSummary, TestResult, Verdict


class Judgement(NamedTuple):
    """A verdict that speaks of a clause."""

    number: int  # of the test in the report, from 1
    test: TestResult
    verdict: Verdict


def kinds_of(clause: ClauseSummary) -> set[str]:
    """Kinds of requirements that a clause, or a part of which, is of."""
    return {*clause.checks, *(part.partition(".")[0] for part in clause.parts)}


def counted(clause: ClauseSummary, profile: ProfileSummary, said: Sequence[Judgement]) -> tuple[list[Judgement], str]:
    """What counts for a clause, and the name of the reason why that is not enough to call it passed, where it is not.

    Of some checks it is enough for the clause of a check that was selected; of a test's procedure all of its tests are
    wanted. What is not passed counts in any case.
    """
    selected = set(profile.selected_checks)
    told = [each for each in said if not selected or each.verdict.check in selected or _is_unsettled(each)]
    if any(map(_is_unsettled, told)) or not told:
        return told, ""
    if selected and (clause.tests or not kinds_of(clause) <= selected):
        return [], "partly"
    if not {*profile.not_selected, *profile.not_run}.isdisjoint(clause.tests):
        return [], "partly_run"
    return told, ""


def _is_unsettled(judgement: Judgement) -> bool:
    return judgement.verdict.status in UNSETTLED


def why_without_verdict(clause: ClauseSummary, profile: ProfileSummary, tests: Sequence[tuple[int, TestResult]]) -> str:
    """Name of the reason why no verdict of a run speaks of a clause."""
    kinds, selected = kinds_of(clause), set(profile.selected_checks)
    if kinds and selected and not kinds & selected:
        return "check_not_selected"
    if any(verdict.check in kinds for _, test in tests for verdict in test.checks):
        return "not_decisive"
    if not clause.judged_tests and not clause.tests:
        return "no_test"
    if tests and all(test.expect is None for _, test in tests):
        return "own_sag"
    return _why_not_run(clause, profile)


def _why_not_run(clause: ClauseSummary, profile: ProfileSummary) -> str:
    only_long = clause.judged_tests == clause.judged_long
    if only_long and set(clause.tests) <= set(profile.left_out):
        return "long"
    # Of a clause without tests of its own nobody knows here whether those that judge it were selected.
    is_known = bool(clause.tests) or not profile.not_selected
    ended_before = profile.not_run and set(clause.tests) <= {*profile.not_run, *profile.left_out}
    return "not_run" if is_known and ended_before else "not_selected"
