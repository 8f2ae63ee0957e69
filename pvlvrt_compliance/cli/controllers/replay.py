"""`pvlvrt-check controllers replay`."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import typer

from pvlvrt_compliance.cli.controllers.shared import Assignments, Mapped, OutOfRange, Spec
from pvlvrt_compliance.cli.telling import hand_over, say, say_json, tell
from pvlvrt_compliance.cli.writing import write_over
from pvlvrt_compliance.errors import unwritable

_HELP = """
Feed recorded signals to a controller, without a plant, and compare what it gives with what is expected.

FILE is CSV: a column of times in seconds (t_s), and one for each input, called as the port. Without --expect the \
outputs are written as such a file.

Example: [bold]pvlvrt-check controllers replay ctrl.so --inputs in.csv --expect out.csv --output replay.html[/bold]

Exit status: 0 all inside the tolerance, 1 an output is outside, 2 wrong usage, 3 the controller fails, or gives what \
is no number and nothing is expected.
"""


def replay(
    spec: Spec,
    inputs: Annotated[str, typer.Option("--inputs", metavar="FILE", help="What it is given: CSV.", show_default=False)],
    expect: Annotated[
        str | None,
        typer.Option(metavar="FILE", help="What is expected of its outputs: CSV; may be the file of the inputs."),
    ] = None,
    tolerance: Annotated[
        list[str] | None,
        typer.Option(
            metavar="SHARE+ABS",
            help="What an output may differ by: a share of its largest expected value, and a number in its unit; 0.1%"
            " or 1e-6+1e-9 (default). NAME=SHARE+ABS is for one output; repeatable.",
        ),
    ] = None,
    output: Annotated[
        list[str] | None,
        typer.Option(
            metavar="FILE",
            help="Where it is written: the outputs as .csv, the figure as .html; repeatable. Without --expect and this"
            " the outputs go to standard output.",
        ),
    ] = None,
    hold: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME=NUMBER", help="An input that has no column: what it is held at; repeatable."),
    ] = None,
    mapping: Mapped = None,
    assignments: Assignments = None,
    allow_out_of_range: OutOfRange = False,
    json: Annotated[bool, typer.Option("--json", metavar="", help="The comparison for programs.")] = False,
) -> int:
    """Feed recorded signals to a controller and compare what it gives."""
    from pvlvrt_compliance.controllers.replay.replaying import Asked
    from pvlvrt_compliance.controllers.replay.replaying import replay as replayed
    from pvlvrt_compliance.report.agreement import lines, to_json
    from pvlvrt_compliance.report.replayed import Replayed, as_csv, files_of, refuse_unknown
    from pvlvrt_compliance.simulation.parameters import own_parameters, parameters_from

    refuse_unknown(output or (), "--output")
    given, others = own_parameters(assignments or ())
    asked = Asked(spec, inputs, expect, mapping, tolerance or (), hold or (), allow_out_of_range)
    found = replayed(asked, given, parameters_from(others))
    made = Replayed(found.title, found.outputs, found.units, found.agreements)
    files = files_of(output or (), made)
    for note in found.notes:
        tell(note)
    _write(files)
    if json:
        say_json(to_json(found.title, found.outputs, found.agreements, found.notes))
    elif found.agreements:
        say("\n".join(lines(found.title, found.outputs, found.agreements)))
    elif not files:
        hand_over(as_csv(made))
    if files and not json:
        say("\n".join(map(str, files)))
    return found.status


def _write(files: Mapping[Path, bytes]) -> None:
    for file, content in files.items():
        try:
            write_over(file, content)
        except OSError as error:
            raise unwritable(f"--output {file}: cannot be written ({error.strerror})", error) from None


replay.__doc__ = _HELP
