"""Write docs/mutations.md, or check that it is up to date (``--check``).

Exit status 1 when the page is stale or a mutant fails other checks than it has to.
"""

import argparse
import sys
from pathlib import Path

from table import ROWS, Verdicts, page, verdicts_on_all

PAGE = Path(__file__).parent.with_suffix(".md")


def surprises(found: dict[str, Verdicts]) -> list[str]:
    """Mutants that are not as stated."""
    return [
        f"{row.name}: fails {sorted(found[row.name].failed)}, undecided {sorted(found[row.name].undecided)}, "
        f"stated {sorted(row.fails)}"
        for row in ROWS
        if found[row.name].failed != set(row.fails) or found[row.name].undecided
    ]


def main() -> int:
    """Run as a command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="run, compare with the page, write nothing")
    check = parser.parse_args().check
    found = verdicts_on_all()
    wrong = surprises(found)
    if not check:
        PAGE.write_text(page(found), encoding="utf-8")
    elif page(found) != PAGE.read_text(encoding="utf-8"):
        wrong.append(f"stale: {PAGE.name}")
    print("\n".join(wrong) or f"{len(ROWS)} rows, all as stated")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
