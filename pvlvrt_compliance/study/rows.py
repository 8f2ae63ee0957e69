"""Runs of one row after the other, with the verdict on all of them and the further runs that it asks for."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import groupby, pairwise

from pvlvrt_compliance.checks.check import RowCheck
from pvlvrt_compliance.checks.rows import connection_status, is_judged_as_one, let_off, row_rule, with_check
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.profile.requirements import Requirement
from pvlvrt_compliance.results import Status, TestResult
from pvlvrt_compliance.study.run import Judged
from pvlvrt_compliance.study.selection import FURTHER

Run = tuple[TestCase, Judged]


def run_rows(profile: Profile, cases: Iterable[TestCase], judge_one: Callable[[TestCase], Judged]) -> Iterator[Run]:
    """Run tests in order, and where a profile asks for it, rows again.

    The verdict on a row stands with the last run of its row. A run that was not ridden through is held back
    until its row is decided, for the further runs may let it off; all others are handed out as soon as they are done.

    Parameters
    ----------
    profile : Profile
        Its rule of repeated runs counts, if it has one.
    cases : iterable of TestCase
        Runs of one row stand together; a test of the user's own belongs to none.
    judge_one : callable
        Runs and judges one test. It is called for the further runs, too.

    Yields
    ------
    tuple of TestCase and Judged
        In the order of the runs.
    """
    rule = row_rule(profile)
    for _, group in groupby(cases, key=lambda case: case.row):
        runs = list(group)
        if rule is None or not is_judged_as_one(profile, runs[-1]):
            yield from ((case, judge_one(case)) for case in runs)
        else:
            yield from _run_row(*rule, runs, judge_one)


def further_cases(runs: Sequence[TestCase], count: int) -> list[TestCase]:
    """Further runs of a row, at points on wave evenly between those of its own runs."""
    angles = points_between([case.scenario.point_on_wave_deg for case in runs], count)
    return [_at(runs[0], angle, number) for number, angle in enumerate(angles, start=1)]


def points_between(angles_deg: Sequence[float], count: int) -> list[float]:
    """Angles (deg, in order, 0 to 360) that divide the gaps between some others evenly, the widest gaps first."""
    own = sorted({angle % 360 for angle in angles_deg})
    gaps = [(begin, end - begin) for begin, end in pairwise([*own, own[0] + 360])]
    inside = [0] * len(gaps)
    for _ in range(count):
        widest = max(range(len(gaps)), key=lambda k: gaps[k][1] / (inside[k] + 1))
        inside[widest] += 1
    found = [
        round((begin + width * (k + 1) / (n + 1)) % 360, 6)
        for (begin, width), n in zip(gaps, inside, strict=True)
        for k in range(n)
    ]
    return sorted(found)


def _run_row(
    check: RowCheck, rule: Requirement, cases: list[TestCase], judge_one: Callable[[TestCase], Judged]
) -> Iterator[Run]:
    own: list[TestResult] = []
    further: list[TestResult] = []
    pending: list[Run] = []
    for case in cases:
        if not any(connection_status(result) is Status.FAIL for result in own):
            yield from pending
            pending.clear()
        pending.append((case, judge_one(case)))
        own.append(pending[-1][1].result)
    for case in further_cases(cases, check.further_runs_wanted(rule, own)):
        if check.further_runs_wanted(rule, own, further):
            pending.append((case, judge_one(case)))
            further.append(pending[-1][1].result)
    verdict = check.judge_row(rule, own, further)
    if further and verdict.status is Status.PASS:
        pending = [(case, judged._replace(result=let_off(judged.result, check.kind))) for case, judged in pending]
    last_case, last = pending.pop()
    yield from pending
    yield last_case, last._replace(result=with_check(last.result, verdict)) if last_case.judges(check.kind) else last


def _at(case: TestCase, angle_deg: float, number: int) -> TestCase:
    scenario = case.scenario.model_copy(update={"point_on_wave_deg": angle_deg})
    title = f"{case.title.rsplit(', ', 1)[0]}, {angle_deg:g} deg (further run {number})"
    return case.model_copy(update={"id": f"{case.row}{FURTHER}{number}", "title": title, "scenario": scenario})
