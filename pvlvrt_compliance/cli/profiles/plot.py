"""`pvlvrt-check profiles plot`."""

from pathlib import Path
from typing import Annotated

import typer

from pvlvrt_compliance.cli.completion.asking import completer
from pvlvrt_compliance.cli.telling import say
from pvlvrt_compliance.cli.writing import write_over
from pvlvrt_compliance.errors import unwritable
from pvlvrt_compliance.texts import one_line


def plot(
    name: Annotated[
        str,
        typer.Argument(
            metavar="NAME|FILE", help="A profile.", show_default=False, autocompletion=completer("profiles")
        ),
    ],
    output: Annotated[
        str, typer.Option(metavar="FILE", help="Ends in .svg, .png or .html. Default: the profile's id, as SVG.")
    ] = "",
    scale: Annotated[
        str,
        typer.Option(
            metavar="SCALE",
            help="Of the time: linear or log. Default: what fits the times.",
            autocompletion=completer("time_scales"),
        ),
    ] = "",
) -> None:
    """Draw a profile's envelopes, regions and support curves.

    Example: pvlvrt-check profiles plot iec61400-21 --output envelope.svg
    """
    from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
    from pvlvrt_compliance.profile.loading import load_profile
    from pvlvrt_compliance.report.drawing.drawers import drawer_for, scale_named
    from pvlvrt_compliance.report.drawing.of_profile import panels

    wanted = scale_named(scale, "--scale") if scale else None
    drawer = drawer_for(output, "--output")
    profile = load_profile(name, INSTALLED_KINDS)
    file = Path(output or f"{profile.id}{drawer.suffix}")
    content = drawer.render(profile.id, one_line(profile.title), panels(profile, wanted))
    try:
        write_over(file, content if isinstance(content, bytes) else content.encode())
    except OSError as error:
        raise unwritable(f"--output {file}: cannot be written ({error.strerror})", error) from None
    say(str(file))
