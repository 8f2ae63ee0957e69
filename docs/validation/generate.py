"""Write docs/validation.md with its figures, or check that it is up to date (``--check``).

Exit status 1 when the page is stale or a figure is not within its tolerance; 2 without ngspice.
"""

import argparse
import sys
from pathlib import Path
from typing import Any

import blocks
import circuit
import closed_forms
import distorted_grid
import findings
import integrator
import invariants
import photovoltaics
import swings
import switched_circuit
import synchronism
from evidence import Plot, Section
from page import FIGURES, differences, page

_DOCS = Path(__file__).resolve().parents[1]
PAGE = _DOCS / "validation.md"


def sections() -> tuple[Section, ...]:
    """Everything on the page, computed now."""
    return (
        *blocks.sections(),
        circuit.section(),
        switched_circuit.section(),
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
    (_DOCS / FIGURES).mkdir(exist_ok=True)
    for plot in (plot for section in all_sections for plot in section.plots):
        draw(plot, _DOCS / FIGURES)
    PAGE.write_text(page(all_sections), encoding="utf-8")


def problems(all_sections: tuple[Section, ...], check: bool) -> list[str]:
    """Figures out of their tolerance, and with ``check`` lines that are stale."""
    rows = [row for section in all_sections for row in section.rows]
    wrong = [f"not within its tolerance: {row.name}: {row.found:g} {row.unit}" for row in rows if not row.within]
    if check:
        old = PAGE.read_text(encoding="utf-8") if PAGE.exists() else ""
        wrong += [f"stale: {difference}" for difference in differences(old, page(all_sections))]
        files = (_DOCS / FIGURES / f"{plot.file}.svg" for section in all_sections for plot in section.plots)
        wrong += [f"missing: {file.name}" for file in files if not file.exists()]
    return wrong


def main() -> int:
    """Run as a command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="compute, compare with the page, write nothing")
    check = parser.parse_args().check
    sys.path.append(str(_DOCS / "mutations"))  # how a loop is built with another block
    if not circuit.installed():
        print("ngspice is missing (Debian package ngspice)", file=sys.stderr)
        return 2
    found = sections()
    if not check:
        write(found)
    wrong = problems(found, check)
    print("\n".join(wrong) or f"{sum(len(s.rows) for s in found)} figures, all within their tolerances")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
