"""The one result of a run: table, HTML, JUnit, JSON and exit status are all made from it."""

from pvlvrt_compliance.measure.quantities import (
    ControllerBeliefs,
    Cursor,
    CursorStretch,
    MeasuredWindows,
    WindowMeasurements,
)
from pvlvrt_compliance.results.band import Band
from pvlvrt_compliance.results.baseline import BaselineNote, BaselineSummary
from pvlvrt_compliance.results.details import ReportDetails
from pvlvrt_compliance.results.drawn import Characteristic, Drawn, Instant, Spectrum, SpectrumBar
from pvlvrt_compliance.results.profile import (
    AppliesToSummary,
    ClauseSummary,
    NotCoveredSummary,
    ProfileSummary,
)
from pvlvrt_compliance.results.results import (
    SCHEMA_VERSION,
    Finding,
    Rating,
    Results,
    TestResult,
    conclude,
    counts_for,
    exit_status,
)
from pvlvrt_compliance.results.verdict import JUDGED, UNSETTLED, Bound, Status, Verdict, worst

__all__ = [
    "JUDGED",
    "SCHEMA_VERSION",
    "UNSETTLED",
    "AppliesToSummary",
    "Band",
    "BaselineNote",
    "BaselineSummary",
    "Bound",
    "Characteristic",
    "ClauseSummary",
    "ControllerBeliefs",
    "Cursor",
    "CursorStretch",
    "Drawn",
    "Finding",
    "Instant",
    "MeasuredWindows",
    "NotCoveredSummary",
    "ProfileSummary",
    "Rating",
    "ReportDetails",
    "Results",
    "Spectrum",
    "SpectrumBar",
    "Status",
    "TestResult",
    "Verdict",
    "WindowMeasurements",
    "conclude",
    "counts_for",
    "exit_status",
    "worst",
]
