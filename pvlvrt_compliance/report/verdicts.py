"""The verdicts as every format shows them, so that none of them leaves one out."""

from typing import NamedTuple

from pvlvrt_compliance.data.marks import VERIFIED
from pvlvrt_compliance.report.format import STATUS_WORD
from pvlvrt_compliance.results import Results, Status, TestResult, Verdict

NOTHING_JUDGED = "nothing was judged: no requirement passed or failed"


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


class Marginal(NamedTuple):
    """A verdict that method and measurement leave open, and the test that it is of."""

    test: str
    check: Verdict


def marginal(results: Results) -> list[Marginal]:
    """Verdicts nearer to their limit than they are sure of, in order."""
    return [
        Marginal(name_of(test, results), check)
        for test in results.tests
        for check in verdicts(test)
        if check.is_marginal
    ]


def may_decide(results: Results) -> str:
    """What may settle a marginal verdict, in words; nothing where that has been run already."""
    simulation = results.provenance.get("parameters", {}).get("simulation", {})
    return "" if simulation.get("fidelity") == "switched" else "--fidelity switched may decide"


def on_the_run(results: Results) -> list[str]:
    """What is to be said of the run as a whole besides its verdict, in short pieces."""
    pieces = [NOTHING_JUDGED] if results.nothing_judged else []
    if results.counts_as is not results.status:
        pieces.append(f"counts as {STATUS_WORD[results.counts_as]} (--allow-unjudged)")
    return pieces


def is_verified(confidence: str) -> bool:
    """Whether a mark says that the number was read in the source; a number without a mark was not."""
    return confidence in VERIFIED
