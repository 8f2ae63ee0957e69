"""The one result of a run: table, HTML, JUnit, JSON and exit status are all made from it."""

from pvlvrt_compliance.measure.quantities import ControllerBeliefs, MeasuredWindows, WindowMeasurements
from pvlvrt_compliance.results.band import Band
from pvlvrt_compliance.results.results import (
    SCHEMA_VERSION,
    Finding,
    ProfileSummary,
    Rating,
    Results,
    TestResult,
    conclude,
    exit_status,
)
from pvlvrt_compliance.results.verdict import JUDGED, UNSETTLED, Bound, Status, Verdict, worst

__all__ = [
    "JUDGED",
    "SCHEMA_VERSION",
    "UNSETTLED",
    "Band",
    "Bound",
    "ControllerBeliefs",
    "Finding",
    "MeasuredWindows",
    "ProfileSummary",
    "Rating",
    "Results",
    "Status",
    "TestResult",
    "Verdict",
    "WindowMeasurements",
    "conclude",
    "exit_status",
    "worst",
]
