"""The one result object: table, HTML, JUnit, JSON and exit status are all made from it."""

import hashlib
import json
from collections.abc import Iterable
from typing import Any, NamedTuple

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

from pvlvrt_compliance.disturbance.model import Disturbance
from pvlvrt_compliance.measure.quantities import CursorStretch, MeasuredWindows
from pvlvrt_compliance.results.band import Band
from pvlvrt_compliance.results.baseline import BaselineSummary
from pvlvrt_compliance.results.details import ReportDetails
from pvlvrt_compliance.results.drawn import Characteristic, Instant, Spectrum
from pvlvrt_compliance.results.profile import ProfileSummary
from pvlvrt_compliance.results.verdict import JUDGED, Status, Verdict, worst
from pvlvrt_compliance.texts import Data, Id, Name, Text

SCHEMA_VERSION = 1

# When and how a run was asked for, not what it is or found.
_NOT_FOUND: dict[str, Any] = {
    "allow_unjudged": True,
    "report": True,
    "interrupted": True,
    "baseline": True,
    "provenance": {"created", "command", "files", "settings", "reuse"},
    "tests": {"__all__": {"wall_time_s": True, "checks": {"__all__": {"known", "known_reason", "worse"}}}},
}


class _Frozen(BaseModel):
    # Whoever reads a result of a later version goes by the keys that he knows.
    model_config = ConfigDict(frozen=True, extra="ignore")


class Rating(_Frozen):
    """Base of the per-unit values of a test."""

    apparent_power_kva: FiniteFloat
    phase_voltage_v: FiniteFloat = Field(description="rms, phase to neutral")
    frequency_hz: FiniteFloat


class TestResult(_Frozen):
    """One test: what was asked for, what the grid did, its verdicts and what was measured."""

    __test__ = False  # not a test class, whatever pytest thinks of the name

    id: Id
    profile: Id = ""
    title: Name = ""
    scenario: Data = Field(default_factory=dict)
    disturbance: Disturbance | None = Field(default=None, description="what the grid did")
    expect: Name | None = Field(
        default=None,
        description="what a row demands: ride_through, may_trip or must_trip; none: a sag of the user's own",
    )
    by_s: FiniteFloat | None = Field(default=None, description="from the start, when a must_trip row is to be open")
    k_factor: FiniteFloat | None = Field(default=None, description="K of the test, in place of the profile's")
    rating: Rating | None = Field(default=None, description="base of the per-unit values")
    available_power_kw: FiniteFloat | None = Field(default=None, description="what the array could give before")
    status: Status
    checks: tuple[Verdict, ...] = ()
    bands: tuple[Band, ...] = Field(default=(), description="limits as a figure draws them")
    spectra: tuple[Spectrum, ...] = Field(default=(), description="what was judged by order, with its limits")
    characteristics: tuple[Characteristic, ...] = Field(default=(), description="limits over another quantity")
    instants: tuple[Instant, ...] = Field(default=(), description="when what a time is demanded of has come")
    waveforms: Name | None = Field(default=None, description="path of the waveforms, relative to results.json")
    measurements: MeasuredWindows = MeasuredWindows()
    cursors: tuple[CursorStretch, ...] = Field(
        default=(), description="extremes, mean and response times of each stretch between steps, up to a trip"
    )
    trip_cause: Text | None = Field(default=None, description="what opened the breaker, in words")
    clause: Name = Field(default="", description="where the test procedure comes from")
    confidence: Name = Field(default="", description="mark of the test procedure's numbers")
    duration_s: FiniteFloat = Field(default=0.0, description="length of the record")
    wall_time_s: FiniteFloat = Field(
        default=0.0, description="what it took to run and to judge it; 0 where that is not known or the time is fixed"
    )

    @property
    def key(self) -> str:
        """Name that no other test of a run has: profile and id."""
        return f"{self.profile}.{self.id}" if self.profile else self.id

    @property
    def statuses(self) -> tuple[Status, ...]:
        """Verdict of each check; a test that ended before any check still has its own."""
        return tuple(check.status for check in self.checks) or (self.status,)


class Finding(NamedTuple):
    """A verdict, and the test that it is of."""

    test: TestResult
    verdict: Verdict


class Results(_Frozen):
    """A whole run."""

    schema_version: int = SCHEMA_VERSION
    run_id: Name = Field(
        default="",
        description="digest of what the run is and found, whenever that was; its junit.xml and report.html carry it",
    )
    status: Status = Field(description="the worst of all verdicts; not_evaluated, too, where nothing was judged")
    allow_unjudged: bool = Field(
        default=False, description="whether --allow-unjudged was given, for the exit status and junit.xml"
    )
    report: ReportDetails = Field(default=ReportDetails(), description="what was given for the report")
    ended_at: Name = Field(
        default="", description="profile and id of the test that the run ended at, the first not passed (--fail-fast)"
    )
    interrupted: bool = Field(
        default=False, description="whether something ended the run before it was whole: it counts as an error"
    )
    baseline: BaselineSummary | None = Field(
        default=None, description="what the run was held against, and what of that is out of date"
    )
    profiles: tuple[ProfileSummary, ...] = ()
    provenance: Data = Field(default_factory=dict)
    tests: tuple[TestResult, ...] = ()

    def counts(self) -> dict[Status, int]:
        """Number of verdicts by status, those that occur, worst first."""
        found = [status for test in self.tests for status in test.statuses]
        return {status: found.count(status) for status in Status if status in found}

    def verdicts(self) -> tuple[Finding, ...]:
        """Every verdict with its test, in the order of the tests."""
        return tuple(Finding(test, verdict) for test in self.tests for verdict in test.checks)

    def worst_margin(self) -> Finding | None:
        """The verdict that is nearest to failing, or the furthest from passing: by `Verdict.relative_margin`.

        Of those that passed or failed; None where none of them has a margin.
        """
        return next(iter(self.worst_margins(1)), None)

    def worst_margins(self, count: int) -> tuple[Finding, ...]:
        """As many verdicts as are asked for, the one that is nearest to failing first, as of `worst_margin`."""
        judged = [each for each in self.verdicts() if each.verdict.status in JUDGED]
        margins = {k: m for k, each in enumerate(judged) if (m := each.verdict.relative_margin) is not None}
        return tuple(judged[k] for k in sorted(margins, key=margins.__getitem__)[:count])

    @property
    def nothing_judged(self) -> bool:
        """Whether no requirement passed or failed."""
        return not JUDGED & self.counts().keys()

    @property
    def counts_as(self) -> Status:
        """The verdict that the exit status goes by.

        With `allow_unjudged` the worst of what could be judged; what is worse than in a baseline fails, and what fails
        there in the same way does not. A run that was interrupted has not shown what it was to show.
        """
        if self.interrupted:
            return Status.ERROR
        if self.nothing_judged:
            return self.status
        return worst(counts_for(test, allow_unjudged=self.allow_unjudged) for test in self.tests)


def conclude(
    tests: Iterable[TestResult],
    profiles: Iterable[ProfileSummary] = (),
    provenance: dict[str, Any] | None = None,
    *,
    allow_unjudged: bool = False,
    report: ReportDetails | None = None,
    ended_at: str = "",
    interrupted: bool = False,
) -> Results:
    """Gather tests into the result of a run, with its id.

    Its verdict is the worst of its tests'; where nothing applied it is `not_evaluated`, for nothing was shown.
    ``ended_at`` is the key of the test that a run ended at before the others were run,
    ``interrupted`` whether anything else ended it.
    """
    tests = tuple(tests)
    status = worst(test.status for test in tests)
    results = Results(
        status=Status.NOT_EVALUATED if status is Status.NOT_APPLICABLE else status,
        allow_unjudged=allow_unjudged,
        report=report or ReportDetails(),
        ended_at=ended_at,
        interrupted=interrupted,
        tests=tests,
        profiles=tuple(profiles),
        provenance=provenance or {},
    )
    return results.model_copy(update={"run_id": _run_id(results)})


def counts_for(test: TestResult, *, allow_unjudged: bool = False) -> Status:
    """The worst of what the verdicts of a test count as, for the exit status of a run, as of `Results.counts_as`."""
    own = (Verdict(check="test", status=test.status),) if test.status in (Status.ERROR, Status.NOT_EVALUATED) else ()
    return worst(verdict.counted(allow_unjudged=allow_unjudged) for verdict in (*own, *test.checks))


def exit_status(results: Results) -> int:
    """Exit status of the command: 0, 1 or 3 by the verdict that the run counts as."""
    return _EXIT_STATUS[results.counts_as]


_EXIT_STATUS = {
    Status.ERROR: 3,
    Status.NOT_EVALUATED: 3,
    Status.FAIL: 1,
    Status.PASS: 0,
    Status.NOT_APPLICABLE: 3,  # of a run: nothing was judged
}


def _run_id(results: Results) -> str:
    """16 hexadecimal digits that are the same for the same input and the same findings."""
    found = results.model_dump(mode="json", exclude={"run_id": True, **_NOT_FOUND})
    return hashlib.sha256(json.dumps(found, sort_keys=True).encode()).hexdigest()[:16]
