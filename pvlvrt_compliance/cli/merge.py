"""`pvlvrt-check merge`: the parts of a run as one."""

from typing import TYPE_CHECKING, Annotated, Any

import typer

from pvlvrt_compliance.cli.options import output as of_output
from pvlvrt_compliance.cli.options import spelled, takes

if TYPE_CHECKING:
    from pvlvrt_compliance.study.shards.part import Part

_HELP = """
Put the parts of a run together, each made with --shard in a folder of its own: reports, waveforms and exit status are \
those of one run.

Everything else that was given for the parts holds for the whole. Nothing is simulated; the profiles are read again, \
and a part is refused that another version, profile or controller has made.

Example: [bold]pvlvrt-check merge part-1 part-2 part-3 --output report[/bold]

Exit status: that of the main command for the whole run; 2 where the parts do not make one.
"""

_OPTIONS = {name: of_output.OPTIONS[name] for name in ("output", "formats", "exit_zero", "verbose", "quiet")}


@takes(_OPTIONS)
def merge(
    folders: Annotated[list[str], typer.Argument(metavar="FOLDER...", help="Folders of all parts.")],
    **given: object,
) -> int:
    """Put the parts of a run together."""
    from pvlvrt_compliance.cli.running import run
    from pvlvrt_compliance.output import check_figures, parts_in
    from pvlvrt_compliance.results.files import FOLDER
    from pvlvrt_compliance.study.shards.merging import whole_of

    own: dict[str, Any] = {name: value for name, value in given.items() if name in _OPTIONS and value is not None}
    output = str(own.pop("output", FOLDER))
    formats = tuple(own.pop("formats", ()))
    parts = [part.with_given(_checked(part)) for part in parts_in(folders)]
    check_figures(parts, formats, spelled)
    whole = whole_of(parts, output, formats)
    return run(
        whole.job,
        command=whole.command,
        spell=spelled,
        settings=whole.settings,
        whole=whole,
        output=output,
        **{**whole.others, **own},
    )


def _checked(part: "Part") -> dict[str, Any]:
    from pvlvrt_compliance.cli.options import SETTINGS
    from pvlvrt_compliance.results.files import SHARD
    from pvlvrt_compliance.settings.given import values_given

    return values_given(part.head.given, SETTINGS, str(part.folder / SHARD))


merge.__doc__ = _HELP
