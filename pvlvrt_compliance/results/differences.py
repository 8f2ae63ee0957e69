"""What two runs were made with that is not the same: parameters path by path, versions, controllers, profiles."""

import json
from collections.abc import Iterator, Mapping
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from pvlvrt_compliance.results.results import Results, TestResult
from pvlvrt_compliance.texts import Id, Name, Plain, Text

_Where = Literal["both", "old", "new"]

_TOLD_ELSEWHERE = frozenset({"created", "profile", "profile_digest"})
"""Of the provenance: when a run was, and what `ProfileDifference` says by profile."""

_NOTHING: tuple[Any, ...] = ("", (), [], {})


class Difference(BaseModel):
    """One thing that is not the same."""

    model_config = ConfigDict(frozen=True, extra="ignore")

    path: Text = Field(description="names joined by dots: parameters.controller.fault_threshold_pu, versions.numpy")
    there: _Where = Field(default="both", description="which of the runs says anything of it")
    old: Plain = None
    new: Plain = None
    tests: tuple[Name, ...] = Field(default=(), description="of what only these tests were asked: their scenario")


class ProfileDifference(BaseModel):
    """A profile that is not the same in both runs."""

    model_config = ConfigDict(frozen=True, extra="ignore")

    id: Id
    there: _Where = "both"
    old_digest: Name = ""
    new_digest: Name = ""


def profile_differences(old: Results, new: Results) -> tuple[ProfileDifference, ...]:
    """Profiles of one id and another content, whose limits may have moved, and those that only one run has."""
    before, after = ({one.id: one.digest for one in run.profiles} for run in (old, new))
    return tuple(
        ProfileDifference(
            id=name,
            there=_there(name, before, after),
            old_digest=before.get(name, ""),
            new_digest=after.get(name, ""),
        )
        for name in dict.fromkeys([*before, *after])
        if before.get(name) != after.get(name)
    )


def differences_between(old: Results, new: Results) -> tuple[Difference, ...]:
    """Everything else that the runs say of how they were made, and the scenarios of tests that both have."""
    before, after = (_flat(_of_the_run(run.provenance)) for run in (old, new))
    found = [
        Difference(path=path, there=_there(path, before, after), old=before.get(path), new=after.get(path))
        for path in dict.fromkeys([*before, *after])
        if _differ(path, before, after)
    ]
    return (*found, *_of_scenarios(old, new))


def _of_the_run(provenance: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in provenance.items() if name not in _TOLD_ELSEWHERE}


def _of_scenarios(old: Results, new: Results) -> Iterator[Difference]:
    """What tests of one key were asked otherwise; tests that differ alike are told together."""
    before: dict[str, TestResult] = {test.key: test for test in old.tests}
    alike: dict[str, tuple[Difference, list[str]]] = {}
    for test in new.tests:
        if test.key in before and test.scenario != before[test.key].scenario:
            for one in _of_a_scenario(before[test.key].scenario, test.scenario):
                _, tests = alike.setdefault(one.model_dump_json(), (one, []))
                tests.append(test.key)
    for one, tests in alike.values():
        yield one.model_copy(update={"tests": tuple(tests)})


def _of_a_scenario(old: Mapping[str, Any], new: Mapping[str, Any]) -> Iterator[Difference]:
    before, after = _flat(old, "scenario."), _flat(new, "scenario.")
    for path in dict.fromkeys([*before, *after]):
        if _differ(path, before, after):
            yield Difference(path=path, there=_there(path, before, after), old=before.get(path), new=after.get(path))


def _there(name: str, before: Mapping[str, Any], after: Mapping[str, Any]) -> _Where:
    if name in before:
        return "both" if name in after else "old"
    return "new"


def _differ(path: str, before: Mapping[str, Any], after: Mapping[str, Any]) -> bool:
    """Whether two values do not read alike in a file; a tuple is the list that it is written as, nothing is nothing."""
    if path not in before or path not in after:
        return (before[path] if path in before else after[path]) not in _NOTHING
    old, new = (json.dumps(of[path], sort_keys=True, default=str) for of in (before, after))
    return old != new


def _flat(values: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, value in values.items():
        if isinstance(value, Mapping) and value:
            found |= _flat(value, f"{prefix}{name}.")
        else:
            found[f"{prefix}{name}"] = value
    return found
