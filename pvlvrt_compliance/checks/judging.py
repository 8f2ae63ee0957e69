"""One judge, called so that a verdict comes out of it whatever happens inside."""

from pvlvrt_compliance.checks.evidence import Evidence, NotApplicable
from pvlvrt_compliance.checks.registry import Judge
from pvlvrt_compliance.checks.results import Check, Status
from pvlvrt_compliance.checks.verdicts import unjudged
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.profile.requirements import Requirement


def judge_safely(kind: str, judge: Judge, requirement: Requirement, evidence: Evidence) -> Check:
    """Return the verdict of a judge.

    `NotApplicable` and `MeasurementError` become the verdicts that they stand for. Anything else that a judge raises,
    or a return value that is no `Check`, is an `error` with the text: one faulty check must not end a run.
    """
    try:
        check = judge(requirement, evidence)
    except NotApplicable as reason:
        return unjudged(kind, requirement, Status.NOT_APPLICABLE, str(reason))
    except MeasurementError as error:
        return unjudged(kind, requirement, Status.NOT_EVALUATED, str(error))
    except Exception as error:  # a judge of another package may raise what it likes
        return unjudged(kind, requirement, Status.ERROR, f"the check raised {in_words(error)}")
    if not isinstance(check, Check):
        return unjudged(kind, requirement, Status.ERROR, f"the check returned a {type(check).__name__}, not a Check")
    return check


def in_words(error: Exception) -> str:
    """Kind and text of an exception."""
    return f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
