"""`pvlvrt-check profiles check`."""

from typing import Annotated

import typer


def check(
    file: Annotated[str, typer.Argument(metavar="FILE|NAME", help="A profile.", show_default=False)],
) -> None:
    """Tell every problem of a profile, each with its file, line and key; exit status 2 when there is one.

    Example: pvlvrt-check profiles check my-code.toml
    """
    from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
    from pvlvrt_compliance.profile.loading import load_profile

    profile = load_profile(file, INSTALLED_KINDS)
    demands, tests, doubts = len(list(profile.requirements.by_kind())), len(profile.tests()), profile.unverified()
    print(f"ok: {_count(tests, 'test')}, {_count(demands, 'requirement')}, {len(doubts)} not verified")
    for doubt in doubts:
        print(f"  {doubt}")


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"
