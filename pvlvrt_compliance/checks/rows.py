"""Runs of one row of a test table, as verdicts on the connection make them: ridden through, or not."""

from pvlvrt_compliance.checks.check import RowCheck
from pvlvrt_compliance.checks.registry import find_check, judges_connection
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.profile.requirements import Requirement
from pvlvrt_compliance.results import Status, TestResult, Verdict, worst


def row_rule(profile: Profile) -> tuple[RowCheck, Requirement] | None:
    """The check of a profile that judges rows, with its demand; None where it has none."""
    for kind, requirement in profile.requirements.by_kind():
        if isinstance(check := find_check(kind), RowCheck):
            return check, requirement
    return None


def is_judged_as_one(profile: Profile, test: TestCase) -> bool:
    """Whether a rule of the profile speaks of all runs of the row of a test together.

    Where only some checks are asked for, too: the rule may let a run off, whichever of them are told.
    """
    rule = row_rule(profile)
    return rule is not None and bool(test.row) and test.has(rule[0].kind)


def connection_status(result: TestResult) -> Status:
    """Worst verdict on the connection in one run; `not_applicable` when the code let the inverter go."""
    return worst(check.status for check in result.checks if judges_connection(check.check))


def let_off(result: TestResult, kind: str) -> TestResult:
    """A failed run after which all further ones were ridden through: its connection no longer counts against it.

    ``kind`` is the rule that says so.
    """
    checks = tuple(
        check.model_copy(
            update={
                "status": Status.NOT_APPLICABLE,
                "message": f"{check.message}; let off, all further runs were ridden through ({kind})",
            }
        )
        if judges_connection(check.check) and check.status is Status.FAIL
        else check
        for check in result.checks
    )
    return result.model_copy(update={"checks": checks, "status": worst(check.status for check in checks)})


def with_check(result: TestResult, check: Verdict) -> TestResult:
    """The result with one verdict more, and its status with it."""
    checks = (*result.checks, check)
    return result.model_copy(update={"checks": checks, "status": worst(check.status for check in checks)})


def run_status_in_words(result: TestResult) -> str:
    """Verdict on the connection as a message says it."""
    return connection_status(result).replace("_", " ")
