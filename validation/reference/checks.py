"""The facts on the page of each check, and the index of these pages; the rest of a page is written by hand."""

from collections.abc import Iterator
from inspect import getdoc
from pathlib import Path
from typing import Any, get_args

from pvlvrt_compliance.checks.registry import find_check
from pvlvrt_compliance.data.marks import Choice, Flag, Frozen, Number, Numbers
from pvlvrt_compliance.data.search_path import SHIPPED, known_profiles
from pvlvrt_compliance.profile import Profile, load_profile
from pvlvrt_compliance.profile.requirements import BUILT_IN, Requirement
from validation.mutations.mutants import MUTANTS
from validation.places import DOCS
from validation.reference.markdown import code, page, table
from validation.reference.numbers import told, unit_of

FOLDER = DOCS / "checks"
BEGIN, END = "<!-- facts -->\n", "<!-- end of facts -->\n"

_SCOPE = {
    "record": "each record as a whole",
    "stretch": "each stretch between two steps of the grid; the worst is reported",
    "row": "all runs of a row of the test table together",
}
_INDEX = """# Checks

A check holds what was measured in one record against one kind of requirement of a profile and gives a verdict: `pass`,
`fail`, `not_applicable` (the code lets it off), `not_evaluated` (evidence is missing) or `error`. Each page says what
is asked, how it is measured, with which limits, and what the check does not see. How every number is computed, to the
last digit, stands in [measurements](../measurements.md); that each check tells a wrong controller from a right one, in
[mutations](../mutations.md). The facts at the end of each page are made by `python -m validation.reference`.
"""


def pages() -> dict[str, Path]:
    """The page of each built-in check, by its kind."""
    return {kind: FOLDER / f"{kind}.md" for kind in BUILT_IN}


def missing() -> list[str]:
    """Names of pages that nobody has written yet."""
    return [file.name for file in pages().values() if not file.exists()]


def contents() -> dict[Path, str]:
    """Text of every page with its facts, and of the index, by path."""
    profiles = [load_profile(name) for name, known in sorted(known_profiles().items()) if known.origin == SHIPPED]
    found = {file: with_facts(file.read_text("utf-8"), kind, profiles) for kind, file in pages().items()}
    return {**found, FOLDER / "index.md": page([_INDEX, *_overview(profiles)])}


def with_facts(text: str, kind: str, profiles: list[Profile]) -> str:
    """The text of a page with its check's facts in their place."""
    head, _, rest = text.partition(BEGIN)
    _, _, tail = rest.partition(END)
    return f"{head}{BEGIN}\n{page(_facts(kind, profiles))}\n{END}{tail}"


def _overview(profiles: list[Profile]) -> Iterator[str]:
    rows = []
    for kind in BUILT_IN:
        check = find_check(kind)
        count = sum(profile.requirements.of_kind(kind) is not None for profile in profiles)
        rows.append((f"[{check.title}]({kind}.md)" if check else kind, code(kind), str(count)))
    yield from table(("check", "key in profiles and results", "profiles that have it"), rows)


def _facts(kind: str, profiles: list[Profile]) -> Iterator[str]:
    check = find_check(kind)
    if check is None:
        raise LookupError(f"no check of the kind {kind!r}")
    yield "| in short | |"
    yield "|---|---|"
    yield f"| name in profiles, `results.json` and `junit.xml` | `{kind}` |"
    yield f"| judges | {_SCOPE[check.scope]} |"
    yield f"| after a trip | {_after_a_trip(check.judges_connection, check.judges_up_to_trip)} |"
    yield ""
    yield from table(("key of the requirement", "unit", "meaning"), _keys(check.requirement))
    yield from table(("profile", "clauses", "numbers"), _in_profiles(kind, profiles))
    yield from _mutants(kind)


def _after_a_trip(judges_connection: bool, judges_up_to_trip: bool) -> str:
    if judges_connection:
        return "says whether the inverter was allowed to stop"
    return "judges what was before it" if judges_up_to_trip else "`not_applicable`"


def _keys(requirement: type[Requirement]) -> Iterator[tuple[str, str, str]]:
    for name, field in requirement.model_fields.items():
        if name not in {"clause", "source"}:
            needed = "" if field.is_required() else " (may be left out)"
            meaning = field.description or _of_its_model(field.annotation)
            yield code(field.alias or name), unit_of(name), f"{meaning}{needed}".strip()


def _of_its_model(annotation: Any) -> str:
    """What the model of a table says of itself; nothing of a plain number."""
    forms = [annotation, *get_args(annotation)]
    models = [form for form in forms if isinstance(form, type) and issubclass(form, Frozen)]
    tables = [model for model in models if not issubclass(model, Number | Numbers | Flag | Choice)]
    return " ".join((getdoc(tables[0]) or "").split("\n\n")[0].split()).rstrip(".") if tables else ""


def _in_profiles(kind: str, profiles: list[Profile]) -> Iterator[tuple[str, str, str]]:
    for profile in profiles:
        requirement = profile.requirements.of_kind(kind)
        if requirement is not None:
            numbers = list(told(requirement))
            clauses = dict.fromkeys([requirement.clause, *_clauses_of_parts(requirement)])
            values = "; ".join(f"{code(each.key)} {each.value} ({each.confidence})" for each in numbers)
            yield f"[{profile.id}](../profiles/{profile.id}.md)", "; ".join(clauses), values


def _clauses_of_parts(requirement: Requirement) -> Iterator[str]:
    parts = (getattr(requirement, name) for name in type(requirement).model_fields)
    yield from (clause for part in parts if (clause := getattr(part, "clause", "")))


def _mutants(kind: str) -> Iterator[str]:
    """Wrong controllers that must fail the check."""
    names = [mutant.name for mutant in MUTANTS if kind in mutant.fails]
    yield f"Wrong controllers of the [mutation table](../mutations.md) that fail it, and must: {len(names)}."
    yield ""
    yield from (f"- {name}" for name in names)
