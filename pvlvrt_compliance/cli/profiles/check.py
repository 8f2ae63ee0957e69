"""`pvlvrt-check profiles check`."""

from typing import Annotated

import typer

from pvlvrt_compliance.cli.completion.asking import completer
from pvlvrt_compliance.cli.telling import say


def check(
    file: Annotated[
        str,
        typer.Argument(
            metavar="FILE|NAME", help="A profile.", show_default=False, autocompletion=completer("profiles")
        ),
    ],
) -> None:
    """Tell every problem of a profile, each with its file, line and key; exit status 2 when there is one.

    Of a sound one, what is still as "profiles new" has begun it, and what is not verified.

    Example: pvlvrt-check profiles check my-code.toml
    """
    from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
    from pvlvrt_compliance.profile.beginning import placeholders
    from pvlvrt_compliance.profile.loading import load_profile

    profile = load_profile(file, INSTALLED_KINDS)
    demands, tests, doubts = len(list(profile.requirements.by_kind())), len(profile.tests()), profile.unverified()
    left = placeholders(file)
    begun = f", {_count(len(left), 'placeholder')}" if left else ""
    say(f"ok: {_count(tests, 'test')}, {_count(demands, 'requirement')}, {len(doubts)} not verified{begun}")
    for place in left:
        say(f"  {place}")
    for doubt in doubts:
        say(f"  {doubt}")


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"
