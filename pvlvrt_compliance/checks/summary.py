"""The profile as a report shows it: the text it is made from, every clause that it knows, what is not verified."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from pvlvrt_compliance.data.marks import marks_in, weakest
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.results import AppliesToSummary, ClauseSummary, NotCoveredSummary, ProfileSummary


def summarise(
    profile: Profile,
    tests: Iterable[TestCase],
    left_out: Iterable[TestCase] = (),
    not_selected: Iterable[TestCase] = (),
    not_run: Iterable[TestCase] = (),
    selected_checks: Iterable[str] = (),
) -> ProfileSummary:
    """The profile as a report on these tests shows it, with what is not verified and what has not been run.

    Parameters
    ----------
    profile : Profile
    tests : iterable of TestCase
        Those that were run.
    left_out, not_selected, not_run : iterable of TestCase
        Long ones that nobody asked for, those that were selected away, and those that a run came to its end before.
    selected_checks : iterable of str
        Kinds that were judged, where only some were asked for.
    """
    return ProfileSummary(
        id=profile.id,
        title=profile.title,
        digest=profile.digest,
        edition=profile.edition,
        jurisdiction=profile.jurisdiction,
        applies_to=AppliesToSummary(**profile.applies_to.model_dump()),
        address=profile.address,
        read_on=profile.read_on,
        not_covered=tuple(NotCoveredSummary(**entry.model_dump()) for entry in profile.not_covered),
        clauses=clauses_of(profile),
        notes=profile.unverified({test.id for test in tests}),
        left_out=tuple(test.id for test in left_out),
        selected_checks=tuple(selected_checks),
        not_selected=tuple(test.id for test in not_selected),
        not_run=tuple(test.id for test in not_run),
    )


def clauses_of(profile: Profile) -> tuple[ClauseSummary, ...]:
    """Every clause that a profile knows, in the order of its file: of requirements, of their parts, of tests."""
    tests = profile.tests()
    found: dict[str, list[_Place]] = {}
    for place in (*_of_requirements(profile), *_of_tests(profile, tests)):
        found.setdefault(place.clause, []).append(place)
    return tuple(_summary(clause, places, tests) for clause, places in found.items())


class _Place(NamedTuple):
    """Where a profile names a clause."""

    clause: str
    confidence: str
    check: str = ""
    part: str = ""
    test: str = ""


def _of_requirements(profile: Profile) -> Iterator[_Place]:
    for kind, requirement in profile.requirements.by_kind():
        yield _Place(requirement.clause, requirement.confidence, check=kind)
        for name, item in marks_in(requirement):
            if clause := getattr(item, "clause", ""):
                yield _Place(clause, weakest(item.marks), check=kind, part=f"{kind}.{name}")


def _of_tests(profile: Profile, tests: Iterable[TestCase]) -> Iterator[_Place]:
    steps = profile.procedure.steps
    tables = {row.id: steps[row.steps.table] for row in profile.all_rows if row.steps is not None}
    for test in tests:
        yield _Place(test.clause, test.confidence, test=test.id)
        row = profile.row_of(test)
        if row in tables and tables[row].clause:
            yield _Place(tables[row].clause, tables[row].confidence, test=test.id)


def _summary(clause: str, places: list[_Place], tests: Iterable[TestCase]) -> ClauseSummary:
    kinds = {place.check for place in places if place.check}
    judged = [test for test in tests if any(test.judges(kind) for kind in kinds)]
    return ClauseSummary(
        clause=clause,
        checks=tuple(dict.fromkeys(place.check for place in places if place.check and not place.part)),
        parts=tuple(dict.fromkeys(place.part for place in places if place.part)),
        tests=tuple(dict.fromkeys(place.test for place in places if place.test)),
        judged_tests=len(judged),
        judged_long=sum(test.long for test in judged),
        confidence=weakest(place.confidence for place in places if place.confidence),
    )
