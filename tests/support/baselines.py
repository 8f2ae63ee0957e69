"""Runs made of verdicts, and baselines to hold them against."""

from pvlvrt_compliance.results import ProfileSummary, Results, Status, TestResult, Verdict, conclude, worst
from pvlvrt_compliance.results.baseline import TOLERANCE
from pvlvrt_compliance.study.baseline.applying import Held, held_against
from pvlvrt_compliance.study.baseline.reading import BaselineFile
from pvlvrt_compliance.study.baseline.text import parsed

HEAD = "# pvlvrt-baseline 1\n\n"


def verdict(status: str = "fail", margin: float | None = -1.0, check: str = "x", **fields) -> Verdict:
    """A verdict on a limit of 10 kvar: a margin of 0.1 kvar is 1 % of it."""
    made = {"limit": 10.0, "unit": "kvar"} | fields
    return Verdict(check=check, status=Status(status), margin=margin, **made)


def case_of(name: str, *checks: Verdict, profile: str = "p", **fields) -> TestResult:
    """A test of profile p."""
    status = worst(check.status for check in checks) if checks else Status.ERROR
    return TestResult(id=name, profile=profile, status=status, checks=checks, **fields)


def run_of(*tests: TestResult, allow_unjudged: bool = False, **of_profile) -> Results:
    """A run of tests of profile p."""
    profile = ProfileSummary(id="p", title="P", digest="d", **of_profile)
    return conclude(tests, [profile], allow_unjudged=allow_unjudged)


def one(made: Verdict, **options) -> Results:
    """A run of one verdict, x in p.t, beside one that passes."""
    return run_of(case_of("t", made, Verdict(check="other", status=Status.PASS)), **options)


def baseline_file(*lines: str) -> BaselineFile:
    """A baseline of lines."""
    found, problems = parsed(HEAD + "\n".join(lines) + "\n", "b.txt")
    assert problems == []
    return BaselineFile("b.txt", "digest", found)


def held(results: Results, *lines: str, tolerance: float = TOLERANCE, is_gone=lambda _: False) -> Results:
    """A run held against a baseline of lines."""
    return held_against(results, Held(baseline_file(*lines), tolerance), is_gone)
