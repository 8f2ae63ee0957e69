"""The verdicts as every format shows them, so that none of them leaves one out."""

from typing import NamedTuple

from pvlvrt_compliance.data.marks import VERIFIED
from pvlvrt_compliance.report.format import STATUS_WORD
from pvlvrt_compliance.results import UNSETTLED, BaselineSummary, Results, Status, TestResult, Verdict

NOTHING_JUDGED = "nothing was judged: no requirement passed or failed"


class Finding(NamedTuple):
    """What somebody has to read: verdicts that are not a pass, with one reason for all of them."""

    tests: tuple[str, ...]
    checks: tuple[str, ...]
    status: Status
    message: str
    is_known: bool = False
    known_reason: str = ""
    worse: str = ""

    @property
    def is_to_do(self) -> bool:
        """Whether somebody has to look into it, or has done so and lives with it."""
        return self.status in UNSETTLED or bool(self.worse)


def name_of(test: TestResult, results: Results) -> str:
    """Name of a test in a report: with its profile where there are several."""
    return test.key if len(results.profiles) > 1 else test.id


def verdicts(test: TestResult) -> tuple[Verdict, ...]:
    """Checks of a test; a test that ended before any check still has one verdict, its own."""
    return test.checks or (Verdict(check="test", status=test.status, message="no check was evaluated"),)


def findings(results: Results) -> list[Finding]:
    """Verdicts that are not a pass, or worse than before: worst first, what is known after what is not.

    Checks of one test, then tests, that share a reason are joined.
    """
    tests: dict[tuple[tuple[str, ...], _Reason], list[str]] = {}
    for test in results.tests:
        for reason, checks in _by_reason(test).items():
            tests.setdefault((tuple(checks), reason), []).append(name_of(test, results))
    found = [Finding(tuple(names), checks, *reason) for (checks, reason), names in tests.items()]
    return sorted(found, key=lambda item: (not item.is_to_do, item.is_known, list(Status).index(item.status)))


class _Reason(NamedTuple):
    """What verdicts that are joined have in common."""

    status: Status
    message: str
    is_known: bool
    known_reason: str
    worse: str


def _by_reason(test: TestResult) -> dict[_Reason, list[str]]:
    grouped: dict[_Reason, list[str]] = {}
    for check in verdicts(test):
        if check.status is not Status.PASS or check.worse:
            message = check.message or ("" if check.worse else "no reason was given")
            reason = _Reason(check.status, message, check.is_known, check.known_reason, check.worse)
            grouped.setdefault(reason, []).append(check.check)
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


class Part(NamedTuple):
    """What of the profiles a run has left aside."""

    checks: tuple[str, ...]  # the only ones that were judged; none: all
    not_selected: int  # tests
    not_run: int  # tests that were selected, and that the run ended before
    ended_at: str  # the test that it ended at, where that was not passed


def part_of(results: Results) -> Part:
    """What of the profiles a run has left aside, so that a part of them never looks like the whole."""
    by_key = {test.key: name_of(test, results) for test in results.tests}
    return Part(
        checks=tuple(dict.fromkeys(name for profile in results.profiles for name in profile.selected_checks)),
        not_selected=sum(len(profile.not_selected) for profile in results.profiles),
        not_run=sum(len(profile.not_run) for profile in results.profiles),
        ended_at=by_key.get(results.ended_at, results.ended_at),
    )


def left_aside(results: Results) -> list[str]:
    """The same in short pieces; of a whole run none."""
    part, pieces = part_of(results), []
    if part.checks:
        pieces.append(f"only {', '.join(part.checks)} judged")
    if part.not_selected:
        pieces.append(f"{part.not_selected} test{'s' * (part.not_selected > 1)} not selected")
    if part.not_run:
        ended = f"after {part.ended_at} (--fail-fast)" if part.ended_at else "when it was interrupted"
        pieces.append(f"{part.not_run} not run {ended}")
    return pieces


def interrupted_in_words(results: Results) -> str:
    """How far a run was that was interrupted."""
    done = len(results.tests)
    return f"the run was interrupted: {done} of {done + part_of(results).not_run} tests were finished"


def on_the_run(results: Results) -> list[str]:
    """What is to be said of the run as a whole besides its verdict, in short pieces."""
    pieces = [NOTHING_JUDGED] if results.nothing_judged else []
    if results.baseline and results.baseline.has_own_tolerance and results.counts_as is results.status:
        pieces.append(f"held against {_held_against(results.baseline)}")  # else its head says so
    return [*pieces, *left_aside(results)]


def in_a_word(results: Results) -> str:
    """What a run counts as, and where that is not its own verdict, by which options: ``PASS by --baseline b.txt``."""
    word = STATUS_WORD[results.counts_as].upper()
    by = counts_by(results) if results.counts_as is not results.status else ""
    return f"{word} by {by}" if by else word


def kinds_in_words(results: Results) -> str:
    """How many verdicts of each kind a run has, and how many failures of it are known: ``3 fail (1 known), 6 pass``."""
    known = sum(finding.verdict.is_known for finding in results.verdicts())
    said = {Status.FAIL: f" ({known} known)"} if known else {}
    return ", ".join(f"{n} {STATUS_WORD[status]}{said.get(status, '')}" for status, n in results.counts().items())


def _held_against(baseline: BaselineSummary) -> str:
    """The file, and the tolerance where it is not the usual one."""
    return baseline.file + (f", tolerance {100 * baseline.tolerance:g} %" if baseline.has_own_tolerance else "")


def counts_by(results: Results) -> str:
    """The options by which a run counts as something else than its verdict, or that it was interrupted."""
    if results.interrupted:
        return "an interruption"
    found = [finding.verdict for finding in results.verdicts()]
    by = ["--allow-unjudged"] if results.allow_unjudged and Status.NOT_EVALUATED in results.counts() else []
    if results.baseline and any(verdict.known or verdict.worse for verdict in found):
        by.append(f"--baseline {_held_against(results.baseline)}")
    return ", ".join(by)


def is_verified(confidence: str) -> bool:
    """Whether a mark says that the number was read in the source; a number without a mark was not."""
    return confidence in VERIFIED
