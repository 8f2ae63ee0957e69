"""Write docs/profiles/ and the facts on the pages of docs/checks/; with ``--check`` compare."""

import sys

from validation.command import Outcome, run
from validation.reference import checks, profiles


def work(check: bool) -> Outcome:
    """Write all pages, or say which are stale."""
    missing = [f"missing: docs/checks/{name}" for name in checks.missing()]
    if missing:
        return Outcome(missing, "")
    contents = {**profiles.contents(), **checks.contents()}
    if check:
        stale = [file for file, text in contents.items() if not file.exists() or file.read_text("utf-8") != text]
        left = profiles.left_over(contents)
        return Outcome([f"stale: {file.name}" for file in (*stale, *left)], "the pages say what the data say")
    for file, text in contents.items():
        file.parent.mkdir(exist_ok=True)
        file.write_text(text, "utf-8")
    return Outcome([], f"wrote {len(contents)} files")


if __name__ == "__main__":
    sys.exit(run(__package__, __doc__, work))
