"""`pvlvrt-check profiles new`."""

import re
from pathlib import Path
from typing import Annotated

import typer

from pvlvrt_compliance.cli.writing import write_new
from pvlvrt_compliance.errors import UsageError

_ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]*")
_DEFAULT_ID = "my-code"


def new(
    name: Annotated[
        str, typer.Argument(metavar="[NAME]", help="Writes NAME.toml; without it, prints.", show_default=False)
    ] = "",
) -> None:
    """Begin a profile: a commented file that passes "profiles check".

    Example: pvlvrt-check profiles new my-code
    """
    from pvlvrt_compliance.resources import resource_folder

    identity = Path(name).name.removesuffix(".toml") if name else _DEFAULT_ID
    if not _ID.fullmatch(identity):
        raise UsageError(f"{name!r}: an id has letters, digits, dots, dashes and underscores")
    text = (resource_folder("reports") / "new-profile.toml").read_text("utf-8").replace(_DEFAULT_ID, identity)
    if not name:
        print(text, end="")
        return
    file = Path(name).with_name(f"{identity}.toml")
    write_new({file: text.encode()})
    print(file)
