"""`pvlvrt-check compare`: two runs beside each other."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pvlvrt_compliance.cli.options import given_of, spelled, takes
from pvlvrt_compliance.cli.options.comparing import OF_CONTROLLERS, OPTIONS, SETTLED

if TYPE_CHECKING:
    from pvlvrt_compliance.results.comparison import Comparison
    from pvlvrt_compliance.study.comparing import Runs, Side
    from pvlvrt_compliance.study.job import Spell

_FOLDER = "pvlvrt-comparison"

_HELP = """
Compare two runs: verdicts, margins, tests, parameters, and the waveforms of what has changed.

OLD and NEW are results, or controllers as of --controller ("bundled" is the bundled one), which are run side by side \
with --profile and whatever else is asked for.

Example: [bold]pvlvrt-check compare main/results.json branch/results.json --fail-on margin:5%[/bold]

Example: [bold]pvlvrt-check compare old.so new.so --profile iec61400-21 --test 'VD3*'[/bold]

Exit status: 0 no regression, 1 a regression, 2 wrong usage, 3 something can no longer be judged, nothing is in both \
runs, or a file cannot be written, 130 interrupted, 143 terminated (SIGTERM).
"""


@takes(OPTIONS)
def compare(
    context: typer.Context,
    old: Annotated[str, typer.Argument(metavar="OLD", help="A results.json, a folder with one, or a controller.")],
    new: Annotated[str, typer.Argument(metavar="NEW", help="The same of the run that is to take its place.")],
    **given: Any,
) -> int:
    """Compare two runs."""
    from pvlvrt_compliance.results.comparison import compare as compare_results
    from pvlvrt_compliance.results.comparison import comparison_status, parse_fail_on

    typed, _ = given_of(OPTIONS, given, OPTIONS)
    fail_on = parse_fail_on(typed.get("fail_on", "verdict"), spelled("fail_on"))
    folder = Path(typed.get("output", _FOLDER))
    found = _sides(context, (old, new), given, folder)
    if isinstance(found, int):
        return found
    before, after = found
    comparison = compare_results(before.results, after.results, fail_on, names=(before.name, after.name))
    left_out = _write(comparison, found, folder, typed.get("language", "en"))
    _show(comparison, folder, left_out, quiet=typed.get("quiet", False))
    return 0 if typed.get("exit_zero") else comparison_status(comparison)


compare.__doc__ = _HELP


def _sides(
    context: typer.Context, names: tuple[str, str], given: Mapping[str, Any], folder: Path
) -> "tuple[Side, Side] | int":
    """Both runs; the exit status where one was stopped."""
    from pvlvrt_compliance.cli.running import stopped
    from pvlvrt_compliance.study.comparing import are_run, refuse_unused, sides_of
    from pvlvrt_compliance.study.job import AUTO, Asked

    holds, _ = given_of(OPTIONS, given, OPTIONS)
    spell: Spell = spelled
    settings: Mapping[str, Any] | None = None
    if are_run(names):
        from pvlvrt_compliance.cli.settled import settled

        found = settled(given, SETTLED)
        holds, spell, settings = found.given, found.spell(spelled), found.provenance
    else:
        refuse_unused([name for name in OF_CONTROLLERS if name in holds], spelled)
    asked = Asked(**{"jobs": AUTO, **{field.name: holds[field.name] for field in fields(Asked) if field.name in holds}})
    command = context.obj or ("pvlvrt-check",)
    try:
        return sides_of(names, asked, str(folder), _runs(command, holds, spell, settings), spell)
    except BaseException as end:
        if (status := stopped(end)) is None:
            raise
        return status


def _runs(
    command: Sequence[str], given: Mapping[str, Any], spell: "Spell", settings: Mapping[str, Any] | None
) -> "Runs":
    """How the command runs a controller: as the main command does."""
    from pvlvrt_compliance.cli.progress import progress_bar
    from pvlvrt_compliance.cli.telling import tell
    from pvlvrt_compliance.output import output_in, report_details
    from pvlvrt_compliance.study.comparing import Runs

    details = report_details(given.get("language", "en"), {}, spell=spell)
    return Runs(
        output=lambda folder, tests: output_in(folder, tests, spell=spell, details=details),
        watch=lambda tests: progress_bar(tests, given.get("quiet", False)),
        tell=tell,
        command=command,
        settings=settings,
    )


def _write(comparison: "Comparison", sides: "tuple[Side, Side]", folder: Path, language: str) -> Sequence[str]:
    """Write all files; why figures were left out."""
    from pvlvrt_compliance.report.comparison.files import draw, render_all
    from pvlvrt_compliance.study.comparing import write_comparison
    from pvlvrt_compliance.study.overlays import overlays_of

    drawn = overlays_of(comparison, *sides, draw)
    write_comparison(str(folder), render_all(comparison, drawn.made, drawn.left_out, language), spelled)
    return drawn.left_out


def _show(comparison: "Comparison", folder: Path, left_out: Sequence[str], *, quiet: bool) -> None:
    from pvlvrt_compliance.cli.telling import screen
    from pvlvrt_compliance.report.comparison import console
    from pvlvrt_compliance.results.files import COMPARISON_PAGE
    from pvlvrt_compliance.texts import one_line

    shown = screen()
    with suppress(SystemExit):  # rich ends the program when the reader of stdout has gone; the verdict still stands
        if quiet:
            shown.print(console.summary_text(comparison), soft_wrap=True)
            return
        if not shown.is_terminal:
            shown.width = console.WIDTH_OF_A_FILE
        shown.print(console.render(comparison))
        for line in console.left_out(left_out):
            shown.print(line, soft_wrap=True)
        shown.print(f"Report: {one_line(str(folder / COMPARISON_PAGE), None)}", soft_wrap=True)
