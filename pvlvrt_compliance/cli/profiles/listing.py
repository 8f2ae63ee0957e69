"""`pvlvrt-check profiles list`."""

from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from pvlvrt_compliance.data.search_path import Known


def list_profiles(
    json: Annotated[bool, typer.Option("--json", metavar="", help="For programs.")] = False,
) -> int:
    """Show all profiles that can be named, with where each comes from.

    Looks in the folders of $PVLVRT_PROFILES, among the shipped ones, and in packages; the first of a name counts.

    Example: pvlvrt-check profiles list
    """
    from pvlvrt_compliance.data.search_path import known_profiles

    entries = [_entry(name, known) for name, known in known_profiles().items()]
    if json:
        from json import dumps

        print(dumps(entries, indent=2))
    else:
        from pvlvrt_compliance.cli.tables import Column, print_table

        columns = (
            Column("name"),
            Column("title", folds=True),
            Column("tests", is_number=True),
            Column("Hz", folds=True),
            Column("weakest", folds=True),
            Column("origin", folds=True),
        )
        print_table(columns, [_cells(entry) for entry in entries], gap=2)
    return 2 if any(entry["problems"] for entry in entries) else 0


def _entry(name: str, known: "Known") -> dict[str, Any]:
    """A profile for programs; keys are only added to. Of one that cannot be read, what is wrong with it."""
    from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
    from pvlvrt_compliance.errors import ProfileError
    from pvlvrt_compliance.profile.loading import load_profile

    of_file = {"name": name, "origin": known.origin, "file": str(known.path)}
    try:
        profile = load_profile(str(known.path), INSTALLED_KINDS)
    except ProfileError as error:
        return {**of_file, "problems": list(error.problems)}
    cases = profile.tests()
    return {
        **of_file,
        "id": profile.id,
        "title": profile.title,
        "tests": len(cases),
        "frequencies_hz": sorted({case.scenario.nominal_frequency_hz for case in cases}),
        "checks": [kind for kind, _ in profile.requirements.by_kind()],
        "weakest": profile.weakest_mark,
        "digest": profile.digest,
        "problems": [],
    }


def _cells(entry: dict[str, Any]) -> tuple[str, ...]:
    name, origin = entry["name"], entry["origin"]
    if count := len(entry["problems"]):
        return name, f"{count} problem{'s' * (count > 1)}: profiles check {name}", "", "", "", origin
    hz = ", ".join(f"{frequency:g}" for frequency in entry["frequencies_hz"])
    return name, entry["title"], str(entry["tests"]), hz, entry["weakest"], origin
