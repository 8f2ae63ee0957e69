"""The verdicts as every format shows them, so that none of them leaves one out."""

from typing import NamedTuple

from pvlvrt_compliance.data.marks import VERIFIED
from pvlvrt_compliance.results import Results, Status, TestResult, Verdict


class Finding(NamedTuple):
    """What somebody has to read: verdicts that are not a pass, with one reason for all of them."""

    tests: tuple[str, ...]
    checks: tuple[str, ...]
    status: Status
    message: str


def name_of(test: TestResult, results: Results) -> str:
    """Name of a test in a report: with its profile where there are several."""
    return test.key if len(results.profiles) > 1 else test.id


def verdicts(test: TestResult) -> tuple[Verdict, ...]:
    """Checks of a test; a test that ended before any check still has one verdict, its own."""
    return test.checks or (Verdict(check="test", status=test.status, message="no check was evaluated"),)


def findings(results: Results) -> list[Finding]:
    """Verdicts that are not a pass, worst first; checks of one test, then tests, that share a reason are joined."""
    tests: dict[tuple[tuple[str, ...], Status, str], list[str]] = {}
    for test in results.tests:
        for (status, message), checks in _by_reason(test).items():
            tests.setdefault((tuple(checks), status, message), []).append(name_of(test, results))
    found = [Finding(tuple(names), *reason) for reason, names in tests.items()]
    return sorted(found, key=lambda item: list(Status).index(item.status))


def _by_reason(test: TestResult) -> dict[tuple[Status, str], list[str]]:
    grouped: dict[tuple[Status, str], list[str]] = {}
    for check in verdicts(test):
        if check.status is not Status.PASS:
            grouped.setdefault((check.status, check.message or "no reason was given"), []).append(check.check)
    return grouped


def counts(results: Results) -> dict[Status, int]:
    """Verdicts by status, those that occur, worst first."""
    found = [check.status for test in results.tests for check in verdicts(test)]
    return {status: found.count(status) for status in Status if status in found}


def is_verified(confidence: str) -> bool:
    """Whether a mark says that the number was read in the source; a number without a mark was not."""
    return confidence in VERIFIED
