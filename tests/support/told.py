"""Small runs for the formats that CI reads, made of verdicts alone."""

from pvlvrt_compliance.results import ProfileSummary, Results, Status, TestResult, Verdict, conclude, worst

PROFILE = ProfileSummary(id="my-code", title="Mine", digest="0" * 64)

PASSED = Verdict(
    check="ride_through", status=Status.PASS, measured=0.9, limit=0.85, margin=0.05, unit="s", bound="at_least"
)
FAILED = Verdict(
    check="reactive_support",
    status=Status.FAIL,
    measured=40.0,
    limit=50.0,
    margin=-10.0,
    unit="kvar",
    bound="at_least",
    clause="eq (9)",
    message="mean reactive power 40.0 kvar is 10.0 kvar below the curve",
)
KNOWN = FAILED.model_copy(update={"known": True, "known_reason": "waits for the new filter"})
WORSE = PASSED.model_copy(update={"worse": "margin +0.050 s, +0.300 s in the baseline"})
UNJUDGED = Verdict(check="oscillation", status=Status.NOT_EVALUATED, message="no voltage before the sag")
BROKEN = Verdict(check="oscillation", status=Status.ERROR, message="the controller gave no number")
IDLE = Verdict(check="dc_ripple", status=Status.NOT_APPLICABLE, message="the sag is shorter than a cycle")


def test_of(name: str, *verdicts: Verdict, **fields: object) -> TestResult:
    """A test with these verdicts."""
    status = worst(each.status for each in verdicts)
    return TestResult(**{"id": name, "profile": PROFILE.id, "status": status, "checks": verdicts} | fields)


def run_of(*tests: tuple[Verdict, ...] | TestResult, allow_unjudged: bool = False, **provenance: object) -> Results:
    """A run of tests, each given by its verdicts or made already."""
    made = [each if isinstance(each, TestResult) else test_of(f"t{k}", *each) for k, each in enumerate(tests)]
    return conclude(made, [PROFILE], provenance, allow_unjudged=allow_unjudged)


test_of.__test__ = False  # type: ignore[attr-defined]
