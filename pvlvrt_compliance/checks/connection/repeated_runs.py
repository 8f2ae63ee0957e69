"""A test is ridden through several times, one after the other: one verdict on all runs of a row."""

from collections.abc import Sequence

from pvlvrt_compliance.checks.check import RowCheck
from pvlvrt_compliance.checks.rows import connection_status, run_status_in_words
from pvlvrt_compliance.checks.verdicts import judged, pass_or_fail, unjudged
from pvlvrt_compliance.profile.requirements import RepeatedRuns
from pvlvrt_compliance.results import Status, TestResult, Verdict

KIND = "repeated_runs"


class RepeatedRunsCheck(RowCheck):
    """Judges whether all runs of a row are ridden through, or after one that was not all further ones."""

    kind = KIND
    title = "Repeated runs"
    requirement = RepeatedRuns

    def further_runs_wanted(
        self, requirement: RepeatedRuns, runs: Sequence[TestResult], further: Sequence[TestResult] = ()
    ) -> int:
        """How many more runs the rule asks for before it can be judged.

        None unless exactly one of the row's own runs failed, the rule has a second chance, and no further run has
        failed.

        Parameters
        ----------
        runs : sequence of TestResult
            The row's own, in order.
        further : sequence of TestResult
            Those that were asked for since.
        """
        chance = requirement.consecutive_after_trip
        failed = sum(_failed(run) for run in runs)
        if chance is None or len(runs) < requirement.consecutive.value or failed != 1 or _undecided(runs):
            return 0
        if any(_failed(run) for run in further) or _undecided(further):
            return 0
        return max(int(chance.value) - len(further), 0)

    def judge_row(
        self, requirement: RepeatedRuns, runs: Sequence[TestResult], further: Sequence[TestResult] = ()
    ) -> Verdict:
        """Judge the row: all of its runs ridden through, or after one that was not, all further ones.

        A run is ridden through when no check of the connection failed in it. Fewer runs than the rule wants, because
        only some were selected, are `not_applicable`; a run that could not be evaluated makes the row `not_evaluated`.
        """
        wanted = int(requirement.consecutive.value)
        if len(runs) < wanted:
            reason = f"the code wants {wanted} runs one after the other, {len(runs)} selected"
            return unjudged(KIND, requirement, Status.NOT_APPLICABLE, reason)
        if (run := _undecided([*runs, *further])) is not None:
            reason = f"the run {run.id} is {run_status_in_words(run)}"
            return unjudged(KIND, requirement, Status.NOT_EVALUATED, reason)
        failed = [run.id for run in runs if _failed(run)]
        if not failed:
            message = f"all {len(runs)} runs of the test were ridden through"
            return _counted(requirement, len(runs), wanted, message)
        chance = requirement.consecutive_after_trip
        if chance is None or len(failed) > 1:
            message = f"{len(failed)} of {len(runs)} runs were not ridden through: {', '.join(failed)}"
            return _counted(requirement, _longest(runs, wanted), wanted, message)
        ridden = sum(not _failed(run) for run in further)
        message = f"{failed[0]} was not ridden through; of the {chance.value:g} further runs {ridden} were"
        return _counted(requirement, ridden, int(chance.value), message)


def _failed(result: TestResult) -> bool:
    return connection_status(result) is Status.FAIL


def _undecided(runs: Sequence[TestResult]) -> TestResult | None:
    return next((run for run in runs if connection_status(run) in {Status.ERROR, Status.NOT_EVALUATED}), None)


def _longest(runs: Sequence[TestResult], wanted: int) -> int:
    """Most runs ridden through one after the other, short of what is wanted."""
    longest = count = 0
    for run in runs:
        count = 0 if _failed(run) else count + 1
        longest = max(longest, count)
    return min(longest, wanted - 1)


def _counted(requirement: RepeatedRuns, ridden: int, wanted: int, message: str) -> Verdict:
    rests_on = [requirement.consecutive, *filter(None, [requirement.consecutive_after_trip])]
    return judged(
        KIND,
        requirement,
        pass_or_fail(ridden >= wanted),
        message,
        measured=ridden,
        limit=wanted,
        margin=ridden - wanted,
        unit="runs",
        at_s=0.0,
        rests_on=rests_on,
        bound="at_least",
    )
