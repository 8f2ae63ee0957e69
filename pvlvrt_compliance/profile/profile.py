"""A grid code as data: requirements, test procedure and acceptance, each number with its provenance."""

import hashlib
import re
from collections.abc import Collection, Iterator
from functools import cache, cached_property
from itertools import islice
from typing import Any, Literal

from pydantic import Field, create_model

from pvlvrt_compliance.data.marks import VERIFIED, canonical_json, marks_in, weakest
from pvlvrt_compliance.errors import UsageError, did_you_mean
from pvlvrt_compliance.profile.catalogue import count_of, expand, make_scenario, sag_duration_s
from pvlvrt_compliance.profile.corners import corner_rows
from pvlvrt_compliance.profile.curves import Envelope
from pvlvrt_compliance.profile.head import Head
from pvlvrt_compliance.profile.ids import ID_PATTERN
from pvlvrt_compliance.profile.procedure import Conditions, Detection, Procedure, TestCase, TestRow, Windows
from pvlvrt_compliance.profile.requirements import (
    Kinds,
    Requirements,
    RideThrough,
    kinds_of,
    requirements_of,
    unfilled,
)
from pvlvrt_compliance.profile.thresholds import STANDARD_THRESHOLDS, Thresholds
from pvlvrt_compliance.scenario.sag import Sag

SCHEMA_VERSION = 1

MOST_TESTS = 5000
"""Runs that the test table of one profile may stand for: chosen, fifty times what any ships with."""

_AD_HOC, _PERCENT = "sag", "pct"


class Profile(Head):
    """A profile with its includes resolved."""

    schema_version: Literal[1]
    id: str = Field(pattern=ID_PATTERN)
    title: str = Field(min_length=1)
    requirements: Requirements
    conditions: Conditions
    windows: Windows | None = Field(default=None, description="without it, the standard windows")
    detection: Detection | None = Field(default=None, description="without it, the sag that was asked for is the event")
    thresholds: Thresholds = Field(default=STANDARD_THRESHOLDS, description="floors and thresholds of measurement")
    procedure: Procedure
    rows: tuple[TestRow, ...] = Field(default=(), alias="tests")

    @cached_property
    def all_rows(self) -> tuple[TestRow, ...]:
        """The test table, and the rows made from the regions."""
        regions = self.ride_through.regions if self.ride_through else None
        if regions is None or self.procedure.corners is None:
            return self.rows
        return (*self.rows, *islice(corner_rows(regions, self.procedure.corners), MOST_TESTS + 1))

    @cached_property
    def expanded(self) -> dict[int, tuple[TestCase, ...]]:
        """Runs of those rows that have been asked for, by their places."""
        return {}

    @property
    def envelope(self) -> Envelope | None:
        """The ride-through envelope, where the profile has one."""
        return self.ride_through.envelope if self.ride_through else None

    @property
    def ride_through(self) -> RideThrough | None:
        """What decides how long a sag lasts that is to be ridden through, where the profile has it."""
        found = self.requirements.of_kind("ride_through")
        return found if isinstance(found, RideThrough) else None

    @property
    def digest(self) -> str:
        """SHA-256 of the resolved profile: the same numbers give the same digest, whatever the layout of the file."""
        return hashlib.sha256(canonical_json(self).encode()).hexdigest()

    @property
    def weakest_mark(self) -> str:
        """The weakest mark of anything in the profile, its test table included."""
        return weakest([*(item.confidence for _, item in marks_in(self)), *(row.confidence for row in self.all_rows)])

    def sag_duration_s(self, sag: Sag) -> float:
        """How long the envelope asks a sag to be ridden through (s), by its V+ without the inverter's current.

        Where the envelope asks for ever or not at all, and without an envelope: the procedure's default.
        """
        return sag_duration_s(sag, self.envelope, self.procedure)

    def tests(self, **overrides: Any) -> tuple[TestCase, ...]:
        """Every run of the test table; ``overrides`` replaces fields of all their scenarios (``frequency_hz=60``).

        Raises
        ------
        UsageError
            When a replaced field is unknown or out of its range.
        """
        if overrides:
            return tuple(
                case for row in self.all_rows for case in expand(row, self.procedure, self.envelope, overrides)
            )
        return tuple(case for index in range(len(self.all_rows)) for case in self._cases_of(index))

    def _cases_of(self, index: int) -> tuple[TestCase, ...]:
        """Every run of a row, as the table has it: made once, as whoever reads a profile needs them several times."""
        if index not in self.expanded:
            row = self.all_rows[index]
            self.expanded[index] = tuple(expand(row, self.procedure, self.envelope, {}))
        return self.expanded[index]

    def row_of(self, test: TestCase) -> str:
        """Id of the row of the test table that a test is a run of; nothing of a sag of the user's own.

        The test's own ``row`` goes on with the name of the power where its row has several: ``VD3-full`` of ``VD3``.
        """
        ids = {row.id for row in self.all_rows}
        found = test.row if test.row in ids else test.row.rpartition("-")[0]
        return found if found in ids else ""

    def ad_hoc_test(self, sag: Sag, duration_s: float | None = None, **fields: Any) -> TestCase:
        """A test of the user's own: outside the table, so without clause and mark.

        Parameters
        ----------
        sag : Sag
        duration_s : float, optional
            By default what `sag_duration_s` says.
        **fields
            Further fields of the `Scenario`.

        Raises
        ------
        UsageError
            When a field is unknown or out of its range.
        """
        duration = self.sag_duration_s(sag) if duration_s is None else duration_s
        name = f"{_AD_HOC}-{100 * sag.depth:.6g}{_PERCENT}-{sag.phases}"
        scenario = make_scenario(self.procedure, sag=sag, duration_s=duration, **fields)
        return TestCase(
            id=f"{name}-two-phase" if sag.two_phase else f"{name}-type-{sag.type}" if sag.type else name,
            title=f"{scenario.describe()}, {duration:.3f} s",
            scenario=scenario,
        )

    def unverified(self, case_ids: Collection[str] | None = None) -> tuple[str, ...]:
        """Describe all that was not read in an official text or in its implementation, a sentence each.

        A sentence reads ``ride_through envelope: inferred (<source>)``. Of the test table only the rows count that
        give a test in ``case_ids``; without it, all. Rows with the same mark and source share a sentence.
        """
        parts = [*self.requirements.by_kind(), ("conditions", self.conditions), ("procedure", self.procedure)]
        parts.append(("thresholds", self.thresholds))
        parts += [(name, part) for name in ("windows", "detection") if (part := getattr(self, name)) is not None]
        sentences = [
            f"{part} {name}: {item.confidence} ({item.source})"
            for part, content in parts
            for name, item in marks_in(content)
            if item.confidence not in VERIFIED
        ]
        doubtful: dict[str, list[str]] = {}
        for index, row in enumerate(self.all_rows):
            cases = {case.id for case in self._cases_of(index)}
            if row.confidence not in VERIFIED and (case_ids is None or not cases.isdisjoint(case_ids)):
                doubtful.setdefault(f"{row.confidence} ({row.source})", []).append(row.id)
        return (*sentences, *(f"tests {', '.join(ids)}: {mark}" for mark, ids in doubtful.items()))

    def inconsistencies(self) -> list[tuple[tuple[int | str, ...], str]]:
        """Problems that no single key shows: rows that cannot be expanded, ids that occur twice. Location and text."""
        problems: list[tuple[tuple[int | str, ...], str]] = []
        ids = set[str]()
        try:
            counts = [count_of(row, self.procedure) for row in self.all_rows]
        except UsageError as error:
            return [(("procedure", "corners"), str(error))]
        if sum(counts) > MOST_TESTS:
            own: dict[tuple[int | str, ...], int] = {("tests", k): counts[k] for k in range(len(self.rows))}
            own["procedure", "corners"] = sum(counts[len(self.rows) :])
            most = max(own, key=own.__getitem__)
            said = f"rows x powers x points_on_wave_deg make {sum(counts)} tests, {own[most]} of them here"
            return [(most, f"{said}; {MOST_TESTS} are allowed")]
        if self.procedure.corners is not None and len(self.all_rows) == len(self.rows):
            needed = "needs requirements.ride_through.regions with times to stay connected"
            problems.append((("procedure", "corners"), needed))
        for index, row in enumerate(self.all_rows):
            place = ("tests", index) if index < len(self.rows) else ("procedure", "corners")
            problems += [((*place, "checks"), text) for text in self._unknown_checks(row)]
            try:
                cases = [case.id for case in self._cases_of(index)]
                twice = [name for k, name in enumerate(cases) if name in ids or name in cases[:k]]
                problems += [((*place, "id"), f"the id {name!r} occurs twice") for name in twice[:1]]
                ids.update(cases)
            except UsageError as error:
                key, _, text = str(error).partition(": ")
                problems.append(((*place, *key.split(".")), text))
        return problems

    def __reduce__(self) -> tuple[Any, ...]:
        """For another process, as of `Requirements`."""
        return unfilled, (profile_of, kinds_of(type(self.requirements))), self.__getstate__()

    def _unknown_checks(self, row: TestRow) -> Iterator[str]:
        """What is wrong with the kinds that judge a row."""
        kinds = [kind for kind, _ in self.requirements.by_kind()]
        for name in row.checks or ():
            if name not in kinds:
                hint = did_you_mean(name, kinds) or f"; it has: {', '.join(kinds)}"
                yield f"{name!r} is no requirement of this profile{hint}"


def is_ad_hoc(test: str) -> bool:
    """Whether an id is that of a sag of the user's own, of any depth."""
    return re.match(rf"{_AD_HOC}-[0-9.e+-]+{_PERCENT}-", test) is not None


def profile_of(kinds: Kinds) -> type[Profile]:
    """Model of a profile whose demands may be of these kinds."""
    return _model(requirements_of(kinds))


@cache
def _model(requirements: type[Requirements]) -> type[Profile]:
    made: type[Profile] = create_model(
        "Profile", __base__=Profile, __doc__=Profile.__doc__, __module__=__name__, requirements=(requirements, ...)
    )
    return made
