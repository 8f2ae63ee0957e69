"""`pvlvrt-check profiles list`."""

from typing import Annotated, Any

import typer

from pvlvrt_compliance.cli.telling import say_json


def list_profiles(
    json: Annotated[bool, typer.Option("--json", metavar="", help="For programs.")] = False,
) -> int:
    """Show all profiles that can be named, with where each comes from.

    Looks in the folders of $PVLVRT_PROFILES, among the shipped ones, and in packages; the first of a name counts.

    Example: pvlvrt-check profiles list
    """
    from pvlvrt_compliance.profile_list import listed_profiles

    entries = listed_profiles()
    if json:
        say_json(entries)
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


def _cells(entry: dict[str, Any]) -> tuple[str, ...]:
    name, origin = entry["name"], entry["origin"]
    if count := len(entry["problems"]):
        return name, f"{count} problem{'s' * (count > 1)}: profiles check {name}", "", "", "", origin
    hz = ", ".join(f"{frequency:g}" for frequency in entry["frequencies_hz"])
    return name, entry["title"], str(entry["tests"]), hz, entry["weakest"], origin
