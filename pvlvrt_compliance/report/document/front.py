"""The first page: what was tested against what, how it ended, and what it rests on."""

from collections.abc import Iterator
from typing import Any, NamedTuple

from pvlvrt_compliance.report.format import number, row
from pvlvrt_compliance.report.gate import STOPS, told_of
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.report.logo import logo_content
from pvlvrt_compliance.report.provenance import out_of_range_in_words
from pvlvrt_compliance.report.verdicts import counts_by, name_of, part_of
from pvlvrt_compliance.results import ProfileSummary, Results, Status, Verdict
from pvlvrt_compliance.results.details import FIELDS, IDENTITY

_LOGO = "logo"
_DIGITS = 16  # of a digest, enough to tell profiles apart; the whole of it stands with the provenance


class Fact(NamedTuple):
    """One thing that is known, with its name in the language of the report."""

    name: str
    text: str


class Code(NamedTuple):
    """A code that was judged against, and what is known of its text."""

    title: str
    facts: tuple[Fact, ...]


class Place(NamedTuple):
    """A verdict in its test; ``number`` is the test's in the report, from 1 on."""

    number: int
    test: str
    verdict: Verdict


class Front(NamedTuple):
    """What the first page says.

    ``worst`` has a verdict for every check with a margin, the nearest to failing first; ``failed`` are the numbers of
    tests with a failed or erroneous verdict, ``red`` of those that make the run red, which a known failure does not and
    a lost margin may.
    """

    tested: tuple[Fact, ...]
    document: tuple[Fact, ...]
    logo: str
    against: tuple[Code, ...]
    worst: tuple[Place, ...]
    marginal: tuple[Place, ...]
    unverified: int
    failed: tuple[int, ...]
    red: tuple[int, ...]
    scope: tuple[str, ...]
    on_the_run: tuple[str, ...]

    @property
    def first_failure(self) -> int:
        """Number of the test to look at first: what makes the run red before what is known; 0 where there is none."""
        return next(iter(self.red or self.failed), 0)

    @property
    def failures(self) -> tuple[int, ...]:
        """Numbers of all tests that somebody may want to look at, in order."""
        return tuple(sorted({*self.red, *self.failed}))


def front(results: Results, texts: Texts) -> Front:
    """What the first page of a run says in the language of ``texts``."""
    fields = results.report.fields
    places = [
        Place(n, name_of(test, results), verdict)
        for n, test in enumerate(results.tests, start=1)
        for verdict in test.checks
    ]
    return Front(
        tested=(*_fields(fields, texts, identity=True), *_plant(results, texts), *_origin(results.provenance, texts)),
        document=tuple(_fields(fields, texts, identity=False)),
        logo=_picture(fields.get(_LOGO, "")),
        against=tuple(Code(profile.title, tuple(_code(profile, texts))) for profile in results.profiles),
        worst=_worst(results),
        marginal=tuple(place for place in places if place.verdict.is_marginal),
        unverified=sum(len(profile.notes) for profile in results.profiles),
        failed=failed(results),
        red=red(results),
        scope=tuple(_scope(results, texts)),
        on_the_run=tuple(_on_the_run(results, texts)),
    )


def failed(results: Results) -> tuple[int, ...]:
    """Numbers of the tests in which a verdict is a failure or an error, from 1 on."""
    bad = {Status.FAIL, Status.ERROR}
    return tuple(n for n, test in enumerate(results.tests, start=1) if bad & set(test.statuses))


def red(results: Results) -> tuple[int, ...]:
    """Numbers of the tests that make the run red by a failure, an error or a lost margin, from 1 on."""
    return tuple(
        n
        for n, test in enumerate(results.tests, start=1)
        if any(each.outcome in STOPS and each.verdict.status is not Status.NOT_EVALUATED for each in told_of(test))
    )


def margin_in_words(verdict: Verdict, texts: Texts) -> str:
    """The margin, and what share of the limit it is: ``margin -4.2 kvar, -2.6 % of the limit``."""
    share = verdict.relative_margin
    margin = row(verdict, texts).margin
    if share is None:
        return texts("front.margin", margin=margin)
    return texts(
        "front.margin_share",
        margin=margin,
        share=number(100 * share, "%", decimals=0 if abs(share) >= 1 else 1, sign=True),
    )


def _worst(results: Results) -> tuple[Place, ...]:
    """The worst verdict of each check, those of the checks that come nearest to failing."""
    numbers = {test.key: n for n, test in enumerate(results.tests, start=1)}
    found: dict[str, Place] = {}
    for test, verdict in results.worst_margins(len(results.verdicts())):
        found.setdefault(verdict.check, Place(numbers[test.key], name_of(test, results), verdict))
    return tuple(found.values())


def _picture(address: str) -> str:
    """The address of a logo; nothing where it is none of a picture."""
    return address if logo_content(address) else ""


def _fields(fields: dict[str, str], texts: Texts, *, identity: bool) -> Iterator[Fact]:
    """Fields that whoever files the report gave, of what was tested or of the document, in the order of `FIELDS`."""
    for name in FIELDS:
        if name in fields and name != _LOGO and (name in IDENTITY) is identity:
            yield Fact(texts.named("front.field", name), fields[name])


def _plant(results: Results, texts: Texts) -> Iterator[Fact]:
    """A line for each rating, with all frequencies at which it was tested."""
    tested: dict[tuple[float, float], set[float]] = {}
    for rating in (test.rating for test in results.tests if test.rating):
        tested.setdefault((rating.apparent_power_kva, rating.phase_voltage_v), set()).add(rating.frequency_hz)
    for (power, voltage), hertz in tested.items():
        values = {"power": f"{power:g}", "voltage": f"{voltage:g}", "hertz": ", ".join(f"{x:g}" for x in sorted(hertz))}
        yield Fact(texts("front.plant"), texts("front.rating", **values))


def _origin(provenance: dict[str, Any], texts: Texts) -> Iterator[Fact]:
    """The controller with all that identifies it, or the record that was judged."""
    version = provenance.get("versions", {}).get("pvlvrt-compliance", "")
    if provenance.get("controller") == "bundled":
        yield Fact(texts("front.controller"), texts("front.bundled", version=version))
    elif "controller" in provenance:
        yield Fact(texts("front.controller"), provenance.get("controller_name") or provenance["controller"])
        yield Fact(texts("front.controller_kind"), provenance.get("controller_kind", ""))
        yield Fact(texts("front.controller_file"), provenance["controller"])
        if words := out_of_range_in_words(provenance):
            yield Fact(texts("front.out_of_range"), words)
    elif "record" in provenance:
        yield Fact(texts("front.record"), str(provenance["record"]))
    for name in ("controller_digest", "record_digest"):
        if provenance.get(name):
            yield Fact(texts(f"front.{name}"), str(provenance[name]))


def _on_the_run(results: Results, texts: Texts) -> Iterator[str]:
    """What is to be said of the run as a whole besides its verdict."""
    if results.nothing_judged:
        yield texts("front.nothing_judged")
    if results.counts_as is not results.status:
        yield texts("front.counts_as", verdict=texts(f"status.{results.counts_as}"), by=counts_by(results))
    part = part_of(results)
    if part.checks:
        yield texts("front.only_checks", checks=", ".join(texts.named("check", name) for name in part.checks))
    if part.not_selected:
        yield texts("front.not_selected", count=part.not_selected)
    if part.not_run:
        ended = texts("front.stopped_at", test=part.ended_at) if part.ended_at else texts("front.interrupted")
        yield f"{ended} {texts('front.not_run', count=part.not_run)}"


def _code(profile: ProfileSummary, texts: Texts) -> Iterator[Fact]:
    """What is known of the text of a code, then of the profile that was made from it."""
    of = profile.applies_to
    known = {
        "edition": profile.edition,
        "jurisdiction": profile.jurisdiction,
        "applies_plant": of.plant,
        "applies_power": of.power,
        "applies_voltage": of.voltage,
        "address": profile.address,
        "read_on": "" if profile.read_on is None else profile.read_on.isoformat(),
        "profile": profile.id,
        "digest": profile.digest[:_DIGITS],
    }
    yield from (Fact(texts(f"front.{name}"), text) for name, text in known.items() if text)


def _scope(results: Results, texts: Texts) -> Iterator[str]:
    """What the report is and is not, in sentences."""
    simulation = results.provenance.get("parameters", {}).get("simulation", {})
    yield texts("scope.pre_study")
    if not simulation:
        yield texts("scope.recording")
    else:
        yield texts(f"scope.{'switched' if simulation.get('fidelity') == 'switched' else 'averaged'}")
    yield texts("scope.uncertainty")
