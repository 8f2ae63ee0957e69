"""Write table and figure of docs/fidelity.md, or check that the table is up to date (``--check``)."""

import sys

from validation.command import Outcome, run
from validation.fidelity import page


def work(check: bool) -> Outcome:
    """Run every case; write the table and draw, or compare the table."""
    text = page.page()
    if check:
        stale = text != page.PAGE.read_text("utf-8")
        return Outcome([f"stale: {page.PAGE.name}"] if stale else [], "the table is up to date")
    page.PAGE.write_text(text, "utf-8")
    page.draw()
    return Outcome([], f"wrote {page.PAGE.name} and {page.FIGURE.name}")


if __name__ == "__main__":
    sys.exit(run(__package__, __doc__, work))
