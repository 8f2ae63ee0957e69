"""`pvlvrt-check profiles plot`."""

from pathlib import Path
from typing import Annotated

import typer

from pvlvrt_compliance.cli.writing import write_over
from pvlvrt_compliance.errors import UsageError, unwritable

_FORMATS = (".svg", ".png", ".html")
_SCALES = ("linear", "log")


def plot(
    name: Annotated[str, typer.Argument(metavar="NAME|FILE", help="A profile.", show_default=False)],
    output: Annotated[
        str, typer.Option(metavar="FILE", help="Ends in .svg, .png or .html. Default: the profile's id, as SVG.")
    ] = "",
    scale: Annotated[
        str, typer.Option(metavar="SCALE", help="Of the time: linear or log. Default: what fits the times.")
    ] = "",
) -> None:
    """Draw a profile's envelopes, regions and support curves.

    Example: pvlvrt-check profiles plot iec61400-21 --output envelope.svg
    """
    from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
    from pvlvrt_compliance.profile.loading import load_profile

    if scale and scale not in _SCALES:
        raise UsageError(f"--scale {scale}: allowed are {', '.join(_SCALES)}")
    file = Path(output) if output else None
    if file is not None and file.suffix.lower() not in _FORMATS:
        raise UsageError(f"--output {output}: the name must end in {', '.join(_FORMATS)}")
    profile = load_profile(name, INSTALLED_KINDS)
    file = file or Path(f"{profile.id}.svg")
    from pvlvrt_compliance.report import profile_figure

    render = getattr(profile_figure, f"render_{file.suffix.lower()[1:]}")
    content = render(profile, scale or None)
    try:
        write_over(file, content if isinstance(content, bytes) else content.encode())
    except OSError as error:
        raise unwritable(f"--output {file}: cannot be written ({error.strerror})", error) from None
    print(file)
