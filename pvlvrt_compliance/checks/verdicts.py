"""Verdicts made in one way, so that each carries its clause and the weakest mark it rests on."""

from collections.abc import Iterable

from pvlvrt_compliance.data.marks import Marked, weakest
from pvlvrt_compliance.profile.requirements import Requirement
from pvlvrt_compliance.results import Bound, Status, Verdict


def judged(
    kind: str,
    requirement: Requirement,
    status: Status,
    message: str,
    *,
    measured: float,
    limit: float,
    margin: float,
    unit: str,
    at_s: float,
    rests_on: Iterable[Marked],
    clause: str = "",
    bound: Bound | None = None,
    tolerance: float = 0.0,
    uncertainty: float | None = None,
) -> Verdict:
    """Verdict on a measured value.

    Parameters
    ----------
    kind : str
        Name of the check.
    requirement : Requirement
        What was demanded; gives the clause unless ``clause`` does.
    measured, limit, margin : float
        In ``unit``; the margin is the distance to failing, negative when failed.
    at_s : float
        The worst instant, from the start of the record (s).
    rests_on : iterable of Marked
        The numbers that decided; the weakest of their marks is the verdict's. Of a table that decided as a whole, the
        marks of its rows count, too; where one row decided, give its own (`MarkedTable.mark_of`).
    bound, tolerance, uncertainty
        As `Verdict` has them.
    """
    return Verdict(
        check=kind,
        status=status,
        measured=float(measured),
        limit=float(limit),
        margin=float(margin),
        unit=unit,
        at_s=float(at_s),
        clause=clause or requirement.clause,
        confidence=weakest(mark for number in rests_on for mark in number.marks),
        message=message,
        bound=bound,
        tolerance=float(tolerance),
        uncertainty=uncertainty,
    )


def judged_at_most(
    kind: str,
    requirement: Requirement,
    message: str,
    *,
    measured: float,
    limit: float,
    unit: str,
    at_s: float,
    rests_on: Iterable[Marked],
    clause: str = "",
    uncertainty: float | None = None,
) -> Verdict:
    """Verdict on a measured value that may be a limit at most; parameters as `judged`."""
    return judged(
        kind,
        requirement,
        pass_or_fail(measured <= limit),
        message,
        measured=measured,
        limit=limit,
        margin=limit - measured,
        unit=unit,
        at_s=at_s,
        rests_on=rests_on,
        clause=clause,
        bound="at_most",
        uncertainty=uncertainty,
    )


def unjudged(kind: str, requirement: Requirement, status: Status, reason: str) -> Verdict:
    """Verdict without a measured value: not applicable, not evaluated, or an error."""
    return Verdict(
        check=kind, status=status, clause=requirement.clause, confidence=requirement.confidence, message=reason
    )


def pass_or_fail(passed: bool) -> Status:
    """Verdict of a comparison."""
    return Status.PASS if passed else Status.FAIL
