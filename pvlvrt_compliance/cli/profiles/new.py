"""`pvlvrt-check profiles new`."""

from typing import Annotated

import typer

from pvlvrt_compliance.cli.telling import hand_over, say
from pvlvrt_compliance.cli.writing import write_new


def new(
    name: Annotated[
        str, typer.Argument(metavar="NAME", help="Writes NAME.toml; without it, prints.", show_default=False)
    ] = "",
) -> None:
    """Begin a profile: a commented file that passes "profiles check".

    Example: pvlvrt-check profiles new my-code
    """
    from pvlvrt_compliance.profile.beginning import begin_profile

    begun = begin_profile(name)
    if begun.file is None:
        hand_over(begun.text)
        return
    write_new({begun.file: begun.text.encode()})
    say(str(begun.file))
