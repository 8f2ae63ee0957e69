"""`pvlvrt-check profiles show`."""

from typing import Annotated

import typer

from pvlvrt_compliance.cli.completion.asking import completer
from pvlvrt_compliance.cli.telling import say, say_json


def show(
    name: Annotated[
        str,
        typer.Argument(
            metavar="NAME|FILE", help="A profile.", show_default=False, autocompletion=completer("profiles")
        ),
    ],
    json: Annotated[bool, typer.Option("--json", metavar="", help="The resolved profile, for programs.")] = False,
) -> None:
    """Print a profile in words: every demand with its clause, every number with its mark, every test.

    Example: pvlvrt-check profiles show iec61400-21 | less
    """
    from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
    from pvlvrt_compliance.profile.loading import load_profile

    profile = load_profile(name, INSTALLED_KINDS)
    if json:
        say_json(profile.model_dump(mode="json", by_alias=True, exclude_none=True), ensure_ascii=False)
        return
    from pvlvrt_compliance.cli.tables import terminal_columns
    from pvlvrt_compliance.report.profile_words import render

    say(render(profile, terminal_columns()).removesuffix("\n"))
