"""Write what the pages of docs/commands/ say of arguments and options; with ``--check`` compare."""

import sys

from validation.command import Outcome, run
from validation.commands import page


def work(check: bool) -> Outcome:
    """Write the tables into the pages, or say which are stale."""
    missing = [f"missing: {file.name}" for file in page.pages().values() if not file.exists()]
    if missing:
        return Outcome(missing, "")
    if check:
        return Outcome([f"stale: {name}" for name in page.stale()], "the tables are up to date")
    page.write()
    return Outcome([], f"wrote the tables of {len(page.pages())} pages")


if __name__ == "__main__":
    sys.exit(run(__package__, __doc__, work))
