"""The one result object: table, HTML, JUnit, JSON and exit status are all made from it."""

import hashlib
import json
from collections.abc import Iterable
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

from pvlvrt_compliance.disturbance.model import Disturbance
from pvlvrt_compliance.measure.quantities import MeasuredWindows
from pvlvrt_compliance.results.band import Band
from pvlvrt_compliance.results.verdict import Status, Verdict, worst

SCHEMA_VERSION = 1

_NOT_FOUND = ("created", "command")  # of the provenance: when and how a run was asked for, not what it is or found


class _Frozen(BaseModel):
    # Whoever reads a result of a later version goes by the keys that he knows.
    model_config = ConfigDict(frozen=True, extra="ignore")


class TestResult(_Frozen):
    """One test: what was asked for, what the grid did, its verdicts and what was measured."""

    __test__ = False  # not a test class, whatever pytest thinks of the name

    id: str
    profile: str = ""
    title: str = ""
    scenario: dict[str, Any] = Field(default_factory=dict)
    disturbance: Disturbance | None = Field(default=None, description="what the grid did")
    status: Status
    checks: tuple[Verdict, ...] = ()
    bands: tuple[Band, ...] = Field(default=(), description="limits as a figure draws them")
    waveforms: str | None = Field(default=None, description="path of the waveforms, relative to results.json")
    measurements: MeasuredWindows = MeasuredWindows()
    trip_cause: str | None = Field(default=None, description="what opened the breaker, in words")
    clause: str = Field(default="", description="where the test procedure comes from")
    confidence: str = Field(default="", description="mark of the test procedure's numbers")
    duration_s: FiniteFloat = Field(default=0.0, description="length of the record")

    @property
    def key(self) -> str:
        """Name that no other test of a run has: profile and id."""
        return f"{self.profile}.{self.id}" if self.profile else self.id


class ProfileSummary(_Frozen):
    """The profile that was judged against, as a report shows it."""

    id: str
    title: str
    digest: str
    notes: tuple[str, ...] = Field(default=(), description="what is not verified, a sentence each")
    left_out: tuple[str, ...] = Field(default=(), description="long tests that were not asked for, by id")


class Results(_Frozen):
    """A whole run."""

    schema_version: int = SCHEMA_VERSION
    run_id: str = Field(
        default="",
        description="digest of what the run is and found, whenever that was; its junit.xml and report.html carry it",
    )
    status: Status
    profiles: tuple[ProfileSummary, ...] = ()
    provenance: dict[str, Any] = Field(default_factory=dict)
    tests: tuple[TestResult, ...] = ()

    def counts(self) -> dict[Status, int]:
        """Number of checks by verdict."""
        found = [check.status for test in self.tests for check in test.checks]
        return {status: found.count(status) for status in Status}


def conclude(
    tests: Iterable[TestResult], profiles: Iterable[ProfileSummary] = (), provenance: dict[str, Any] | None = None
) -> Results:
    """Gather tests into the result of a run, with its id; the file's verdict is the worst of its tests'."""
    tests = tuple(tests)
    status = worst(test.status for test in tests)
    results = Results(status=status, tests=tests, profiles=tuple(profiles), provenance=provenance or {})
    return results.model_copy(update={"run_id": _run_id(results)})


def _run_id(results: Results) -> str:
    """16 hexadecimal digits that are the same for the same input and the same findings."""
    found = results.model_dump(mode="json", exclude={"run_id": True, "provenance": set(_NOT_FOUND)})
    return hashlib.sha256(json.dumps(found, sort_keys=True).encode()).hexdigest()[:16]


EXIT_STATUS = {
    Status.ERROR: 3,
    Status.NOT_EVALUATED: 3,
    Status.FAIL: 1,
    Status.PASS: 0,
    Status.NOT_APPLICABLE: 0,
}
"""Exit status of the command by the verdict of the run."""
