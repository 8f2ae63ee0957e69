"""Write docs/paper.md and its figures, or check that the page is up to date (``--check``)."""

import sys

from validation.command import Outcome, run
from validation.paper import page


def work(check: bool) -> Outcome:
    """Write page and figures, or compare the page."""
    if check:
        return Outcome(page.problems(), "the page is up to date")
    page.write()
    return Outcome([], f"wrote {page.PAGE.name}")


if __name__ == "__main__":
    sys.exit(run(__package__, __doc__, work))
