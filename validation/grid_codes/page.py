"""The page on the grid codes, from verdicts of every shipped profile on the paper's controller."""

import csv
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby
from typing import Any

from pvlvrt_compliance import api
from pvlvrt_compliance.data.marks import marks_in
from pvlvrt_compliance.data.search_path import SHIPPED, known_profiles
from pvlvrt_compliance.profile import Profile
from pvlvrt_compliance.profile.loading import load_profile
from validation.places import DOCS

PAGE = DOCS / "grid-codes.md"
VERDICTS = DOCS / "grid_codes" / "verdicts.csv"
SHORT_S = 4.0
NO_UNDERVOLTAGE_RELAY = "protection.undervoltage_curve=[[0,0],[3600,0]]"

HEAD = """# The paper's controller under the shipped grid codes

Every test of every shipped profile, on the bundled inverter with its default settings: `pvlvrt-check --profile all`
(tests of half an hour left out). This page is written by `python -m validation.grid_codes`;
[`verdicts.csv`](grid_codes/verdicts.csv) has the verdict of each check in each test. The controller was made for
eq (9) of the paper, not for these codes, so failures are expected: each is stated with the clause and the worst test.
Marks beside a clause say how far its numbers were verified (see the profiles). Before each table stands what the
profile says beside its limits: which tests need not be ridden through as a whole, how much current is the least, and
which rows carry a mark of their own.
"""
RELAY = """## Without the undervoltage relay

The relay of the plant follows the Spanish envelope and opens before the codes below let it. The tests that fail
`ride_through` above, with a relay that never opens (`--set {setting}`), show what is left to the control:
"""

Test = dict[str, Any]


def judged(profiles: Iterable[str], *, tests: Sequence[str] = (), settings: Sequence[str] = ()) -> list[Test]:
    """Run profiles and return their tests as results.json has them; no report is made."""
    found: list[Test] = api.check(list(profiles), tests=tests, settings=settings).model_dump(mode="json")["tests"]
    return found


def shipped() -> list[str]:
    """Names of the profiles that ship and have tests."""
    names = [name for name, known in known_profiles().items() if known.origin == SHIPPED]
    return [name for name in names if load_profile(name).tests()]


def row(test: Test) -> list[str]:
    """Line of the table of verdicts."""
    return [test["profile"], test["id"], " ".join(f"{check['check']}={check['status']}" for check in test["checks"])]


def counted(tests: Sequence[Test]) -> list[str]:
    """Table of one profile: verdicts by check."""
    kinds = dict.fromkeys(
        (check["check"], check["clause"], check["confidence"]) for t in tests for check in t["checks"]
    )
    names = dict.fromkeys(kind for kind, _, _ in kinds)
    lines = ["| check | pass | fail | not applicable | not evaluated |", "|---|---|---|---|---|"]
    for name in names:
        found = [check["status"] for test in tests for check in test["checks"] if check["check"] == name]
        cells = [found.count(s) or "" for s in ("pass", "fail", "not_applicable")]
        cells.append(found.count("not_evaluated") + found.count("error") or "")
        lines.append(f"| `{name}` | " + " | ".join(map(str, cells)) + " |")
    return lines


def worst_of(tests: Sequence[Test]) -> list[str]:
    """For each check that fails: clause, how often, and the message of the test furthest beyond the limit."""
    failed: dict[str, list[tuple[float, Test, dict[str, Any]]]] = {}
    for test in tests:
        for check in test["checks"]:
            if check["status"] == "fail":
                limit = abs(check["limit"] or 0) or 1.0
                beyond = (check["margin"] or 0.0) / limit
                failed.setdefault(check["check"], []).append((beyond, test, check))
    lines = []
    for name, found in failed.items():
        _, test, check = min(found, key=lambda item: item[0])
        ids = ", ".join(f"`{item['id']}`" for _, item, _ in found)
        lines.append(
            f"- `{name}` ({check['clause']}, {check['confidence'] or 'no mark'}): fails in {ids}. "
            f"Furthest beyond in `{test['id']}`: {check['message']}."
        )
    return lines


def demanded(profile: Profile) -> list[str]:
    """What a profile says beside its limits: what its tests demand, the least current, marks of single rows."""
    return [*_expected(profile), *_least_current(profile), *_own_marks(profile)]


def _expected(profile: Profile) -> Iterator[str]:
    for expect, words in (("may_trip", "may trip where the limits let it go"), ("must_trip", "must trip")):
        rows = [row for row in profile.all_rows if row.expect == expect]
        if rows:
            ids = ", ".join(f"`{row.id}`" + ("" if row.by_s is None else f" by {row.by_s:g} s") for row in rows)
            yield f"- {words}: {ids}; all other tests are to be ridden through as a whole."


def _least_current(profile: Profile) -> Iterator[str]:
    regions = profile.ride_through.regions if profile.ride_through else None
    if regions is not None and (least := regions.least_current_fraction) is not None:
        of = "the three phases together (rms)" if regions.least_current_of == "apparent" else "the phase with the most"
        amount = f"{least.value:g} of the current before, of {of} ({least.confidence})"
        yield f"- least current in mandatory operation: {amount}."


def _own_marks(profile: Profile) -> Iterator[str]:
    found: dict[tuple[str, str], list[str]] = {}
    for kind, requirement in profile.requirements.by_kind():
        for name, mark in marks_in(requirement, kind):
            if name.endswith("]"):
                found.setdefault((mark.confidence, mark.source), []).append(f"`{name}`")
    for (confidence, source), names in found.items():
        yield f"- {', '.join(names)}: {confidence} ({source}), a mark of the row's own."


def section(profile: str, tests: Sequence[Test]) -> str:
    """One profile on the page."""
    content = load_profile(profile)
    head = f"## {profile}\n\n{content.title}; {len(tests)} tests.\n"
    said = demanded(content)
    outcome = worst_of(tests) or ["Everything that applies is passed."]
    return "\n".join([head, *said, *([""] if said else []), *counted(tests), "", *outcome, ""])


def without_relay(tests: Sequence[Test]) -> str:
    """The tests that fail ride-through, with a relay that never opens."""
    lines = [RELAY.format(setting=NO_UNDERVOLTAGE_RELAY)]
    lines += ["| profile | tests | ride_through passes | still fails in |", "|---|---|---|---|"]
    failed = [t for t in tests if any(c["check"] == "ride_through" and c["status"] == "fail" for c in t["checks"])]
    for profile, group in groupby(failed, key=lambda test: test["profile"]):
        ids = [test["id"] for test in group]
        again = judged([profile], settings=[NO_UNDERVOLTAGE_RELAY], tests=ids)
        bad = [t["id"] for t in again if not _rides_through(t)]
        lines.append(f"| {profile} | {len(ids)} | {len(again) - len(bad)} | {', '.join(f'`{n}`' for n in bad)} |")
    return "\n".join(lines) + "\n"


def _rides_through(test: Test) -> bool:
    return all(c["status"] in {"pass", "not_applicable"} for c in test["checks"] if c["check"] == "ride_through")


def write() -> None:
    """Run everything; write page and table."""
    tests = judged(shipped())
    pages = [section(profile, list(group)) for profile, group in groupby(tests, key=lambda test: test["profile"])]
    PAGE.write_text("\n".join([HEAD, *pages, without_relay(tests)]), encoding="utf-8")
    with VERDICTS.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([["profile", "test", "verdicts"], *map(row, tests)])


def check() -> list[str]:
    """Run the shorter tests of each profile and compare their verdicts with the table: what differs."""
    with VERDICTS.open(encoding="utf-8", newline="") as file:
        written = {tuple(line[:2]): line[2] for line in list(csv.reader(file))[1:]}
    profiles = {name: load_profile(name) for name in shipped()}
    of_tests = {
        (name, test.id): test for name, profile in profiles.items() for test in profile.tests() if not test.long
    }
    problems = [f"{'.'.join(key)} is not in the table" for key in of_tests.keys() - written.keys()]
    whole_rows = _rows_of_short_tests(of_tests)
    found = judged(profiles, tests=[".".join(key) for key in whole_rows])
    return problems + [
        f"{'.'.join(line[:2])}: {line[2]}" for line in map(row, found) if written.get((line[0], line[1])) != line[2]
    ]


def _rows_of_short_tests(of_tests: dict[tuple[str, str], Any]) -> list[tuple[str, str]]:
    """Tests of the rows whose records are all short: a verdict on repeated runs needs the whole row."""
    long = {(name, test.row) for (name, _), test in of_tests.items() if test.scenario.end_s > SHORT_S}
    return [key for key, test in of_tests.items() if (key[0], test.row) not in long]
