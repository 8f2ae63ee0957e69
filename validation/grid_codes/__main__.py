"""Write docs/grid-codes.md and its table of verdicts; with ``--check`` run the shorter tests and compare theirs."""

import sys

from validation.command import Outcome, run
from validation.grid_codes import page


def work(check: bool) -> Outcome:
    """Run the profiles; write page and table, or compare the verdicts."""
    if check:
        return Outcome(page.check(), "the shorter tests have the verdicts that the table says")
    page.write()
    return Outcome([], f"wrote {page.PAGE.name} and {page.VERDICTS.name}")


if __name__ == "__main__":
    sys.exit(run(__package__, __doc__, work))
