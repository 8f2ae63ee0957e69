"""The main command: judge an inverter's controller against a profile."""

from dataclasses import fields
from typing import Annotated, Any

import typer

from pvlvrt_compliance.cli.at_once import VERSION
from pvlvrt_compliance.cli.at_once import version as version_in_words
from pvlvrt_compliance.cli.options import given_options, spelled, takes_options
from pvlvrt_compliance.cli.telling import say

_HELP = """
Judge a PV inverter's controller against a grid code.

Simulates the profile's tests, or the one sag given with --sag, on the bundled 500 kVA inverter, checks the \
waveforms and writes report.html, junit.xml, results.json and the waveforms.

Example: [bold]pvlvrt-check --profile iec61400-21 --sag 90%[/bold]

Exit status: 0 all passed, 1 a check failed, 2 wrong usage or profile, 3 something could not be simulated, \
evaluated or written, or nothing was judged, 130 interrupted, 143 terminated (SIGTERM).
"""


def _print_version(context: typer.Context, wanted: bool) -> None:
    if wanted and not context.resilient_parsing:  # as a shell reads the line that it completes
        say(version_in_words())
        raise typer.Exit


@takes_options
def check(
    context: typer.Context,
    version: Annotated[
        bool, typer.Option(VERSION, metavar="", callback=_print_version, is_eager=True, help="Show the version.")
    ] = False,
    **given: Any,
) -> int | None:
    """Judge a PV inverter's controller against a grid code."""
    del version  # acted on before this function is called
    if context.invoked_subcommand is not None:
        return None
    from pvlvrt_compliance.cli.settled import settled
    from pvlvrt_compliance.results.files import FOLDER
    from pvlvrt_compliance.study.job import AUTO, Asked, make_job

    holds = settled(given)
    of_job, others = given_options(holds.given, [field.name for field in fields(Asked)])
    spell = holds.spell(spelled)
    job = make_job(Asked(**{"jobs": AUTO, **of_job}), spell, last_run=others.get("output", FOLDER))
    as_json = others.pop("list_json", False)
    if others.pop("list_only", False):
        from pvlvrt_compliance.cli.catalogue import show_tests

        return show_tests(job, as_json=as_json)
    from pvlvrt_compliance.cli.running import run

    command = holds.command(context.obj or ("pvlvrt-check",))
    given = holds.given
    return run(job, command=command, spell=spell, settings=holds.provenance, given=given, **others)


check.__doc__ = _HELP
