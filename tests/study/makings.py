"""What tests have made of records, by name: ``Named("makings:length")``."""

from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.results import TestResult

SEEN: list[TestResult] = []
"""Results that `seen` was given, in order."""


def length(evidence: Evidence, result: TestResult, *, unit_s: float = 1.0) -> tuple[str, float]:
    """Id of the test and how long its record is."""
    return result.id, (evidence.waveforms.end_s - evidence.waveforms.t0_s) / unit_s


def seen(_evidence: Evidence, result: TestResult) -> int:
    """How many were seen before."""
    SEEN.append(result)
    return len(SEEN) - 1
