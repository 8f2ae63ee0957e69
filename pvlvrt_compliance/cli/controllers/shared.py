"""Options that several commands on controllers have."""

from typing import Annotated

import typer

Spec = Annotated[str, typer.Argument(metavar="SPEC", help="As for --controller.", show_default=False)]
Mapped = Annotated[
    str | None,
    typer.Option(metavar="FILE", help="Ties its ports to the plant. Default: NAME.mapping.toml beside it."),
]
Assignments = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="NAME=VALUE", help="A parameter, as of the main command; repeatable."),
]
OutOfRange = Annotated[
    bool, typer.Option("--allow-out-of-range", metavar="", help="Let them be out of the range that it states.")
]
