"""Write docs/mutations.md, or check that it is up to date (``--check``).

Exit status 1 when the page is stale or a mutant fails other checks than it has to.
"""

import sys

from validation.command import Outcome, run
from validation.mutations.table import ROWS, Verdicts, page, verdicts_on_all
from validation.places import DOCS

PAGE = DOCS / "mutations.md"


def surprises(found: dict[str, Verdicts]) -> list[str]:
    """Mutants that are not as stated."""
    return [
        f"{row.name}: fails {sorted(found[row.name].failed)}, undecided {sorted(found[row.name].undecided)}, "
        f"stated {sorted(row.fails)}"
        for row in ROWS
        if found[row.name].failed != set(row.fails) or found[row.name].undecided
    ]


def work(check: bool) -> Outcome:
    """Run every row; write the page, or compare it."""
    found = verdicts_on_all()
    wrong = surprises(found)
    if not check:
        PAGE.write_text(page(found), encoding="utf-8")
    elif page(found) != PAGE.read_text(encoding="utf-8"):
        wrong.append(f"stale: {PAGE.name}")
    return Outcome(wrong, f"{len(ROWS)} rows, all as stated")


if __name__ == "__main__":
    sys.exit(run(__package__, __doc__, work))
