"""One check, called so that a verdict comes out of it whatever happens inside."""

from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.checks.verdicts import unjudged
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable
from pvlvrt_compliance.profile.requirements import Requirement
from pvlvrt_compliance.results import Drawn, Status, Verdict


def judge_safely(check: Check, requirement: Requirement, evidence: Evidence) -> Verdict:
    """Return the verdict of a check on a record.

    `NotApplicable` and `MeasurementError` become the verdicts that they stand for. Anything else that a check raises,
    or a return value that is no `Verdict`, is an `error` with the text: one faulty check must not end a run.
    """
    try:
        verdict = check.judge(requirement, evidence)
    except NotApplicable as reason:
        return unjudged(check.kind, requirement, Status.NOT_APPLICABLE, str(reason))
    except MeasurementError as error:
        return unjudged(check.kind, requirement, Status.NOT_EVALUATED, str(error))
    except Exception as error:  # a check of another package may raise what it likes
        return unjudged(check.kind, requirement, Status.ERROR, f"the check raised {in_words(error)}")
    if not isinstance(verdict, Verdict):
        text = f"the check returned a {type(verdict).__name__}, not a Verdict"
        return unjudged(check.kind, requirement, Status.ERROR, text)
    return verdict


def limits_safely(check: Check, requirement: Requirement, evidence: Evidence) -> tuple[Drawn, ...]:
    """What a figure draws of a requirement; nothing where the check cannot say."""
    try:
        return tuple(check.limits(requirement, evidence))
    except Exception:  # a figure without a band is no reason to lose the verdict
        return ()


def in_words(error: Exception) -> str:
    """Kind and text of an exception."""
    return f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
