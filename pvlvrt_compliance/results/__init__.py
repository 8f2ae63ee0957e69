"""The one result of a run: table, HTML, JUnit, JSON and exit status are all made from it."""

from pvlvrt_compliance.results.band import Band
from pvlvrt_compliance.results.results import (
    EXIT_STATUS,
    SCHEMA_VERSION,
    ProfileSummary,
    Results,
    TestResult,
    conclude,
)
from pvlvrt_compliance.results.verdict import Status, Verdict, worst

__all__ = [
    "EXIT_STATUS",
    "SCHEMA_VERSION",
    "Band",
    "ProfileSummary",
    "Results",
    "Status",
    "TestResult",
    "Verdict",
    "conclude",
    "worst",
]
