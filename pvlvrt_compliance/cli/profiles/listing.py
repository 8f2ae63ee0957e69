"""`pvlvrt-check profiles list`."""

import os

_WIDTH_OF_A_FILE = 240


def list_profiles() -> int:
    """Show all profiles that can be named, with where each comes from.

    Looks in the folders of $PVLVRT_PROFILES, among the shipped ones, and in packages; the first of a name counts.

    Example: pvlvrt-check profiles list
    """
    from rich import box
    from rich.console import Console
    from rich.table import Table

    from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
    from pvlvrt_compliance.data.search_path import known_profiles
    from pvlvrt_compliance.errors import ProfileError
    from pvlvrt_compliance.profile.loading import load_profile

    console = Console(highlight=False, markup=False, emoji=False)
    if not console.is_terminal and "COLUMNS" not in os.environ:
        console.width = _WIDTH_OF_A_FILE  # one profile a line, for grep
    table = Table(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False, padding=(0, 1, 0, 0))
    for heading in ("name", "title", "tests", "Hz", "weakest", "origin"):
        table.add_column(heading, no_wrap=heading == "name", justify="right" if heading == "tests" else "left")
    broken = 0
    for name, known in known_profiles().items():
        try:
            profile = load_profile(str(known.path), INSTALLED_KINDS)
        except ProfileError as error:
            broken += 1
            table.add_row(
                name,
                f"{len(error.problems)} problem{'s' * (len(error.problems) > 1)}: profiles check {name}",
                "",
                "",
                "",
                known.origin,
            )
            continue
        cases = profile.tests()
        frequencies = sorted({case.scenario.nominal_frequency_hz for case in cases})
        hz = ", ".join(f"{frequency:g}" for frequency in frequencies)
        table.add_row(name, profile.title, str(len(cases)), hz, profile.weakest_mark, known.origin)
    console.print(table)
    return 2 if broken else 0
