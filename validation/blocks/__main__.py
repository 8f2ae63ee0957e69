"""Make what is computed of the pages in `docs/controller`, `docs/plant` and `docs/hardware`, and their figures.

With ``--check`` everything is computed anew and compared; exit status 1 when a number, a parameter, the sentence of a
test or a figure is another one, or a number is not within its tolerance.
"""

import sys
from pathlib import Path

from validation.blocks import diagram, svg
from validation.blocks.numbers import FIGURES, ROWS
from validation.blocks.page import filled, pages
from validation.command import Outcome, run
from validation.places import DOCS
from validation.simulator.page import differences


def made() -> dict[Path, str]:
    """Text of every file that this command writes."""
    figures = [make() for make in FIGURES]
    return (
        {DOCS / figure.file: svg.render(figure) for figure in figures}
        | {DOCS / d.file: diagram.render(d) for d in diagram.DIAGRAMS}
        | {page: filled(page) for page in pages()}
    )


def out_of_tolerance() -> list[str]:
    """Numbers that are not where they are expected."""
    rows = [row for make in ROWS.values() for row in make()]
    return [f"not within its tolerance: {row.name}: {row.found:g} {row.unit}" for row in rows if not row.within]


def stale(path: Path, text: str) -> list[str]:
    """What of a file is not as it would be made now."""
    if not path.is_file():
        return [f"missing: {path.relative_to(DOCS)}"]
    return [f"stale: {path.relative_to(DOCS)}: {line}" for line in differences(path.read_text("utf-8"), text)]


def work(check: bool) -> Outcome:
    """Write everything, or compare it."""
    wrong, files = out_of_tolerance(), made()
    for path, text in files.items():
        if check:
            wrong += stale(path, text)
        else:
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, "utf-8")
    return Outcome(wrong, f"{len(files)} pages and figures are up to date" if check else f"wrote {len(files)} files")


if __name__ == "__main__":
    sys.exit(run(__package__, __doc__, work))
