"""`pvlvrt-check baseline update`."""

from typing import Annotated, Any

import typer

from pvlvrt_compliance.cli.options import takes
from pvlvrt_compliance.cli.options.files import OPTIONS as OF_SETTINGS
from pvlvrt_compliance.cli.telling import say

_SETTLED = ("baseline", "output")
"""Settings that say where the files are."""


@takes(OF_SETTINGS)
def update(
    file: Annotated[
        str | None,
        typer.Argument(metavar="FILE", help="The baseline. Default pvlvrt-baseline.txt.", show_default=False),
    ] = None,
    results: Annotated[
        str | None,
        typer.Option(
            "--results",
            metavar="FOLDER|FILE",
            show_default=False,
            help="Of the run: its folder, or its results.json. Default pvlvrt-report.",
        ),
    ] = None,
    margins: Annotated[
        bool | None,
        typer.Option(
            "--margins/--no-margins",
            metavar="",
            show_default=False,
            help="A line for what passed, too, so that a lost margin is seen. Default: as the file is.",
        ),
    ] = None,
    prune: Annotated[
        bool, typer.Option("--prune", metavar="", help="Drop lines of tests that were not run, too.")
    ] = False,
    reason: Annotated[str, typer.Option("--reason", metavar="TEXT", help="Of the failures that have none.")] = "",
    check: Annotated[
        bool, typer.Option("--check", metavar="", help="Write nothing; exit status 1 when the file would change.")
    ] = False,
    **given: Any,
) -> int:
    """Write the known failures of a run, or bring them up to date; reasons stay.

    Example: pvlvrt-check baseline update --results pvlvrt-report --reason "ticket 42"
    """
    from pvlvrt_compliance.cli.settled import settled
    from pvlvrt_compliance.cli.writing import write_over
    from pvlvrt_compliance.errors import unwritable
    from pvlvrt_compliance.ordinary_file import real
    from pvlvrt_compliance.results.files import BASELINE, FOLDER
    from pvlvrt_compliance.study.baseline.files import update_file

    holds = settled(given | {"baseline": file, "output": results}, _SETTLED).given
    done = update_file(
        holds.get("baseline", BASELINE),
        holds.get("output", FOLDER),
        margins=margins,
        prune=prune,
        reason=reason,
    )
    if done.is_changed and not check:
        try:
            write_over(real(done.file), done.content)  # where a link leads: it stays one
        except OSError as error:
            raise unwritable(f"{done.file}: cannot be written ({error.strerror})", error) from None
    for line in done.said:
        say(line)
    return int(check and done.is_changed)
