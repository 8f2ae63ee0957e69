"""Write the figures of reports that pages show; with ``--check`` compare them with what a run draws."""

import sys

from validation.command import Outcome, run
from validation.pictures import drawn


def work(check: bool) -> Outcome:
    """Run the sags and draw, or compare."""
    made = drawn.pictures()
    if check:
        stale = [f"stale: {file.name}" for file, text in made.items() if not drawn.is_shown_by(text, file)]
        return Outcome(stale, f"{len(made)} figures are what a report shows")
    for file, text in made.items():
        file.parent.mkdir(exist_ok=True)
        file.write_text(text, "utf-8")
    return Outcome([], f"wrote {', '.join(file.name for file in made)}")


if __name__ == "__main__":
    sys.exit(run(__package__, __doc__, work))
