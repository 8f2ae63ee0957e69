"""Every limit of every shipped profile, just inside and just outside, on records made from the profile's numbers."""

import json
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import pytest

from edges import GENERATORS, Edge, Record
from edges.edge import LATER_S, SHORT_STEP_S, hz, in_a_second_stretch
from pvlvrt_compliance.checks.connection.repeated_runs import KIND, RepeatedRunsCheck
from pvlvrt_compliance.checks.registry import judges_connection
from pvlvrt_compliance.data.marks import marks_in
from pvlvrt_compliance.profile import Profile, known_profiles, load_profile
from pvlvrt_compliance.profile.requirements import Requirement
from pvlvrt_compliance.results import Status, TestResult, Verdict
from pvlvrt_compliance.units import Nominal

BESIDES = {"negative_sequence_current": "reactive_current", "active_power_support": "reactive_support"}
"""Kinds whose checks look at another requirement."""

ON_DETECTION = {"reactive_current", "negative_sequence_current", "support_dynamics"}
"""Kinds that depend on the thresholds of detection."""

WITHOUT_A_SIDE = {
    ("reactive_current", "k_range"): "judges nothing: K that the code lets be set",
    ("negative_sequence_current", "k_range"): "judges nothing: K that the code lets be set",
    ("negative_sequence_current", "reference"): "V- is zero before a sag, so that both references are the same",
}
"""Numbers that no record can be on either side of, and why."""

WITHOUT_ENVELOPE = {"envelope_tolerance_pu"}
"""Numbers of ride-through that do nothing in a profile that has neither envelope nor regions."""


IN_EACH_STRETCH = {
    "current_limit",
    "reactive_support",
    "reactive_current",
    "negative_sequence_current",
    "support_dynamics",
    "reactive_ratio",
    "toggling",
}
"""Kinds whose limits hold in a second sag as in the first."""

LONG_S = 600.0
"""A record that lasts longer takes seconds to be made and judged (s)."""


class Case(NamedTuple):
    """An edge of a requirement in the first profile that has it."""

    profile: Profile
    kind: str
    edge: Edge


def demands() -> Iterator[tuple[Profile, str, Requirement]]:
    """Every requirement of every shipped profile."""
    for name in known_profiles():
        profile = load_profile(name)
        for kind, demand in profile.requirements.by_kind():
            yield profile, kind, demand


def plain(item: Any) -> Any:
    """Numbers without marks and clauses."""
    if isinstance(item, dict):
        return {key: plain(part) for key, part in item.items() if key not in {"confidence", "source", "clause"}}
    return [plain(part) for part in item] if isinstance(item, (list, tuple)) else item


def changed(demand: Requirement, edge: Edge) -> Requirement:
    """The requirement as the edge wants it."""
    fields = {
        name: getattr(demand, name).model_copy(update={"value": new}) if isinstance(new, (int, float)) else new
        for name, new in edge.only.items()
    }
    return demand.model_copy(update=fields)


def judging(case: Case) -> Profile:
    """The profile with this requirement alone, but for what its check looks at besides.

    Whether the sag was the one asked for is another matter: frequencies at the end of the bands leave a V- of 0.03 pu.
    """
    demand = changed(getattr(case.profile.requirements, case.kind), case.edge)
    others = {}
    if (other := BESIDES.get(case.kind)) and not case.edge.alone:
        others[other] = getattr(case.profile.requirements, other)
    requirements = type(case.profile.requirements)(**(others | {case.kind: demand}))
    wide = case.profile.conditions.no_load_tolerance_pu.model_copy(update={"value": 0.05})
    conditions = case.profile.conditions.model_copy(update={"no_load_tolerance_pu": wide})
    return case.profile.model_copy(update={"requirements": requirements, "conditions": conditions})


def key(case: Case) -> str:
    """The same for edges that are made from the same numbers."""
    profile = judging(case)
    detection = profile.detection if case.kind in ON_DETECTION else None
    windows = profile.windows if not judges_connection(case.kind) else None
    parts = (profile.requirements, windows, detection)
    numbers = [plain(part.model_dump(mode="json")) if part is not None else None for part in parts]
    return json.dumps([case.kind, case.edge.label, hz(profile), numbers], sort_keys=True)


def cases() -> list[Case]:
    """Every edge once."""
    found: dict[str, Case] = {}
    for profile, kind, demand in demands():
        if kind in GENERATORS:
            for edge in GENERATORS[kind](demand, profile):
                case = Case(profile, kind, edge)
                found.setdefault(key(case), case)
    return list(found.values())


CASES = cases()


@pytest.fixture
def judge(bench: Callable[..., Any]) -> Callable[[Case, Record], Any]:
    """Judge a record of an edge."""

    def verdict(case: Case, made: Record) -> Any:
        settings = {"dt_s": SHORT_STEP_S, "nominal": Nominal(frequency_hz=hz(case.profile))} | made.settings
        profile = judging(case)
        return bench(
            asked=made.asked, duration_s=made.duration_s, profile=profile, scenario=made.scenario, **settings
        ).check(case.kind)

    return verdict


def records() -> Iterator[Any]:
    """Every record of every edge."""
    for case in CASES:
        for side in ("inside", "outside", "further"):
            if (made := getattr(case.edge, side)) is not None:
                marks = [pytest.mark.slow] if made.duration_s > LONG_S else []
                yield pytest.param(
                    case, made, id=f"{case.profile.id}-{case.kind}-{case.edge.label}-{side}", marks=marks
                )


@pytest.mark.parametrize(("case", "made"), list(records()))
def test_edge(judge, case, made):
    """Just inside of a limit a record passes, or is let off; just outside it is not."""
    check = judge(case, made)
    assert check.status in made.statuses, f"{check.status}: {check.message}"


@pytest.mark.parametrize(("case", "made"), [param for param in records() if param.values[0].kind in IN_EACH_STRETCH])
def test_edge_in_a_second_stretch(judge, case, made):
    """After a sag that nothing is wrong in, the same record is judged the same; a failure lies in the second one."""
    second = in_a_second_stretch(made, case.profile)
    check = judge(case, second)
    assert check.status in second.statuses, f"{check.status}: {check.message}"
    if check.status is Status.FAIL:
        assert check.at_s >= case.profile.procedure.before_s.value + LATER_S - 1e-6
        assert check.stretch
        assert check.bound is not None
        assert recomputed(check) == pytest.approx(check.margin, abs=1e-6)


def recomputed(check: Verdict) -> float:
    """Margin as anyone finds it from the other numbers of a verdict."""
    if check.bound == "at_least":
        return check.measured - (check.limit - check.tolerance)
    measured = abs(check.measured) if check.bound == "band" else check.measured
    return check.limit + check.tolerance - measured


def test_every_number_has_an_edge():
    """Each marked number of each requirement decides an edge, or stands in the list of those that cannot."""
    missing = []
    for profile, kind, demand in demands():
        if kind == KIND:
            continue
        exercised = {name for edge in GENERATORS[kind](demand, profile) for name in edge.numbers}
        named = {
            name for name, _ in marks_in(demand) if not name.endswith("]")
        }  # a row's mark is of its table's numbers
        idle = {name for name in named if (kind, name) in WITHOUT_A_SIDE}
        if kind == "ride_through" and not named & {"envelope", "regions"}:
            idle |= WITHOUT_ENVELOPE
        assert exercised <= named
        assert not exercised & idle
        missing += [f"{profile.id}: {kind}.{name}" for name in sorted(named - exercised - idle)]
    assert not missing
    assert {kind for _, kind, _ in demands()} == {*GENERATORS, KIND}


def test_what_cannot_have_an_edge_exists():
    """The list of numbers without a side names none that no profile has."""
    for kind, name in WITHOUT_A_SIDE:
        assert any(name in dict(marks_in(demand)) for _, found, demand in demands() if found == kind)


def run(number: int, status: Status) -> TestResult:
    """A run of a row, with a verdict on its connection."""
    return TestResult(id=f"run-{number}", status=status, checks=(Verdict(check="ride_through", status=status),))


RULES = {(profile.id, demand) for profile, kind, demand in demands() if kind == KIND}


@pytest.mark.parametrize("demand", [pytest.param(demand, id=name) for name, demand in sorted(RULES, key=str)])
def test_edges_of_repeated_runs(demand):
    """As many runs as the rule wants pass, one less fails; with a second chance, so do the further runs."""
    wanted = int(demand.consecutive.value)
    good = [run(k, Status.PASS) for k in range(wanted)]
    bad = [*good[:-1], run(wanted, Status.FAIL)]
    assert RepeatedRunsCheck().judge_row(demand, good).status is Status.PASS
    assert RepeatedRunsCheck().judge_row(demand, good[:-1]).status is Status.NOT_APPLICABLE
    assert RepeatedRunsCheck().judge_row(demand, bad).status is Status.FAIL
    if demand.consecutive_after_trip is not None:
        further = [run(10 + k, Status.PASS) for k in range(int(demand.consecutive_after_trip.value))]
        assert RepeatedRunsCheck().judge_row(demand, bad, further).status is Status.PASS
        assert RepeatedRunsCheck().judge_row(demand, bad, further[:-1]).status is Status.FAIL
