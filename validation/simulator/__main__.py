"""Write docs/validation.md with its figures, or check that it is up to date (``--check``).

Exit status 1 when the page is stale or a figure is not within its tolerance; 2 without ngspice.
"""

import sys
from pathlib import Path
from typing import Any

from validation.command import MissingProgramError, Outcome, run
from validation.places import DOCS
from validation.simulator import (
    blocked_circuit,
    blocks,
    circuit,
    closed_forms,
    distorted_grid,
    findings,
    integrator,
    invariants,
    photovoltaics,
    swings,
    switched_circuit,
    synchronism,
)
from validation.simulator.evidence import Plot, Section
from validation.simulator.page import FIGURES, PAGE, differences, page


def sections() -> tuple[Section, ...]:
    """Everything on the page, computed now."""
    return (
        *blocks.sections(),
        circuit.section(),
        switched_circuit.section(),
        blocked_circuit.section(),
        integrator.section(),
        photovoltaics.section(),
        invariants.section(),
        closed_forms.section(),
        distorted_grid.section(),
        *findings.sections(),
        swings.section(),
        synchronism.section(),
    )


def draw(plot: Plot, folder: Path) -> None:
    """Write a drawing as SVG, the same bytes each time on one machine."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    mpl.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": plot.file, "axes.grid": True, "grid.alpha": 0.3})
    figure: Any = Figure(figsize=(8, plot.height), layout="constrained")
    plot.draw(figure)
    figure.savefig(folder / f"{plot.file}.svg", metadata={"Date": None, "Creator": None})


def write(all_sections: tuple[Section, ...]) -> None:
    """Write page and drawings."""
    (DOCS / FIGURES).mkdir(parents=True, exist_ok=True)
    for plot in (plot for section in all_sections for plot in section.plots):
        draw(plot, DOCS / FIGURES)
    PAGE.write_text(page(all_sections), encoding="utf-8")


def problems(all_sections: tuple[Section, ...], check: bool) -> list[str]:
    """Figures out of their tolerance, and with ``check`` lines that are stale."""
    rows = [row for section in all_sections for row in section.rows]
    wrong = [f"not within its tolerance: {row.name}: {row.found:g} {row.unit}" for row in rows if not row.within]
    if check:
        old = PAGE.read_text(encoding="utf-8") if PAGE.exists() else ""
        wrong += [f"stale: {difference}" for difference in differences(old, page(all_sections))]
        files = (DOCS / FIGURES / f"{plot.file}.svg" for section in all_sections for plot in section.plots)
        wrong += [f"missing: {file.name}" for file in files if not file.exists()]
    return wrong


def work(check: bool) -> Outcome:
    """Compute everything; write the page, or compare it."""
    if not circuit.installed():
        raise MissingProgramError("ngspice is missing (Debian package ngspice)")
    found = sections()
    if not check:
        write(found)
    summary = f"{sum(len(s.rows) for s in found)} figures, all within their tolerances"
    return Outcome(problems(found, check), summary)


if __name__ == "__main__":
    sys.exit(run(__package__, __doc__, work))
