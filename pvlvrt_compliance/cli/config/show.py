"""`pvlvrt-check config show`: what would hold for a run here."""

import json
from typing import Annotated, Any

import typer

from pvlvrt_compliance.cli.options import takes_options
from pvlvrt_compliance.cli.options.files import OPTIONS as OF_FILES
from pvlvrt_compliance.cli.telling import say, say_json

_HELP = """
Show every setting that is not at its default, and where it comes from.

Takes the options of the main command, too, so that it tells what holds for the command that you mean to run.

Example: pvlvrt-check config show --sag 90%
"""


def show(
    list_json: Annotated[bool, typer.Option("--json", metavar="", help="Write JSON.")] = False, **given: Any
) -> None:
    """Show every setting that is not at its default, and where it comes from."""
    from pvlvrt_compliance.cli.settled import of_options
    from pvlvrt_compliance.settings.telling import told

    holds = told(of_options(given))
    if list_json:
        say_json(holds, ensure_ascii=False)
    else:
        _print(holds)


show.__doc__ = _HELP
takes_options(show, shown=tuple(OF_FILES))


def _print(holds: dict[str, Any]) -> None:
    """The same as a table, and what else there is to know below it."""
    from pvlvrt_compliance.cli.tables import Column, print_table

    if holds["values"]:
        rows = [
            (key, _written(each["value"]), _written(each.get("each_from", each["from"])))
            for key, each in holds["values"].items()
        ]
        print_table((Column("setting"), Column("value", folds=True), Column("comes from", folds=True)), rows, gap=2)
    file = holds["file"]
    where = f"no file of settings: {holds['why_not']}" if file is None else f"file of settings: {file}"
    rest = "everything else is at its default" if holds["values"] else "everything is at its default"
    for line in (f"{where}; {rest}", *holds["put_aside"], *holds["warnings"]):
        say(line)


def _written(value: Any) -> str:
    if value is None:
        return "(default)"
    if isinstance(value, list):
        return "\n".join(value)
    return value if isinstance(value, str) else json.dumps(value)
